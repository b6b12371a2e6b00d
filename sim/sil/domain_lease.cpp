#include "sim/sil/domain_lease.hpp"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "hal/dds/idl/domain.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

// Domain 0 is the default of DDS programs. Ports of domains above 100 are in Linux's ephemeral range.
constexpr std::uint32_t kFirstFree = 1;
constexpr std::uint32_t kLastFree = 100;

[[noreturn]] void fail_no_file(const std::string& folder, int error) {
  throw SilFailure("no DDS domain can be reserved: the lock file in " + folder +
                   " cannot be opened: " + strerror(error));
}

}  // namespace

DomainLease::DomainLease(int wanted) {
  if (wanted > static_cast<int>(hal::dds::kMaxDomain)) {
    throw SilFailure("DDS domain " + std::to_string(wanted) + " is out of range: 0 to " +
                     std::to_string(hal::dds::kMaxDomain));
  }
  std::error_code no_folder;
  const std::string folder = std::filesystem::temp_directory_path(no_folder);
  if (no_folder)
    throw SilFailure("no DDS domain can be reserved: no temporary folder: " + no_folder.message());
  if (wanted >= 0) {
    const Lock lock = try_lock(folder, static_cast<std::uint32_t>(wanted));
    if (lock == Lock::kOurs) return;
    if (lock == Lock::kNoFile) fail_no_file(folder, errno);
    throw SilFailure("DDS domain " + std::to_string(wanted) + " is in use by another run on this machine");
  }
  bool any_taken = false;
  int error = 0;
  for (std::uint32_t domain = kFirstFree; domain <= kLastFree; ++domain) {
    const Lock lock = try_lock(folder, domain);
    if (lock == Lock::kOurs) return;
    any_taken |= lock == Lock::kTaken;
    if (lock == Lock::kNoFile) error = errno;
  }
  if (!any_taken) fail_no_file(folder, error);
  throw SilFailure("no free DDS domain from " + std::to_string(kFirstFree) + " to " +
                   std::to_string(kLastFree) + ": other runs on this machine use them");
}

DomainLease::~DomainLease() {
  if (file_ >= 0) close(file_);
}

DomainLease::Lock DomainLease::try_lock(const std::string& folder, std::uint32_t domain) {
  const std::string path = folder + "/tumblesight-domain-" + std::to_string(domain) + ".lock";
  // O_CLOEXEC: only the flight program may inherit the file; other child processes may outlive the run. First
  // without O_CREAT: in a sticky directory Linux may refuse to "create" a file that belongs to another user.
  int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) file = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return Lock::kNoFile;
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    close(file);
    return Lock::kTaken;
  }
  file_ = file;
  domain_ = domain;
  return Lock::kOurs;
}

}  // namespace tumblesight::sim
