// FakeNavigation: the chaser's attitude as a function that the test sets. Host only.
#pragma once

#include <functional>

#include "hal/navigation.hpp"

namespace tumblesight::hal::fake {

class FakeNavigation final : public Navigation {
 public:
  std::function<gnc::ChaserAttitude(std::int64_t)> attitude;

  gnc::ChaserAttitude attitude_at(std::int64_t time_ns) override {
    return attitude ? attitude(time_ns) : gnc::ChaserAttitude{};
  }
};

}  // namespace tumblesight::hal::fake
