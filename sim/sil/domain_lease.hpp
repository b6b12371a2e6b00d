// DomainLease: reserves a DDS domain for one run, so that concurrent runs on a machine do not interfere. This
// holds for all users and environments. The reservation is a name of the machine (MachineName). The flight
// program inherits it, so that the domain stays reserved while either process lives. The system frees it
// however they end. Another user can only reserve domains, not disturb the run in one.
#pragma once

#include <cstdint>

#include "hal/dds/idl/machine_name.hpp"

namespace tumblesight::sim {

class DomainLease {
 public:
  // `wanted`: a domain, or -1 for a free one. Throws SilFailure if it is taken, or none is free.
  explicit DomainLease(int wanted);

  // Gives the domain back for the next free one. False: there is none.
  bool take_next();

  std::uint32_t domain() const { return domain_; }
  // The name's descriptor, which FlightProcess lets the child inherit.
  int file() const { return name_.descriptor(); }

 private:
  bool take(std::uint32_t domain);  // false: it is taken
  bool take_from(std::uint32_t first);

  hal::dds::MachineName name_;
  std::uint32_t domain_ = 0;
};

}  // namespace tumblesight::sim
