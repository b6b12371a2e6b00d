#include "sim/sil/domain_lease.hpp"

#include <errno.h>
#include <string.h>

#include <string>

#include "hal/dds/idl/domain.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

// Domain 0 is the default of DDS programs. Ports of domains above 100 are in Linux's ephemeral range.
constexpr std::uint32_t kFirstFree = 1;
constexpr std::uint32_t kLastFree = 100;

}  // namespace

DomainLease::DomainLease(int wanted) {
  if (wanted > static_cast<int>(hal::dds::kMaxDomain)) {
    throw SilFailure("DDS domain " + std::to_string(wanted) + " is out of range: 0 to " +
                     std::to_string(hal::dds::kMaxDomain));
  }
  if (wanted >= 0) {
    if (take(static_cast<std::uint32_t>(wanted))) return;
    throw SilFailure("DDS domain " + std::to_string(wanted) +
                     " is in use: another run, or another program, on this machine has reserved it; give "
                     "another --domain");
  }
  if (take_from(kFirstFree)) return;
  throw SilFailure(
      "no free DDS domain from " + std::to_string(kFirstFree) + " to " + std::to_string(kLastFree) +
      ": other runs, or other programs, on this machine have reserved them; give a --domain up to " +
      std::to_string(hal::dds::kMaxDomain));
}

bool DomainLease::take_next() {
  return take_from(domain_ + 1);
}

bool DomainLease::take_from(std::uint32_t first) {
  for (std::uint32_t domain = first; domain <= kLastFree; ++domain)
    if (take(domain)) return true;
  return false;
}

bool DomainLease::take(std::uint32_t domain) {
  const int error = name_.hold(("tumblesight-domain-" + std::to_string(domain)).c_str());
  if (error != 0 && error != EADDRINUSE)
    throw SilFailure(std::string("no DDS domain can be reserved: ") + strerror(error));
  if (error == 0) domain_ = domain;
  return error == 0;
}

}  // namespace tumblesight::sim
