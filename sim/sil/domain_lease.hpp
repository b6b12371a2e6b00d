// DomainLease: a DDS domain for one run alone, so that runs beside each other on a machine do not meet. Held
// by a lock on a file in the temporary directory; the system lets go of it however the process ends.
#pragma once

#include <cstdint>

namespace tumblesight::sim {

class DomainLease {
 public:
  // `wanted`: a domain, or -1 for a free one. Throws SilFailure if it is taken, or none is free.
  explicit DomainLease(int wanted);
  ~DomainLease();
  DomainLease(const DomainLease&) = delete;
  DomainLease& operator=(const DomainLease&) = delete;

  std::uint32_t domain() const { return domain_; }

 private:
  bool try_lock(std::uint32_t domain);

  int file_ = -1;
  std::uint32_t domain_ = 0;
};

}  // namespace tumblesight::sim
