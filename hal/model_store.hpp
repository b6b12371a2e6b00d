// ModelStore: the memory that holds the model images. It has two banks: one is in use, the other holds a
// second copy of the same image or an image that the ground is loading. The interface fits RAM and MRAM,
// which are written at once, and flash, which is erased and written in the background and may fail.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/messages/bank_status.hpp"

namespace tumblesight::hal {

inline constexpr int kModelBanks = 2;
// Most bytes of one write().
inline constexpr std::uint32_t kMaxModelWriteBytes = 4096;

enum class BankWriting : std::uint8_t {
  kReadOnly = 0,
  kAtOnce = 1,        // the bytes can be read as soon as write() returns
  kInBackground = 2,  // write() only begins; until the end nothing in the bank can be read
};

struct ModelBank {
  const std::uint8_t* data = nullptr;  // nullptr: the bank does not exist
  BankWriting writing = BankWriting::kReadOnly;
  std::size_t size = 0;      // size of the image at start, bytes; 0: none
  std::size_t capacity = 0;  // largest image that fits, bytes
};

enum class WriteStatus : std::uint8_t {
  kAccepted = 0,  // the bytes are copied; activity() tells when they can be read
  kBusy = 1,      // an earlier write is not finished; nothing was taken
  kFailed = 2,    // the memory cannot be erased or written; nothing was taken
  kRefused = 3,   // the bank is read-only, or the bytes do not fit into it
};

class ModelStore {
 public:
  // `index`: 0 or 1. Always returns the same bank for an index; its memory is valid as long as the store.
  virtual ModelBank bank(int index) = 0;
  // Writes `count` bytes, 1...kMaxModelWriteBytes, at any offset, over anything: the store erases what it
  // must and keeps the bytes around them. Never blocks for longer than a copy of the bytes takes. The bank
  // that is in use is written only if its writing is kAtOnce.
  [[nodiscard]] virtual WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                                          std::uint32_t count) {
    static_cast<void>(index);
    static_cast<void>(offset);
    static_cast<void>(bytes);
    static_cast<void>(count);
    return WriteStatus::kRefused;
  }
  virtual BankActivity activity(int index) {
    static_cast<void>(index);
    return BankActivity::kReady;
  }

 protected:
  ~ModelStore() = default;
};

// For stores in memory: copies the bytes if they fit.
inline WriteStatus write_at_once(std::uint8_t* memory, std::size_t capacity, std::uint32_t offset,
                                 const std::uint8_t* bytes, std::uint32_t count) {
  if (memory == nullptr || count > capacity || offset > capacity - count) return WriteStatus::kRefused;
  for (std::uint32_t i = 0; i < count; ++i) memory[offset + i] = bytes[i];
  return WriteStatus::kAccepted;
}

}  // namespace tumblesight::hal
