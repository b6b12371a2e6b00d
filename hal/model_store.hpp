// ModelStore: the memory that holds the model images. It has two banks: one is in use, the other holds a
// second copy of the same image or an image that the ground is loading.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::hal {

inline constexpr int kModelBanks = 2;

struct ModelBank {
  const std::uint8_t* data = nullptr;  // nullptr: the bank does not exist
  std::uint8_t* writable = nullptr;    // the same address, or nullptr if the bank is read-only (ROM)
  std::size_t size = 0;                // size of the image at start, bytes; 0: none
  std::size_t capacity = 0;            // largest image that fits, bytes
};

class ModelStore {
 public:
  // `index`: 0 or 1. Always returns the same bank for an index; its memory is valid as long as the store.
  virtual ModelBank bank(int index) = 0;

 protected:
  ~ModelStore() = default;
};

}  // namespace tumblesight::hal
