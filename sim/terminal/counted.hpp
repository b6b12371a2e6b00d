// A number with its noun.
#pragma once

#include <cstdint>
#include <string>

namespace tumblesight::sim {

// "1 frame", "2 frames".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace tumblesight::sim
