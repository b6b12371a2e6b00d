#include "sim/operations/fault_names.hpp"

#include <array>
#include <cstddef>

namespace tumblesight::sim {

std::string name_of(hal::Fault fault) {
  constexpr std::array<const char*, hal::kFaults> kNames{
      "STATE_LOST",    "MODEL_CORRUPTED", "ATTITUDE_UNSOUND", "ERROR_LARGE",
      "ATTITUDE_JUMP", "OUTAGE",          "DEADLINE",         "SLIP",
      "FRAME_FROZEN",  "TRACK_RESTARTS"};
  const auto index = static_cast<std::size_t>(fault);
  return index < kNames.size() ? kNames[index] : "FAULT " + std::to_string(index);
}

}  // namespace tumblesight::sim
