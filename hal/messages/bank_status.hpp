// What a model bank holds.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class BankStatus : std::uint8_t {
  kEmpty = 0,    // nothing, or an image that was refused
  kLoading = 1,  // an incomplete image; its segments are being loaded
  kGood = 2,     // a complete image that has passed every check
};

}  // namespace tumblesight::hal
