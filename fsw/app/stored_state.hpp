// StoredState: the part of the application's state that survives a reset, and its record in the platform's
// persistent store (hal/persistent_store.hpp).
#pragma once

#include <cstdint>

#include "fsw/app/modes.hpp"
#include "fsw/app/parameter_table.hpp"
#include "hal/persistent_store.hpp"

namespace tumblesight::fsw {

using hal::StoreHealth;
using hal::StoreStatus;

struct StoredState {
  std::uint32_t command_counter = 0;  // of the last authentic command
  std::uint32_t key_slot = 0;
  std::uint32_t bank = 0;
  Mode mode = Mode::kBoot;  // kBoot: none is stored
  Cause safe_cause = Cause::kNone;
  Fault safe_fault = Fault::kStateLost;
  ParameterTable table = kInitialTable;
  std::uint32_t responses_disabled = 0;  // bit n: Fault n

  bool operator==(const StoredState& other) const;
  bool operator!=(const StoredState& other) const { return !(*this == other); }
};

// A record: all numbers are big-endian. The head is the same in every version of the software and has its own
// CRC, so that neither other software nor damage behind it loses the counter.
//
//   offset  bytes  field
//        0      4  magic TSST
//        4      1  format version of what follows the head, 3
//        5      1  key slot
//        6      2  zeros
//        8      4  generation: higher in a later record
//       12      4  command counter
//       16      4  CRC-32 of everything before it: the end of the head
//       20      1  bank in use
//       21      1  Mode
//       22      1  Cause of the last change to SAFE
//       23      1  Fault, valid if the cause is FAULT
//       24      4  responses disabled
//       28      n  active table, as on the link (parameter_table.hpp)
//           ...    zeros
//      252      4  CRC-32 of everything before it
inline constexpr std::size_t kStoredHeadBytes = 20;
hal::StoredBytes to_record(const StoredState& state, std::uint32_t generation);

// Whether a copy with this status has more than a good head.
constexpr bool has_body(StoreStatus status) {
  return status == StoreStatus::kOk || status == StoreStatus::kOtherTable;
}

// What is good in a record. `state` and `generation` are set as far as the status says; everything else in
// `state` has its initial value. Without a head both are unchanged.
[[nodiscard]] StoreStatus from_record(const hal::StoredBytes& bytes, StoredState& state,
                                      std::uint32_t& generation);

}  // namespace tumblesight::fsw
