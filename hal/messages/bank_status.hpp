#pragma once

#include <cstdint>

namespace tumblesight::hal {

// What a model bank holds.
enum class BankStatus : std::uint8_t {
  kEmpty = 0,    // nothing, or an image that was refused
  kLoading = 1,  // an incomplete image; its segments are being loaded
  kGood = 2,     // a complete image that has passed every check
};

// What the memory of a model bank is doing.
enum class BankActivity : std::uint8_t {
  kReady = 0,  // everything accepted can be read
  kErasing = 1,
  kWriting = 2,
  kFailed = 3,  // an accepted write has failed, until the next write to the bank
};

}  // namespace tumblesight::hal
