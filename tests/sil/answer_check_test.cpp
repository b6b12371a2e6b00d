#include "sim/sil/answer_check.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kTime_ns = 8'100'000'000;

gnc::RangeImage frame_with(std::uint32_t number, std::int64_t exposure_ns) {
  gnc::RangeImage frame;
  frame.sequence_number = number;
  frame.exposure_time_ns = exposure_ns;
  return frame;
}

StepAnswer good_answer() {
  StepAnswer answer;
  answer.k = 2;
  answer.attitude.time_ns = answer.telemetry.time_ns = kTime_ns;
  answer.attitude.validity = hal::Validity::kValid;
  answer.attitude.sequence_number = 40;
  answer.attitude.exposure_time_ns = kTime_ns - 5;
  answer.events.resize(1);
  answer.events[0].time_ns = kTime_ns - 100;  // one that had to wait
  return answer;
}

struct Change {
  const char* what;
  std::function<void(StepAnswer&)> apply;
};

const Change kChanges[] = {
    {"instead of step 2", [](StepAnswer& a) { a.k = 1; }},
    {"instead of step 2", [](StepAnswer& a) { a.k = 3; }},
    {"cycle time", [](StepAnswer& a) { a.attitude.time_ns -= 1; }},
    {"cycle time", [](StepAnswer& a) { a.telemetry.time_ns += 1; }},
    {"not sent", [](StepAnswer& a) { a.attitude.sequence_number = 41; }},
    {"not sent", [](StepAnswer& a) { a.attitude.exposure_time_ns += 1; }},
    {"not sent", [](StepAnswer& a) { a.attitude.sequence_number = 39; }},  // of the step before
    {"event", [](StepAnswer& a) { a.events[0].time_ns = kTime_ns + 1; }},
};

// Verifies TS-SIL-090.
TEST(AnswerCheck, InLockstepOnlyTheAnswerToTheStepAndItsFramePasses) {
  const gnc::RangeImage before = frame_with(39, kTime_ns - 2'700'000'005);
  const gnc::RangeImage now = frame_with(40, kTime_ns - 5);
  AnswerCheck check(false);
  check.sent(1, kTime_ns - 2'700'000'000, {&before});
  check.sent(2, kTime_ns, {&now});
  EXPECT_EQ(check.fault_of(good_answer()), "");
  for (const Change& change : kChanges) {
    StepAnswer answer = good_answer();
    change.apply(answer);
    EXPECT_NE(check.fault_of(answer).find(change.what), std::string::npos)
        << "change " << &change - kChanges << ": " << check.fault_of(answer);
  }
}

TEST(AnswerCheck, AnAnswerWithoutAttitudeNeedsNoFrame) {
  AnswerCheck check(false);
  check.sent(2, kTime_ns, {});
  StepAnswer answer = good_answer();
  EXPECT_NE(check.fault_of(answer), "");
  answer.attitude.validity = hal::Validity::kNoFrame;
  answer.attitude.sequence_number = 0;
  answer.attitude.exposure_time_ns = 0;
  EXPECT_EQ(check.fault_of(answer), "");
}

// Verifies TS-SIL-090.
TEST(AnswerCheck, FreeRunningAnAttitudeMayBeToAnyFrameSent) {
  const gnc::RangeImage before = frame_with(39, kTime_ns - 2'700'000'005);
  const gnc::RangeImage now = frame_with(40, kTime_ns - 5);
  AnswerCheck check(true);
  check.sent(1, kTime_ns - 2'700'000'000, {&before});
  check.sent(2, kTime_ns, {&now});
  StepAnswer answer = good_answer();
  answer.k = 77;
  EXPECT_EQ(check.fault_of(answer), "");
  answer.attitude.sequence_number = 39;
  EXPECT_NE(check.fault_of(answer), "") << "number and exposure time of two frames";
  answer.attitude.exposure_time_ns = before.exposure_time_ns;
  EXPECT_EQ(check.fault_of(answer), "");
  answer.telemetry.time_ns += 1;
  EXPECT_NE(check.fault_of(answer), "");
}

}  // namespace
}  // namespace tumblesight::sim
