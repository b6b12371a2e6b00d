#include "fsw/app/event_log.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kMask = config::kEventRing - 1;

constexpr std::size_t index_of(EventId id) {
  for (std::size_t i = 0; i < kEventRules.size(); ++i) {
    if (kEventRules[i].id == id) return i;
  }
  return kEventRules.size();
}

// The event that reports suppressed events of this kind.
const EventRule& summary_of(EventId id) {
  constexpr std::size_t kOfTiming = index_of(EventId::kTimingEventsSuppressed);
  constexpr std::size_t kOfOthers = index_of(EventId::kEventsSuppressed);
  static_assert(kOfTiming < kEventRules.size() && kOfOthers < kEventRules.size());
  return kEventRules[hal::depends_on_wall_clock(id) ? kOfTiming : kOfOthers];
}

}  // namespace

void EventLog::push(std::int64_t now_ns, const EventRule& rule, const std::array<std::int32_t, 3>& arguments,
                    hal::Telemetry& counters) {
  count(counters.events);
  if (waiting() == config::kEventRing) {
    count(counters.events_lost);
    return;
  }
  hal::Event& event = ring_[(first_ + count_++) & kMask];
  event.time_ns = now_ns;
  event.id = rule.id;
  event.severity = rule.severity;
  event.arguments = arguments;
}

void EventLog::raise(std::int64_t now_ns, EventId id, const std::array<std::int32_t, 3>& arguments,
                     const EventLimits& limits, hal::Telemetry& counters) {
  const std::size_t index = index_of(id);
  Kind& kind = kinds_[index];
  if (kind.raised < limits.events_of_a_kind) {
    ++kind.raised;
    push(now_ns, kEventRules[index], arguments, counters);
  } else {
    if (kind.suppressed < UINT16_MAX) ++kind.suppressed;
    count(counters.events);
    count(counters.events_suppressed);
  }
}

void EventLog::end_cycle(std::int64_t now_ns, const EventLimits& limits, hal::Telemetry& counters) {
  if (++cycle_ < limits.window_cycles) return;
  cycle_ = 0;
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const Kind kind = kinds_[i];
    kinds_[i] = {};
    if (kind.suppressed == 0) continue;
    push(now_ns, summary_of(kEventRules[i].id),
         {static_cast<std::int32_t>(kEventRules[i].id), kind.suppressed, 0}, counters);
  }
}

bool EventLog::take(hal::Event& event) {
  if (waiting() == 0) return false;
  count_ = waiting() - 1;
  event = ring_[first_ & kMask];
  first_ = (first_ + 1) & kMask;
  return true;
}

}  // namespace tumblesight::fsw
