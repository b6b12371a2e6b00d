#include "fsw/app/frame_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fsw/app/counter.hpp"
#include "fsw/config/limits.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::int64_t kNow_ns = 1'000'000'000'000;
constexpr std::int64_t kLowest_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest_ns = std::numeric_limits<std::int64_t>::max();

gnc::RangeImage frame(std::uint32_t number, std::int64_t exposure_ns) {
  gnc::RangeImage result;
  result.sequence_number = number;
  result.exposure_time_ns = exposure_ns;
  return result;
}

TEST(FrameGate, FirstFrameNeedsOnlyARecentExposure) {
  const FrameGate gate;
  EXPECT_EQ(gate.judge(frame(0, kNow_ns), kNow_ns), FrameVerdict::kPass);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns + 1), kNow_ns), FrameVerdict::kFromFuture);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns - config::kMaxFrameAge_ns), kNow_ns), FrameVerdict::kPass);
  EXPECT_EQ(gate.judge(frame(0, kNow_ns - config::kMaxFrameAge_ns - 1), kNow_ns), FrameVerdict::kStale);
  EXPECT_EQ(gate.numbers_skipped(frame(77, kNow_ns)), 0U);
  EXPECT_FALSE(gate.one_period_after_last(frame(0, kNow_ns)));
  EXPECT_FALSE(gate.one_period_after_last(frame(0, config::kFramePeriod_ns)))
      << "there is no last frame at time 0";
}

TEST(FrameGate, LaterFramesNeedAnotherNumberAndALaterExposure) {
  FrameGate gate;
  gate.accept(frame(5, kNow_ns));
  EXPECT_EQ(gate.judge(frame(5, kNow_ns + 10), kNow_ns + 10), FrameVerdict::kDuplicate);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns), kNow_ns + 10), FrameVerdict::kExposureBackwards);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns - 1), kNow_ns + 10), FrameVerdict::kExposureBackwards);
  EXPECT_EQ(gate.judge(frame(6, kNow_ns + 1), kNow_ns + 10), FrameVerdict::kPass);
  gate.forget();
  EXPECT_EQ(gate.judge(frame(5, kNow_ns), kNow_ns), FrameVerdict::kPass);
}

TEST(FrameGate, ExtremeTimesDoNotOverflow) {
  FrameGate gate;
  EXPECT_EQ(gate.judge(frame(1, kLowest_ns), kHighest_ns), FrameVerdict::kStale);
  EXPECT_EQ(gate.judge(frame(1, kHighest_ns), kLowest_ns), FrameVerdict::kFromFuture);
  gate.accept(frame(1, kLowest_ns));
  EXPECT_EQ(gate.judge(frame(2, kHighest_ns), kHighest_ns), FrameVerdict::kPass);
  EXPECT_FALSE(gate.one_period_after_last(frame(2, kHighest_ns)));
  gate.accept(frame(1, kHighest_ns));
  EXPECT_FALSE(gate.one_period_after_last(frame(2, kLowest_ns + (config::kFramePeriod_ns - 1))))
      << "modulo 2^64 it would be one period";
  EXPECT_EQ(elapsed_ms(kLowest_ns, kHighest_ns), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(elapsed_ms(kHighest_ns, kLowest_ns), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(elapsed_ms(kNow_ns, kNow_ns - 3'000'000), -3);
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

TEST(FrameGate, OnePeriodIsWithinTenPercent) {
  FrameGate gate;
  gate.accept(frame(1, kNow_ns));
  const auto after = [&](std::int64_t gap_ns) {
    return gate.one_period_after_last(frame(2, kNow_ns + gap_ns));
  };
  EXPECT_TRUE(after(config::kFramePeriod_ns));
  EXPECT_TRUE(after(2'430'000'000));
  EXPECT_FALSE(after(2'430'000'000 - 1));
  EXPECT_TRUE(after(2'970'000'000));
  EXPECT_FALSE(after(2'970'000'000 + 1));
  EXPECT_FALSE(after(-config::kFramePeriod_ns));
}

TEST(Counter, SaturatesInsteadOfWrapping) {
  std::uint32_t counter = UINT32_MAX - 2;
  count(counter);
  EXPECT_EQ(counter, UINT32_MAX - 1);
  count(counter, 5);
  EXPECT_EQ(counter, UINT32_MAX);
  count(counter);
  EXPECT_EQ(counter, UINT32_MAX);
}

}  // namespace
}  // namespace tumblesight::fsw
