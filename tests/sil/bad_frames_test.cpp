#include <gtest/gtest.h>

#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

using test::Conversation;

constexpr hal::Validity kNoFrame = hal::Validity::kNoFrame;
constexpr hal::Validity kFrameRefused = hal::Validity::kFrameRefused;

class BadFrames : public ::testing::Test {
 protected:
  BadFrames() : conversation_(test::settings()) {
    for (int i = 0; i < 3; ++i) before_ = conversation_.step();
  }
  // After the bad frame a good one is used. No other counters have changed.
  void expect_recovery(std::uint32_t refused) {
    const StepAnswer after = conversation_.finish();
    EXPECT_TRUE(gives_attitude(after.attitude));
    EXPECT_EQ(after.telemetry.frames_refused, refused);
    EXPECT_EQ(after.telemetry.frames_used, before_.telemetry.frames_used + 1);
    EXPECT_EQ(after.telemetry.heap_allocations, 0U);
  }

  Conversation conversation_;
  StepAnswer before_;
};

// Verifies TS-LID-050.
TEST_F(BadFrames, RepeatedSequenceNumberIsADuplicate) {
  gnc::RangeImage frame = conversation_.good_frame();
  --frame.sequence_number;
  const StepAnswer answer = conversation_.step({frame});
  EXPECT_EQ(answer.attitude.validity, kFrameRefused);
  EXPECT_EQ(answer.telemetry.frames_duplicate, 1U);
  expect_recovery(1);
}

// Verifies TS-LID-060.
TEST_F(BadFrames, SkippedSequenceNumberIsCountedAndTheFrameUsed) {
  gnc::RangeImage frame = conversation_.good_frame();
  frame.sequence_number += 5;
  const StepAnswer answer = conversation_.step({frame});
  EXPECT_TRUE(gives_attitude(answer.attitude));
  EXPECT_EQ(answer.telemetry.sequence_gaps, 5U);
  EXPECT_EQ(answer.telemetry.frames_refused, 0U);
}

// Verifies TS-LID-050.
TEST_F(BadFrames, FrameOlderThanThePreviousOneIsRefused) {
  gnc::RangeImage frame = conversation_.good_frame();
  frame.exposure_time_ns -= 2 * kFramePeriod_ns;
  const StepAnswer answer = conversation_.step({frame});
  EXPECT_EQ(answer.attitude.validity, kFrameRefused);
  EXPECT_EQ(answer.telemetry.frames_stale, 1U);
  expect_recovery(1);
}

// Verifies TS-LID-020.
TEST_F(BadFrames, EmptyFrameIsRefused) {
  gnc::RangeImage frame = conversation_.good_frame();
  frame.ranges.fill(0);
  const StepAnswer answer = conversation_.step({frame});
  EXPECT_EQ(answer.attitude.validity, kFrameRefused);
  EXPECT_EQ(answer.telemetry.frames_bad, 1U);
  expect_recovery(1);
}

// Verifies TS-LID-020.
TEST_F(BadFrames, FrameWithAllReturnsAtOneRangeIsRefused) {
  gnc::RangeImage frame = conversation_.good_frame();
  frame.ranges.fill(6400);
  const StepAnswer answer = conversation_.step({frame});
  EXPECT_EQ(answer.attitude.validity, kFrameRefused);
  EXPECT_EQ(answer.telemetry.frames_bad, 1U);
  expect_recovery(1);
}

// Verifies TS-LID-010.
TEST_F(BadFrames, ImpossibleRayCountsAreRefused) {
  std::uint32_t bad = 0;
  for (const int rays : {0, 8, 129, 65'535}) {
    gnc::RangeImage frame = conversation_.good_frame();
    frame.rays = static_cast<std::uint16_t>(rays);
    const StepAnswer answer = conversation_.step({frame});
    EXPECT_EQ(answer.attitude.validity, kFrameRefused) << rays;
    EXPECT_EQ(answer.telemetry.frames_bad, ++bad) << rays;
    EXPECT_FALSE(answer.events.empty()) << rays;
  }
  expect_recovery(4);
}

// Verifies TS-LID-060.
TEST_F(BadFrames, MissingFrameIsCounted) {
  const StepAnswer answer = conversation_.step({});
  EXPECT_EQ(answer.attitude.validity, kNoFrame);
  EXPECT_EQ(answer.telemetry.frames_missing, 1U);
  expect_recovery(0);
}

TEST_F(BadFrames, MalformedCommandIsRefusedAndTheFrameUsed) {
  const StepAnswer answer =
      conversation_.step({conversation_.good_frame()}, {{hal::FunctionCode::kNoop, {1}}});
  EXPECT_TRUE(gives_attitude(answer.attitude));
  EXPECT_EQ(answer.telemetry.commands_refused, 1U);
}

}  // namespace
}  // namespace tumblesight::sim
