#include "gnc/estimation/frame_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "gnc/rcnn/attitude_track.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kNow_ns = 1'000'000'000'000;
constexpr std::int64_t kLowest_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest_ns = std::numeric_limits<std::int64_t>::max();

constexpr FrameTimeLimits kLimits{1'000'000, 2'970'000'000};

RangeImage frame(std::uint32_t number, std::int64_t exposure_ns) {
  RangeImage result;
  result.sequence_number = number;
  result.exposure_time_ns = exposure_ns;
  return result;
}

TEST(FrameGate, FirstFrameNeedsOnlyARecentExposure) {
  const FrameGate gate;
  EXPECT_EQ(gate.judge(frame(0, kNow_ns), kNow_ns, kLimits), FrameVerdict::kPass);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns + kLimits.future_tolerance_ns), kNow_ns, kLimits),
            FrameVerdict::kPass);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns + kLimits.future_tolerance_ns + 1), kNow_ns, kLimits),
            FrameVerdict::kFromFuture);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns - kLimits.max_age_ns), kNow_ns, kLimits), FrameVerdict::kPass);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns - kLimits.max_age_ns - 1), kNow_ns, kLimits), FrameVerdict::kStale);
  EXPECT_EQ(gate.numbers_skipped(frame(77, kNow_ns)), 0U);
  EXPECT_EQ(gate.elapsed_ns(frame(0, kNow_ns)), 0) << "there is no last frame";
}

TEST(FrameGate, LaterFramesNeedAnotherNumberAndALaterExposure) {
  FrameGate gate;
  gate.accept(frame(5, kNow_ns));
  EXPECT_EQ(gate.judge(frame(5, kNow_ns + 10), kNow_ns + 10, kLimits), FrameVerdict::kDuplicate);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns), kNow_ns + 10, kLimits), FrameVerdict::kExposureBackwards);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns - 1), kNow_ns + 10, kLimits), FrameVerdict::kExposureBackwards);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns + 1), kNow_ns + 10, kLimits), FrameVerdict::kTooSoon);
  const std::int64_t soonest_ns = kNow_ns + kShortestInterval_ns;
  EXPECT_EQ(gate.judge(frame(6, soonest_ns - 1), soonest_ns, kLimits), FrameVerdict::kTooSoon);
  EXPECT_EQ(gate.judge(frame(6, soonest_ns), soonest_ns, kLimits), FrameVerdict::kPass);
  gate.forget();
  EXPECT_EQ(gate.judge(frame(5, kNow_ns), kNow_ns, kLimits), FrameVerdict::kPass);
}

TEST(FrameGate, ExtremeTimesDoNotOverflow) {
  FrameGate gate;
  EXPECT_EQ(gate.judge(frame(1, kLowest_ns), kHighest_ns, kLimits), FrameVerdict::kStale);
  EXPECT_EQ(gate.judge(frame(1, kHighest_ns), kLowest_ns, kLimits), FrameVerdict::kFromFuture);
  gate.accept(frame(1, kLowest_ns));
  EXPECT_EQ(gate.judge(frame(2, kHighest_ns), kHighest_ns, kLimits), FrameVerdict::kPass);
  EXPECT_EQ(gate.elapsed_ns(frame(2, kHighest_ns)), kHighest_ns) << "saturates";
  gate.accept(frame(1, kHighest_ns));
  EXPECT_EQ(gate.elapsed_ns(frame(2, kLowest_ns + 5)), 0) << "not the difference modulo 2^64";
}

TEST(FrameGate, SkippedNumbersAreCountedAcrossTheWrap) {
  FrameGate gate;
  gate.accept(frame(UINT32_MAX - 1, kNow_ns));
  EXPECT_EQ(gate.numbers_skipped(frame(UINT32_MAX, kNow_ns)), 0U);
  EXPECT_EQ(gate.numbers_skipped(frame(0, kNow_ns)), 1U);
  EXPECT_EQ(gate.numbers_skipped(frame(4, kNow_ns)), 5U);
  EXPECT_EQ(gate.numbers_skipped(frame(UINT32_MAX - 2, kNow_ns)), FrameGate::kWentBack);
  EXPECT_EQ(gate.numbers_skipped(frame(UINT32_MAX - 1, kNow_ns)), FrameGate::kWentBack);
  EXPECT_EQ(gate.numbers_skipped(frame(0x7FFF'FFFDU, kNow_ns)), 0x7FFF'FFFEU)
      << "the largest number that counts as ahead";
  EXPECT_EQ(gate.numbers_skipped(frame(0x7FFF'FFFEU, kNow_ns)), FrameGate::kWentBack);
}

}  // namespace
}  // namespace tumblesight::gnc
