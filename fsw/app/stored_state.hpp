// StoredState: the part of the application's state that survives a reset, and its record in the platform's
// persistent store (hal/persistent_store.hpp).
#pragma once

#include <cstdint>

#include "fsw/app/modes.hpp"
#include "fsw/app/parameter_table.hpp"
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
  ParameterTable table;
  std::uint32_t responses_disabled = 0;  // bit n: Fault n

  bool operator==(const StoredState& other) const;
  bool operator!=(const StoredState& other) const { return !(*this == other); }
};

// A record: all numbers are big-endian.
//
//   offset  bytes  field
//        0      4  magic TSST
//        4      1  format version, 2
//        5      4  generation: higher in a later record
//        9      4  command counter
//       13      1  key slot
//       14      1  bank in use
//       15      1  Mode
//       16      1  Cause of the last change to SAFE
//       17      1  Fault, valid if the cause is FAULT
//       18      4  responses disabled
//       22      n  active table, as on the link (parameter_table.hpp)
//           ...    zeros
//      124      4  CRC-32 of everything before it
hal::StoredBytes to_record(const StoredState& state, std::uint32_t generation);
// kOk, or kDamaged if checksum, format or a value is wrong; then `state` and `generation` are unchanged.
[[nodiscard]] StoreStatus from_record(const hal::StoredBytes& bytes, StoredState& state,
                                      std::uint32_t& generation);

}  // namespace tumblesight::fsw
