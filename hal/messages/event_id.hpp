// The events of the flight application and their severity, generated from the rows of events.inc.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/command_refusal.hpp"

namespace tumblesight::hal {

enum class Severity : std::uint8_t { kInformation = 0, kWarning = 1, kError = 2 };

enum class EventId : std::uint16_t {
#define TUMBLESIGHT_EVENT(name, number, severity, text) k##name = (number),
#include "hal/messages/events.inc"
#undef TUMBLESIGHT_EVENT
};

struct EventRule {
  EventId id;
  Severity severity;
};

#define TUMBLESIGHT_EVENT(name, number, severity, text) +1
inline constexpr int kEvents = 0
#include "hal/messages/events.inc"
    ;
#undef TUMBLESIGHT_EVENT

inline constexpr std::array<EventRule, kEvents> kEventRules{{
#define TUMBLESIGHT_EVENT(name, number, severity, text) {EventId::k##name, Severity::k##severity},
#include "hal/messages/events.inc"
#undef TUMBLESIGHT_EVENT
}};

// The event that reports a refusal.
constexpr EventId event_of(CommandRefusal why) {
  const int first = static_cast<int>(why) < 10 ? 60 : 90;
  return static_cast<EventId>(first + static_cast<int>(why));
}

// Whether the event differs between two runs with the same inputs.
constexpr bool depends_on_wall_clock(EventId id) {
  return static_cast<int>(id) > 20 && static_cast<int>(id) < 30;
}

}  // namespace tumblesight::hal
