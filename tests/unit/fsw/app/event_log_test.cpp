// Verifies TS-TLM-030, TS-TLM-040.
#include "fsw/app/event_log.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace tumblesight::fsw {
namespace {

constexpr int kMost = 8;
constexpr EventLimits kLimits{kMost, 16};

class EventLogTest : public ::testing::Test {
 protected:
  void raise(EventId id, int times = 1) {
    for (int i = 0; i < times; ++i) log.raise(1, id, {i, 0, 0}, kLimits, counters);
  }
  std::vector<hal::Event> take_all() {
    std::vector<hal::Event> events;
    for (hal::Event event; log.take(event);) events.push_back(event);
    return events;
  }
  void end_window() {
    for (std::uint32_t i = 0; i < kLimits.window_cycles; ++i) log.end_cycle(2, kLimits, counters);
  }

  EventLog log;
  hal::Telemetry counters;
};

TEST_F(EventLogTest, ReturnsEventsInOrder) {
  raise(EventId::kFrameStale);
  raise(EventId::kFrameBad);
  const std::vector<hal::Event> events = take_all();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].id, EventId::kFrameStale);
  EXPECT_EQ(events[0].severity, Severity::kWarning);
  EXPECT_EQ(events[1].id, EventId::kFrameBad);
  EXPECT_EQ(log.waiting(), 0U);
}

TEST_F(EventLogTest, TooManyOfAKindAreCountedAndReportedAtTheEndOfTheWindow) {
  raise(EventId::kFrameStale, kMost + 5);
  raise(EventId::kFrameBad);
  EXPECT_EQ(counters.events_suppressed, 5U);
  EXPECT_EQ(take_all().size(), kMost + 1U);
  end_window();
  const std::vector<hal::Event> summary = take_all();
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].id, EventId::kEventsSuppressed);
  EXPECT_EQ(summary[0].arguments,
            (std::array<std::int32_t, 3>{static_cast<int>(EventId::kFrameStale), 5, 0}));
  raise(EventId::kFrameStale);
  EXPECT_EQ(take_all().size(), 1U) << "a new window";
}

TEST_F(EventLogTest, SuppressedWallClockEventsAreReportedSeparately) {
  raise(EventId::kDeadlineOverrun, kMost + 2);
  take_all();
  end_window();
  const std::vector<hal::Event> summary = take_all();
  ASSERT_EQ(summary.size(), 1U);
  EXPECT_EQ(summary[0].id, EventId::kTimingEventsSuppressed);
  EXPECT_TRUE(hal::depends_on_wall_clock(summary[0].id));
}

TEST_F(EventLogTest, FullRingLosesTheNewestAndCountsThem) {
  for (int kind = 0; kind < 5; ++kind) raise(kEventRules[static_cast<std::size_t>(kind)].id, kMost);
  EXPECT_EQ(counters.events_lost, 5U * kMost - config::kEventRing);
  EXPECT_EQ(log.waiting(), static_cast<std::uint32_t>(config::kEventRing));
  EXPECT_EQ(take_all().size(), static_cast<std::size_t>(config::kEventRing));
}

TEST_F(EventLogTest, EveryEventIsAccountedFor) {
  std::uint32_t taken = 0;
  for (int cycle = 0; cycle < 200; ++cycle) {
    for (const EventRule& rule : kEventRules) raise(rule.id, cycle % 4);
    hal::Event event;
    for (int i = 0; i < 11 && log.take(event); ++i) ++taken;
    log.end_cycle(2, kLimits, counters);
  }
  EXPECT_EQ(counters.events, taken + log.waiting() + counters.events_suppressed + counters.events_lost);
}

TEST_F(EventLogTest, StaysWithinItsMemoryAfterAnyBitFlip) {
  for (std::size_t bit = 0; bit < 8 * sizeof(EventLog); ++bit) {
    EventLog hit = log;
    reinterpret_cast<std::uint8_t*>(&hit)[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    hal::Telemetry of_hit;
    hit.raise(1, EventId::kFrameBad, {0, 0, 0}, kLimits, of_hit);
    hit.end_cycle(1, kLimits, of_hit);
    int taken = 0;
    for (hal::Event event; hit.take(event);) ++taken;
    ASSERT_LE(taken, config::kEventRing);
  }
}

TEST(EventRules, NameEveryEventOnce) {
  std::set<EventId> ids;
  for (const EventRule& rule : kEventRules)
    EXPECT_TRUE(ids.insert(rule.id).second) << static_cast<int>(rule.id);
}

}  // namespace
}  // namespace tumblesight::fsw
