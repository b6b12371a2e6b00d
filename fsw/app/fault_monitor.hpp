// FaultMonitor: remembers in which of the last cycles each fault was present, and decides when to respond. An
// intermittent fault counts like a lasting one.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/config/fault_rules.hpp"

namespace tumblesight::fsw {

constexpr std::uint32_t bit_of(Fault fault) {
  return 1U << static_cast<int>(fault);
}

class FaultMonitor {
 public:
  enum class Change : std::uint8_t { kNone, kPersists, kOver };

  // Once per cycle and fault. kPersists: the fault is present, and has been present in as many cycles of the
  // window as its rule requires. The window then starts empty, so that the next kPersists needs as many
  // again. kOver: a persisting fault has been absent for as many cycles as its rule requires.
  Change observe(const config::FaultRule& rule, bool present);
  // Instead of observe(), in a cycle in which the consequence of a fault remains: a persisting fault is not
  // over, and there is no new response.
  void hold(Fault fault);

  // The response to a persisting fault; kFlag where it is disabled.
  Response response_to(const config::FaultRule& rule) const;
  // Enables or disables a response. False: there is no such fault, or its response cannot be disabled.
  [[nodiscard]] bool enable(std::uint8_t fault, bool enabled);

  std::uint32_t persisting() const { return persisting_; }
  std::uint32_t disabled() const { return disabled_; }

 private:
  std::array<std::uint32_t, kFaults> history_{};     // since the last response; bit n: present n cycles ago
  std::array<std::uint8_t, kFaults> good_cycles_{};  // consecutive, up to now; saturates
  std::uint32_t persisting_ = 0;                     // bit n: Fault n
  std::uint32_t disabled_ = 0;                       // bit n: Fault n
};

}  // namespace tumblesight::fsw
