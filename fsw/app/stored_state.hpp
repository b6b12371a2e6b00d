// StoredState: the part of the application's state that survives a reset, and its record in the platform's
// persistent store (hal/persistent_store.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/modes.hpp"
#include "fsw/config/fault_rules.hpp"
#include "fsw/config/limits.hpp"
#include "hal/persistent_store.hpp"

namespace tumblesight::fsw {

using hal::StoreStatus;

struct StoredState {
  std::uint32_t command_counter = 0;  // of the last authentic command
  std::uint32_t key_slot = 0;
  std::uint32_t bank = 0;
  Mode mode = Mode::kBoot;  // kBoot: none is stored
  Cause safe_cause = Cause::kNone;
  Fault safe_fault = Fault::kStateLost;
  std::array<std::uint32_t, kLimits> limits{};
  std::uint32_t responses_disabled = 0;  // bit n: Fault n

  bool operator==(const StoredState& other) const;
  bool operator!=(const StoredState& other) const { return !(*this == other); }
};

// A record: all numbers are big-endian.
//
//   offset  bytes  field
//        0      4  magic TSST
//        4      1  format version, 1
//        5      1  number of limits
//        6      4  generation: higher in a later record
//       10      4  command counter
//       14      1  key slot
//       15      1  bank in use
//       16      1  Mode
//       17      1  Cause of the last change to SAFE
//       18      1  Fault, valid if the cause is FAULT
//       19      4  responses disabled
//       23    4 n  limits
//           ...    zeros
//      124      4  CRC-32 of everything before it
hal::StoredBytes to_record(const StoredState& state, std::uint32_t generation);
// kOk, or kDamaged if checksum, format or a value is wrong; then `state` and `generation` are unchanged.
[[nodiscard]] StoreStatus from_record(const hal::StoredBytes& bytes, StoredState& state,
                                      std::uint32_t& generation);

}  // namespace tumblesight::fsw
