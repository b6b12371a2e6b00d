#include "gnc/tracking/covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gnc/rcnn/attitude_estimator.hpp"

namespace tumblesight::gnc {
namespace {

TEST(AttitudeCovariance, IsThatOfThreeEqualNormalErrors) {
  for (const double error_rad : {0.001, 0.02, 0.5, 3.14159}) {
    const CovarianceE8 covariance = attitude_covariance(static_cast<std::uint32_t>(1e6 * error_rad));
    const double variance = std::acos(-1.0) / 8.0 * error_rad * error_rad;
    EXPECT_NEAR(1e-8 * covariance[0], variance, 1e-3 * variance + 2e-8);
    EXPECT_EQ(covariance, (CovarianceE8{covariance[0], 0, 0, covariance[0], 0, covariance[0]}));
  }
  EXPECT_EQ(attitude_covariance(UINT32_MAX), attitude_covariance(kPi_urad)) << "limited to a half turn";
  EXPECT_EQ(rate_covariance(UINT32_MAX, 2, 2'700'000'000), rate_covariance(kPi_urad, 2, 2'700'000'000));
}

TEST(RateCovariance, IsThatOfALineThroughTheFrames) {
  constexpr std::uint32_t kError_urad = 20'000;
  const double attitude = 1e-8 * attitude_covariance(kError_urad)[0];
  for (const int frames : {2, 3, 10, 1000}) {
    for (const double interval_s : {0.2, 2.7, 21.6}) {
      const int k = std::min(frames, 10);
      const double expected =
          std::min(0.5, attitude * 6.0 / ((k - 1) * (2 * k - 1)) / (interval_s * interval_s));
      const CovarianceE8 rate = rate_covariance(kError_urad, static_cast<std::uint32_t>(frames),
                                                static_cast<std::int64_t>(1e9 * interval_s));
      EXPECT_NEAR(1e-8 * rate[0], expected, 1e-3 * expected + 2e-8);
    }
  }
}

TEST(RateCovariance, IsUnknownAfterTheFirstFrameAndNeverLarger) {
  EXPECT_EQ(rate_covariance(10, 1, 2'700'000'000)[0], kUnknownRateVarianceE8);
  EXPECT_EQ(rate_covariance(kPi_urad, 2, 1)[0], kUnknownRateVarianceE8);
}

}  // namespace
}  // namespace tumblesight::gnc
