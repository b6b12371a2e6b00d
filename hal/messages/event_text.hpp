// What the events of the flight application mean, for logs and reports.
#pragma once

#include "hal/messages/event_id.hpp"

namespace tumblesight::hal {

// "no frame". "unknown" for a number that is not of an event.
constexpr const char* text_of(EventId id) {
  switch (id) {
#define TUMBLESIGHT_EVENT(name, number, severity, text) \
  case EventId::k##name:                                \
    return text;
#include "hal/messages/events.inc"
#undef TUMBLESIGHT_EVENT
  }
  return "unknown";
}

}  // namespace tumblesight::hal
