// FakeModelStore: a model image out of a test's own bytes. Host only.
#pragma once

#include <utility>
#include <vector>

#include "hal/model_store.hpp"

namespace tumblesight::hal::fake {

class FakeModelStore final : public ModelStore {
 public:
  FakeModelStore() = default;  // there is no image
  explicit FakeModelStore(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

  ModelBytes active_image() override {
    return bytes_.empty() ? ModelBytes{} : ModelBytes{bytes_.data(), bytes_.size()};
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace tumblesight::hal::fake
