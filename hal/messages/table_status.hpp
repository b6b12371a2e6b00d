// What was done with the parameter table that was uplinked.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class TableStatus : std::uint8_t {
  kEmpty = 0,      // there is none, or it is active by now
  kLoaded = 1,     // whole, by its CRC-32
  kValidated = 2,  // every field has an allowed value
};

}  // namespace tumblesight::hal
