#include "sim/evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {
namespace {

// Deviations -3, -1, 1, 3: s^2 = 20 / 3.
TEST(MeanStandardError, IsTheSamplesDeviationOverRootN) {
  EXPECT_DOUBLE_EQ(mean_standard_error({1.0, 3.0, 5.0, 7.0}), std::sqrt(20.0 / 3.0 / 4.0));
  EXPECT_DOUBLE_EQ(summarise({7.0, 1.0, 5.0, 3.0}).mean_standard_error_deg, std::sqrt(20.0 / 3.0 / 4.0));
}

TEST(MeanStandardError, IsZeroForFewerThanTwoValues) {
  EXPECT_EQ(mean_standard_error({}), 0.0);
  EXPECT_EQ(mean_standard_error({4.0}), 0.0);
}

TEST(ShareStandardError, IsBinomial) {
  EXPECT_NEAR(share_standard_error(0.5, 10'000), 0.005, 1e-9);
  EXPECT_NEAR(share_standard_error(0.9, 1'000'000), std::sqrt(0.09 / 1e6), 1e-9);
  EXPECT_EQ(share_standard_error(0.5, 0), 0.0);
}

TEST(ShareStandardError, OfAllIsNotZero) {
  const double p = 50.5 / 51.0;
  EXPECT_DOUBLE_EQ(share_standard_error(1.0, 50), std::sqrt(p * (1.0 - p) / 50.0));
  EXPECT_NEAR(share_standard_error(0.0, 50), share_standard_error(1.0, 50), 1e-15);
}

TEST(FiguresAsText, CarryTheirStandardError) {
  EXPECT_EQ(degrees_text(2.391, 0.0349), "2.39 ± 0.03°");
  EXPECT_EQ(degrees_text(12.5), "12.50°");
  EXPECT_EQ(percent_text(0.8, 400), "80.0 ± 2.0 %");
  EXPECT_EQ(percent_text(0.998), "99.8 %");
}

}  // namespace
}  // namespace tumblesight::sim
