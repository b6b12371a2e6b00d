// Event: something that happened in a cycle and that the ground should know of.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/event_id.hpp"

namespace tumblesight::hal {

struct Event {
  std::int64_t time_ns = 0;  // cycle time
  EventId id{};
  Severity severity = Severity::kInformation;
  std::array<std::int32_t, 3> arguments{};  // by EventId
};

}  // namespace tumblesight::hal
