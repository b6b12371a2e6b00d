// The state of the persistent store and of its records, as the application sees them. The numbers are part of
// the interface (docs/icd.md).
#pragma once

#include <cstdint>

namespace tumblesight::hal {

// One copy of the stored state, when it was read.
enum class StoreStatus : std::uint8_t {
  kOk = 0,
  kBlank = 1,         // nothing has ever been written
  kFailed = 2,        // the memory could not be read
  kDamaged = 3,       // not even the head of a record can be trusted
  kBodyDamaged = 4,   // the head is good; the rest is damaged, or has a value out of its range
  kOtherVersion = 5,  // the head is good; the rest is of software with another format
  kOtherTable = 6,    // good, but the table is of software with other parameters, fault rules or limits
};

// The store at the end of a cycle.
enum class StoreHealth : std::uint8_t {
  kNone = 0,     // the platform has no store
  kGood = 1,     // both copies hold the newest record
  kOneCopy = 2,  // one does
  kFailing = 3,  // none does; telecommands except SET_MODE SAFE are refused
  kGivenUp = 4,  // none has for ten cycles; telecommands are carried out as without a store, until a reset
};

// What was lost at boot: bits, the third argument of the event STORED_STATE_LOST.
enum class StateLoss : std::uint8_t {
  kHead = 1,          // command counter and key slot
  kBody = 2,          // mode, bank in use, disabled responses, table
  kTable = 4,         // the table only
  kStale = 8,         // what was resumed is older than the newest record
  kKeySlot = 16,      // the stored key slot holds no key now
  kModeAndBank = 32,  // mode and bank in use; nothing could be read before the first cycle
};

}  // namespace tumblesight::hal
