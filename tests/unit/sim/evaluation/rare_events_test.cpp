#include "sim/evaluation/rare_events.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

// P(X <= count) by adding up the terms of the distribution one by one.
double probability_of_at_most(std::size_t count, std::size_t of, double share) {
  double sum = 0.0;
  double term = std::pow(1.0 - share, static_cast<double>(of));
  for (std::size_t j = 0; j <= count; ++j) {
    sum += term;
    term *= static_cast<double>(of - j) / static_cast<double>(j + 1) * share / (1.0 - share);
  }
  return sum;
}

TEST(RareEvents, BoundsWithoutAnEventAreTheClosedForm) {
  for (const std::size_t of : {1U, 10U, 900U, 400'000U}) {
    const ShareBounds bounds = share_bounds_95(0, of);
    EXPECT_EQ(bounds.low, 0.0);
    EXPECT_NEAR(bounds.high, 1.0 - std::pow(0.025, 1.0 / static_cast<double>(of)), 1e-12);
    const ShareBounds all = share_bounds_95(of, of);
    EXPECT_EQ(all.high, 1.0);
    EXPECT_NEAR(all.low, std::pow(0.025, 1.0 / static_cast<double>(of)), 1e-12);
  }
}

// Published tables of the exact bounds: 1 of 10 and 5 of 10.
TEST(RareEvents, BoundsAreThoseOfTables) {
  EXPECT_NEAR(share_bounds_95(1, 10).low, 0.0025, 5e-5);
  EXPECT_NEAR(share_bounds_95(1, 10).high, 0.4450, 5e-5);
  EXPECT_NEAR(share_bounds_95(5, 10).low, 0.1871, 5e-5);
  EXPECT_NEAR(share_bounds_95(5, 10).high, 0.8129, 5e-5);
}

TEST(RareEvents, AtTheBoundsTheTailsHaveTwoAndAHalfPercent) {
  for (const std::size_t of : {7U, 60U, 200U}) {
    for (const std::size_t count : {std::size_t{1}, of / 3, of / 2, of - of / 4}) {
      const ShareBounds bounds = share_bounds_95(count, of);
      EXPECT_NEAR(probability_of_at_most(count, of, bounds.high), 0.025, 1e-9) << count << " of " << of;
      EXPECT_NEAR(1.0 - probability_of_at_most(count - 1, of, bounds.low), 0.025, 1e-9)
          << count << " of " << of;
    }
  }
}

TEST(RareEvents, BoundsWithoutATrialAreEverything) {
  EXPECT_EQ(share_bounds_95(0, 0).low, 0.0);
  EXPECT_EQ(share_bounds_95(0, 0).high, 1.0);
}

TEST(RareEvents, CountsEachKindAndKeepsTheWorstInOrder) {
  std::vector<FrameResult> last;
  for (std::uint32_t i = 0; i < 30; ++i) {
    last.push_back(result_with(i, 1, i + 0.5, 0.0));
    last.back().trusted = i % 2 == 0;
    last.back().pose.turn_deg = i < 3 ? 6.0 : 1.0;
    last.back().pose.verified = i != 1;
    last.back().pose.known = true;
  }
  const RareEvents events = rare_events(last);
  EXPECT_EQ(events.of, 30U);
  EXPECT_TRUE(events.has_poses);
  // More than 20 degrees: 20 to 29. Of these 20, 22, 24, 26 and 28 are valid. No pose is 20 degrees off; two
  // of the three that are 6 degrees off are verified.
  EXPECT_EQ(events.counts, (std::vector<std::size_t>{10, 5, 0, 2}));
  std::vector<std::uint32_t> order;
  for (const WorstSequence& one : events.worst) order.push_back(one.sequence);
  // The two verified poses, the valid wrong ones, then the rest.
  EXPECT_EQ(order, (std::vector<std::uint32_t>{2,  0,  28, 26, 24, 22, 20, 29, 27, 25,
                                               23, 21, 19, 18, 17, 16, 15, 14, 13, 12}));
  EXPECT_NEAR(events.worst[2].error_deg, 28.5, 1e-9);
}

// The model image has no surface, or is in float32.
TEST(RareEvents, SayNothingOfPosesWhereNoneIsRegistered) {
  std::vector<FrameResult> last{result_with(0, 0, 3.0, 0.0), result_with(1, 0, 25.0, 0.0)};
  last[1].trusted = true;
  const RareEvents events = rare_events(last);
  EXPECT_FALSE(events.has_poses);
  EXPECT_EQ(events.worst[0].sequence, 1U) << "by the attitude";
  EXPECT_TRUE(std::isnan(events.worst[0].pose_deg));
}

TEST(RareEvents, EqualErrorsAreInTheOrderOfTheSequences) {
  std::vector<FrameResult> last;
  for (const std::uint32_t i : {5U, 2U, 9U}) {
    last.push_back(result_with(i, 0, 1.0, 0.0));
    last.back().valid = false;
  }
  const RareEvents events = rare_events(last);
  EXPECT_EQ(events.worst[0].sequence, 2U);
  EXPECT_EQ(events.worst[1].sequence, 5U);
  EXPECT_EQ(events.worst[0].error_deg, 180.0);
}

TEST(RareEvents, TextHasTwoDigits) {
  EXPECT_EQ(count_text(0, 60), "0 (0 to 6.0 %)");
  EXPECT_EQ(count_text(2, 400'000), "2 (0.000061 to 0.0018 %)");
  EXPECT_EQ(count_text(0, 0), "-");
}

}  // namespace
}  // namespace tumblesight::sim
