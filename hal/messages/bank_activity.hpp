// What the memory of a model bank is doing.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class BankActivity : std::uint8_t {
  kReady = 0,  // everything accepted can be read
  kErasing = 1,
  kWriting = 2,
  kFailed = 3,  // an accepted write has failed, until the next write to the bank
};

}  // namespace tumblesight::hal
