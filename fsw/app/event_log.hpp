// EventLog: a ring of fixed size for the events that wait to be sent. Events of one kind beyond
// EventLimits::events_of_a_kind per window are only counted, and one event at the end of the window reports
// their number. Accesses stay within the ring even if a bit flip changes an index.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::fsw {

using hal::event_of;
using hal::EventId;
using hal::EventRule;
using hal::kEventRules;
using hal::Severity;

struct EventLimits {
  std::uint32_t events_of_a_kind;  // per window
  std::uint32_t window_cycles;
};

class EventLog {
 public:
  // Adds an event, or suppresses it, or loses it if the ring is full. Counts in `counters`: events (every
  // call), events_suppressed, events_lost.
  void raise(std::int64_t now_ns, EventId id, const std::array<std::int32_t, 3>& arguments,
             const EventLimits& limits, hal::Telemetry& counters);
  // At the end of every cycle; at the end of a window adds the events that report suppressed ones.
  void end_cycle(std::int64_t now_ns, const EventLimits& limits, hal::Telemetry& counters);
  // Removes the oldest event. False: there is none.
  bool take(hal::Event& event);
  std::uint32_t waiting() const { return count_ < config::kEventRing ? count_ : config::kEventRing; }

 private:
  struct Kind {
    std::uint16_t raised = 0;      // in this window, not suppressed
    std::uint16_t suppressed = 0;  // in this window
  };
  void push(std::int64_t now_ns, const EventRule& rule, const std::array<std::int32_t, 3>& arguments,
            hal::Telemetry& counters);

  std::array<hal::Event, config::kEventRing> ring_{};
  std::array<Kind, kEventRules.size()> kinds_{};
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t cycle_ = 0;  // within the window
};

}  // namespace tumblesight::fsw
