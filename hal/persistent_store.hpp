// PersistentStore: memory that keeps its content through a reset and a loss of power (FRAM, MRAM, EEPROM,
// flash, a file). It has two places for a record of fixed size; the application writes both and decides
// which one to trust after a reset (fsw/app/stored_state.hpp).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

inline constexpr int kStoredCopies = 2;
inline constexpr int kStoredBytes = 128;
using StoredBytes = std::array<std::uint8_t, kStoredBytes>;

enum class StoreStatus : std::uint8_t {
  kOk = 0,
  kBlank = 1,    // read: nothing has ever been written
  kFailed = 2,   // the memory could not be read or written
  kDamaged = 3,  // read, but its checksum is wrong; only the application finds this
};

class PersistentStore {
 public:
  // `copy`: 0 or 1. Blocks for at most a few milliseconds, which belong to the budget of a step: one write
  // of both copies per command and one at the end of a step.
  [[nodiscard]] virtual StoreStatus read(int copy, StoredBytes& bytes) = 0;
  // kOk: the bytes are in the memory, and a reset from now on leaves them there. A write that a reset
  // interrupts must not change the other copy.
  [[nodiscard]] virtual StoreStatus write(int copy, const StoredBytes& bytes) = 0;

 protected:
  ~PersistentStore() = default;
};

}  // namespace tumblesight::hal
