#include "sim/sil/run_announcement.hpp"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <system_error>

#include "hal/dds/idl/domain.hpp"

namespace tumblesight::sim {
namespace {

// Empty: there is no temporary folder.
std::string path_of(std::uint32_t domain, const char* ending) {
  std::error_code no_folder;
  const std::string folder = std::filesystem::temp_directory_path(no_folder);
  if (no_folder) return {};
  return folder + "/tumblesight-domain-" + std::to_string(domain) + ending;
}
std::string announcement_of(std::uint32_t domain) {
  return path_of(domain, ".run");
}

// A killed run leaves its file, but not its lock.
bool is_locked_by_run(int file) {
  return flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

struct Found {
  timespec written{};
  hal::dds::RunSecret secret;
};
std::optional<Found> read_announcement(std::uint32_t domain) {
  const int file = open(announcement_of(domain).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return std::nullopt;
  struct stat status {};
  char text[sizeof(hal::dds::RunSecretText) + 1] = {};
  Found found;
  const bool is_ours = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid();
  const bool is_read = is_ours && read(file, text, sizeof text - 1) > 0 && is_locked_by_run(file);
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
    : path_(announcement_of(domain)) {
  if (path_.empty()) return;
  unlink(path_.c_str());  // of a run that was killed
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  const hal::dds::RunSecretText text = to_text(secret);
  const auto length = static_cast<ssize_t>(std::strlen(text.text));
  // Locked before it has its text: text without a lock is that of a killed run.
  const bool is_written = file_ >= 0 && flock(file_, LOCK_EX) == 0 &&
                          write(file_, text.text, static_cast<std::size_t>(length)) == length;
  if (!is_written) path_.clear();
}

RunAnnouncement::~RunAnnouncement() {
  if (!path_.empty()) unlink(path_.c_str());
  if (file_ >= 0) close(file_);
}

std::optional<AnnouncedRun> announced_run(int domain) {
  std::optional<AnnouncedRun> newest;
  timespec written{};
  const std::uint32_t first = domain < 0 ? 0 : static_cast<std::uint32_t>(domain);
  const std::uint32_t last = domain < 0 ? hal::dds::kMaxDomain : first;
  for (std::uint32_t at = first; at <= last; ++at) {
    const std::optional<Found> found = read_announcement(at);
    if (!found || (newest && !is_later(found->written, written))) continue;
    newest = AnnouncedRun{at, found->secret};
    written = found->written;
  }
  return newest;
}

}  // namespace tumblesight::sim
