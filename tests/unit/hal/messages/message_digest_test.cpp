// Verifies TS-TLM-020.
#include "hal/messages/message_digest.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::hal {
namespace {

template <class Message>
std::uint32_t digest_of(const Message& message) {
  gnc::Crc32 crc;
  add_to_digest(crc, message);
  return crc.value();
}

// The numbers of a field, one at a time.
template <class Number, class Use>
void for_each_number(Number& number, const Use& use) {
  use(number);
}
template <class Element, std::size_t kSize, class Use>
void for_each_number(std::array<Element, kSize>& numbers, const Use& use) {
  for (Element& number : numbers) use(number);
}

// The fields with a number whose lowest bit does not change the digest.
template <class Message>
std::multiset<std::string> silent_fields(Message message) {
  std::multiset<std::string> silent;
  const std::uint32_t before = digest_of(message);
  std::size_t field = 0;
  MessageFields<Message>::visit(
      [&](auto& numbers) {
        const std::string name = MessageFields<Message>::kNames[field++];
        for_each_number(numbers, [&](auto& number) {
          using Number = std::remove_reference_t<decltype(number)>;
          const Number kept = number;
          number = static_cast<Number>(static_cast<std::int64_t>(kept) ^ 1);
          if (digest_of(message) == before) silent.insert(name);
          number = kept;
        });
      },
      message);
  return silent;
}

TEST(MessageDigest, CoversEveryNumberOfAReport) {
  EXPECT_EQ(silent_fields(AttitudeReport{}), std::multiset<std::string>{});
}

TEST(MessageDigest, CoversEveryNumberOfTheTelemetryButThoseOfTheWallClock) {
  std::multiset<std::string> expected{"deadline_overruns",
                                      "cycle_slips",
                                      "events",
                                      "events_lost",
                                      "events_suppressed",
                                      "events_waiting",
                                      "events_waiting_max",
                                      "heap_allocations",
                                      "inference_max_us",
                                      "inference_us",
                                      "registrations_cut_short",
                                      "stack_left_min_bytes",
                                      "cycle_max_us",
                                      "cycle_us",
                                      "store_max_us",
                                      "store_us"};
  for (int bin = 0; bin < Telemetry::kCycleTimeBins; ++bin) expected.insert("cycles_by_time");
  EXPECT_EQ(silent_fields(Telemetry{}), expected);
}

TEST(MessageDigest, LeavesOutTimingFaultsOnly) {
  for (int fault = 0; fault < kFaults; ++fault) {
    Telemetry telemetry;
    telemetry.faults_persisting = 1U << fault;
    const bool is_timing =
        fault == static_cast<int>(Fault::kDeadline) || fault == static_cast<int>(Fault::kSlip);
    EXPECT_EQ(digest_of(telemetry) == digest_of(Telemetry{}), is_timing) << fault;
  }
}

TEST(MessageDigest, CoversEveryNumberOfAnEventButOfOnesOfTheWallClock) {
  for (const EventRule& rule : kEventRules) {
    Event event;
    event.id = rule.id;
    gnc::Crc32 nothing;
    if (!depends_on_wall_clock(rule.id)) {
      EXPECT_NE(digest_of(event), nothing.value());
    } else {
      EXPECT_EQ(digest_of(event), nothing.value());
    }
  }
  Event event;
  event.id = EventId::kFrameMissing;
  EXPECT_EQ(silent_fields(event), std::multiset<std::string>{});
}

}  // namespace
}  // namespace tumblesight::hal
