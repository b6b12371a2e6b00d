#include "sim/sil/run_announcement.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "hal/dds/idl/domain.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

std::string announcement_of(std::uint32_t domain) {
  return "domain-" + std::to_string(domain) + ".run";
}

// A killed run leaves its file, but not its lock.
bool is_locked_by_run(int file) {
  return flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

struct Found {
  timespec written{};
  hal::dds::RunSecret secret;
};
std::optional<Found> read_announcement(const RuntimeFolder& folder, std::uint32_t domain) {
  const int file = folder.open_file(announcement_of(domain));
  if (file < 0) return std::nullopt;
  struct stat status {};
  char text[sizeof(hal::dds::RunSecretText) + 1] = {};
  Found found;
  const bool is_read =
      fstat(file, &status) == 0 && read(file, text, sizeof text - 1) > 0 && is_locked_by_run(file);
  close(file);
  if (!is_read) return std::nullopt;
  // The default partition has no name, which read_run_secret() does not accept.
  std::string whole = text;
  const bool is_default = !whole.empty() && whole.back() == ':';
  if (is_default) whole.append(hal::dds::RunSecret::kPartitionDigits, '0');
  if (!hal::dds::read_run_secret(whole.c_str(), found.secret)) return std::nullopt;
  if (is_default) found.secret.partition[0] = '\0';
  found.written = status.st_mtim;
  return found;
}

bool is_later(const timespec& a, const timespec& b) {
  return a.tv_sec != b.tv_sec ? a.tv_sec > b.tv_sec : a.tv_nsec > b.tv_nsec;
}

}  // namespace

RunAnnouncement::RunAnnouncement(std::uint32_t domain, const hal::dds::RunSecret& secret)
    : name_(announcement_of(domain)) {
  try {
    write(folder_.emplace(), secret);
  } catch (const SilFailure& failure) {
    failure_ = std::string("the console cannot join this run: ") + failure.what();
  }
}

// Locked and complete before it has its name, in place of the file of a run that was killed: nobody reads
// half of it, and nobody else can hold its lock.
void RunAnnouncement::write(const RuntimeFolder& folder, const hal::dds::RunSecret& secret) {
  const std::string made = name_ + "." + std::to_string(getpid());
  const hal::dds::RunSecretText text = to_text(secret);
  const auto length = static_cast<ssize_t>(std::strlen(text.text));
  file_ = folder.make_file(made);
  if (file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) == 0 &&
      ::write(file_, text.text, static_cast<std::size_t>(length)) == length &&
      renameat(folder.descriptor(), made.c_str(), folder.descriptor(), name_.c_str()) == 0)
    return;
  const int error = errno;
  if (file_ >= 0) {
    close(file_);
    unlinkat(folder.descriptor(), made.c_str(), 0);
  }
  file_ = -1;
  struct stat found {};
  const bool is_there = fstatat(folder.descriptor(), name_.c_str(), &found, AT_SYMLINK_NOFOLLOW) == 0;
  throw SilFailure(folder.path_of(name_) + " cannot be written: " + strerror(error) +
                   (is_there ? "; remove it" : "; see whether its folder has room and can be written"));
}

// Not that of a run in another network namespace, which has DDS domains of its own.
bool RunAnnouncement::is_still_ours() const {
  struct stat ours {
  }, named{};
  return file_ >= 0 && fstat(file_, &ours) == 0 &&
         fstatat(folder_->descriptor(), name_.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 &&
         ours.st_dev == named.st_dev && ours.st_ino == named.st_ino;
}

RunAnnouncement::~RunAnnouncement() {
  if (is_still_ours()) unlinkat(folder_->descriptor(), name_.c_str(), 0);
  if (file_ >= 0) close(file_);
}

std::optional<AnnouncedRun> announced_run(int domain) {
  const RuntimeFolder folder;
  std::optional<AnnouncedRun> newest;
  timespec written{};
  const std::uint32_t first = domain < 0 ? 0 : static_cast<std::uint32_t>(domain);
  const std::uint32_t last = domain < 0 ? hal::dds::kMaxDomain : first;
  for (std::uint32_t at = first; at <= last; ++at) {
    const std::optional<Found> found = read_announcement(folder, at);
    if (!found || (newest && !is_later(found->written, written))) continue;
    newest = AnnouncedRun{at, found->secret};
    written = found->written;
  }
  return newest;
}

}  // namespace tumblesight::sim
