// FaultMonitor: how long each fault has been there, and when it is time to respond.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/config/fault_rules.hpp"

namespace tumblesight::fsw {

constexpr std::uint32_t bit_of(Fault fault) {
  return 1U << static_cast<int>(fault);
}
inline constexpr std::uint32_t kAllFaults = (1U << kFaults) - 1;

class FaultMonitor {
 public:
  enum class Change : std::uint8_t { kNone, kPersists, kOver };

  // Once a cycle for each fault. kPersists: it has just been there as long as its rule says, and again as
  // long after that. kOver: it has persisted and is gone.
  Change observe(Fault fault, bool present);

  // What to do about a fault that persists: by its rule, or, disabled, to tell it.
  Response response_to(Fault fault) const;
  // False: there is no such fault, or its response cannot be disabled.
  [[nodiscard]] bool enable(std::uint8_t fault, bool enabled);

  std::uint32_t persisting() const { return persisting_; }
  std::uint32_t disabled() const { return disabled_; }

 private:
  std::array<std::uint16_t, kFaults> cycles_{};  // on end, since the last response
  std::uint32_t persisting_ = 0;                 // bits
  std::uint32_t disabled_ = 0;
};

}  // namespace tumblesight::fsw
