// ModelStore: where model images lie.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::hal {

struct ModelBytes {
  const std::uint8_t* data = nullptr;  // nullptr: there is none; stays valid for the life of the store
  std::size_t size = 0;
};

class ModelStore {
 public:
  virtual ModelBytes active_image() = 0;

 protected:
  ~ModelStore() = default;
};

}  // namespace tumblesight::hal
