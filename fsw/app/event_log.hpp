// EventLog: a bounded ring of events on their way out. An event that comes too often is only counted, and the
// end of the window tells how often. Whatever a bit flip makes of its indices, it stays within its memory.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/events.hpp"
#include "fsw/config/limits.hpp"
#include "hal/link.hpp"

namespace tumblesight::fsw {

class EventLog {
 public:
  // Counts into `counters`: events (all), events_suppressed, events_lost.
  void raise(std::int64_t now_ns, EventId id, std::int32_t a, std::int32_t b, std::int32_t c,
             hal::Housekeeping& counters);
  // At the end of every cycle.
  void end_cycle(std::int64_t now_ns, hal::Housekeeping& counters);
  // The oldest one. False: there is none.
  bool take(hal::Event& event);
  std::uint32_t waiting() const { return count_ < config::kEventRing ? count_ : config::kEventRing; }

 private:
  struct Kind {
    std::uint16_t told = 0;        // in this window
    std::uint16_t suppressed = 0;  // likewise
  };
  void push(std::int64_t now_ns, const EventRule& rule, const std::array<std::int32_t, 3>& arguments,
            hal::Housekeeping& counters);

  std::array<hal::Event, config::kEventRing> ring_{};
  std::array<Kind, kEventRules.size()> kinds_{};
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t cycle_ = 0;  // of the window
};

}  // namespace tumblesight::fsw
