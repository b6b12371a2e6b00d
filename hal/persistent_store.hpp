// PersistentStore: memory that keeps its content through a reset and a loss of power (FRAM, MRAM, EEPROM,
// flash, a file). It has two places for a record of fixed size; the application writes both and decides
// which one to trust after a reset (fsw/app/stored_state.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/store_status.hpp"

namespace tumblesight::hal {

inline constexpr int kStoredCopies = 2;
// Every version of the software uses this size, so that each can read the records of the others.
inline constexpr int kStoredBytes = 256;
using StoredBytes = std::array<std::uint8_t, kStoredBytes>;

class PersistentStore {
 public:
  // `copy`: 0 or 1. Each call blocks for at most a few milliseconds. The application writes both copies and
  // reads them back, before each command and at most once at the end of a step; the telemetry's store_us
  // shows the time at the end of the step. At boot it reads each copy at most three times, and again in the
  // first step if nothing could be read.
  //
  // kOk: all bytes were read. kBlank: nothing has ever been written. kFailed: the memory cannot be read now.
  // kDamaged: the memory knows that its content is wrong, for example by its own error detection.
  [[nodiscard]] virtual StoreStatus read(int copy, StoredBytes& bytes) = 0;
  // kOk: the bytes are in the memory, and a reset from now on leaves them there. Otherwise kFailed. A write
  // that fails or that a reset interrupts must not change the other copy.
  [[nodiscard]] virtual StoreStatus write(int copy, const StoredBytes& bytes) = 0;

 protected:
  ~PersistentStore() = default;
};

}  // namespace tumblesight::hal
