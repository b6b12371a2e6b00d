// FaultMonitor: counts the consecutive cycles of each fault and says when to respond.
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

  // Once per cycle and fault. kPersists: the fault has been present for the number of consecutive cycles of
  // its rule; returned again each time that number is reached again. kOver: a persisting fault has ended.
  Change observe(Fault fault, bool present);

  // The response to a persisting fault by its rule; kFlag where the response is disabled.
  Response response_to(Fault fault) const;
  // Enables or disables a response. False: there is no such fault, or its response cannot be disabled.
  [[nodiscard]] bool enable(std::uint8_t fault, bool enabled);

  std::uint32_t persisting() const { return persisting_; }
  std::uint32_t disabled() const { return disabled_; }

 private:
  std::array<std::uint16_t, kFaults> cycles_{};  // consecutive, since the last response
  std::uint32_t persisting_ = 0;                 // bit n: Fault n
  std::uint32_t disabled_ = 0;                   // bit n: Fault n
};

}  // namespace tumblesight::fsw
