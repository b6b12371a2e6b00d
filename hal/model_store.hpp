// ModelStore: the memory that model images lie in. Two banks: one is in use, the other holds a second copy of
// the same image, or one that the ground is loading.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::hal {

inline constexpr int kModelBanks = 2;

struct ModelBank {
  const std::uint8_t* data = nullptr;  // nullptr: there is no such bank
  std::uint8_t* writable = nullptr;    // the same place, or nullptr where it cannot be written (ROM)
  std::size_t size = 0;                // bytes of the image at start; 0: none
  std::size_t capacity = 0;            // bytes that an image may take
};

class ModelStore {
 public:
  // Always the same answer for `index` 0 and 1; the memory stays for the life of the store.
  virtual ModelBank bank(int index) = 0;

 protected:
  ~ModelStore() = default;
};

}  // namespace tumblesight::hal
