#include "sim/sil/domain_lease.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "hal/dds/idl/domain.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

// Domain 0 is everybody's default, and ports of domains above 100 lie in Linux's ephemeral range.
constexpr std::uint32_t kFirstFree = 1;
constexpr std::uint32_t kLastFree = 100;

}  // namespace

DomainLease::DomainLease(int wanted) {
  if (wanted > static_cast<int>(hal::dds::kMaxDomain)) {
    throw SilFailure("DDS domain " + std::to_string(wanted) + " is out of range: 0 to " +
                     std::to_string(hal::dds::kMaxDomain));
  }
  if (wanted >= 0) {
    if (try_lock(static_cast<std::uint32_t>(wanted))) return;
    throw SilFailure("DDS domain " + std::to_string(wanted) + " is in use by another run on this machine");
  }
  for (std::uint32_t domain = kFirstFree; domain <= kLastFree; ++domain) {
    if (try_lock(domain)) return;
  }
  throw SilFailure("no free DDS domain: " + std::to_string(kLastFree) + " runs on this machine already");
}

DomainLease::~DomainLease() {
  if (file_ >= 0) close(file_);
}

bool DomainLease::try_lock(std::uint32_t domain) {
  const auto path =
      std::filesystem::temp_directory_path() / ("tumblesight-domain-" + std::to_string(domain) + ".lock");
  // Without O_CREAT first: in a sticky directory Linux may refuse to "create" a file that another user owns.
  int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) file = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return false;
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    close(file);
    return false;
  }
  file_ = file;
  domain_ = domain;
  return true;
}

}  // namespace tumblesight::sim
