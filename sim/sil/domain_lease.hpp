// DomainLease: a DDS domain for one run alone, so that runs beside each other on a machine do not meet. Held
// by a lock on a file in the temporary directory. The flight program inherits the file, so that the domain
// stays taken as long as either of the two lives; the system lets go of it however they end.
#pragma once

#include <cstdint>
#include <string>

namespace tumblesight::sim {

class DomainLease {
 public:
  // `wanted`: a domain, or -1 for a free one. Throws SilFailure if it is taken, none is free, or
  // the lock's file cannot be opened.
  explicit DomainLease(int wanted);
  ~DomainLease();
  DomainLease(const DomainLease&) = delete;
  DomainLease& operator=(const DomainLease&) = delete;

  std::uint32_t domain() const { return domain_; }
  // For FlightProcess to hand down.
  int file() const { return file_; }

 private:
  enum class Lock { kOurs, kTaken, kNoFile };
  // kNoFile: errno says why.
  Lock try_lock(const std::string& folder, std::uint32_t domain);

  int file_ = -1;
  std::uint32_t domain_ = 0;
};

}  // namespace tumblesight::sim
