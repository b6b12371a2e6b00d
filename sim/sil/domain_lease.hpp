// DomainLease: a DDS domain for one run only, so that concurrent runs on a machine do not interfere. It is
// held by a lock on a file in the temporary folder. The flight program inherits the file, so that the domain
// stays reserved while either process lives. The system releases the lock however they end.
#pragma once

#include <cstdint>
#include <string>

namespace tumblesight::sim {

class DomainLease {
 public:
  // `wanted`: a domain, or -1 for a free one. Throws SilFailure if it is taken, none is free, or the lock
  // file cannot be opened.
  explicit DomainLease(int wanted);
  ~DomainLease();
  DomainLease(const DomainLease&) = delete;
  DomainLease& operator=(const DomainLease&) = delete;

  std::uint32_t domain() const { return domain_; }
  // The lock file, which FlightProcess lets the child inherit.
  int file() const { return file_; }

 private:
  enum class Lock { kOurs, kTaken, kNoFile };
  // errno holds the reason of kNoFile.
  Lock try_lock(const std::string& folder, std::uint32_t domain);

  int file_ = -1;
  std::uint32_t domain_ = 0;
};

}  // namespace tumblesight::sim
