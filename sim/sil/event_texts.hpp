// What the events of the flight program mean, for reports.
#pragma once

#include <string>

#include "hal/messages/event_id.hpp"

namespace tumblesight::sim {

// "no frame". "unknown" for a number that is not of an event.
std::string text_of(hal::EventId id);

}  // namespace tumblesight::sim
