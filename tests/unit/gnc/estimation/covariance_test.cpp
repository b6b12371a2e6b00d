#include "gnc/estimation/covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gnc/estimation/attitude_estimator.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/gnc/rcnn/track_frames.hpp"

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
    for (const double interval_s : {0.2, 1.0, 2.7}) {
      const int k = std::min(frames, 10);
      const double expected =
          std::min(0.5, attitude * 6.0 / ((k - 1) * (2 * k - 1)) / (interval_s * interval_s));
      const CovarianceE8 rate = rate_covariance(kError_urad, static_cast<std::uint32_t>(frames),
                                                static_cast<std::int64_t>(1e9 * interval_s));
      EXPECT_NEAR(1e-8 * rate[0], expected, 1e-3 * expected + 2e-8);
    }
  }
}

TEST(Covariances, AreNeverSingular) {
  for (const std::uint32_t error_urad : {0U, 1U, 160U, 1'000U, 5'000U}) {
    EXPECT_GE(attitude_covariance(error_urad)[0], 1);
    for (const std::int64_t periods : {0, 1, 2, 4, 8})
      EXPECT_GE(rate_covariance(error_urad, 1000, periods * kNominalPeriod_ns)[0], 1);
  }
}

// The variance per axis of the rate of many tracks of a target that turns at 9 degrees per period,
// [rad^2/s^2]. The last of the intervals is `last_periods`, the others are nominal.
double true_rate_variance(int frames, double last_periods, double sigma_rad) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0, sigma_rad);
  const Eigen::Vector3d rate = 9.0 * kDegree * Eigen::Vector3d(0.4, -0.3, 0.8).normalized();
  constexpr int kTracks = trials(800);
  double sum = 0.0;
  for (int i = 0; i < kTracks; ++i) {
    AttitudeTrack<float> track;
    double time = 0.0;
    for (int k = 0; k < frames; ++k) {
      const double periods = k == frames - 1 ? last_periods : 1.0;
      FrameInterval interval;
      interval.elapsed_ns = static_cast<std::int64_t>(periods * static_cast<double>(kNominalPeriod_ns));
      time += periods;
      const Eigen::Vector3d error(normal(engine), normal(engine), normal(engine));
      const Eigen::Matrix3d seen =
          turn(error) * turn(Eigen::Vector3d(time * rate)) * turn(2.2, {1.0, -2.0, 0.5});
      follow(make_frame({{seen, 1.0F}}), {}, track, {}, interval);
    }
    sum += ((track.motion[track.motion_model()].rate_lrf.cast<double>() - rate) / 2.7).squaredNorm() / 3.0;
  }
  return sum / kTracks;
}

TEST(RateCovariance, CoversTheTrueErrorsOfTracksAfterAnyInterval) {
  for (const double sigma_deg : {0.5, 2.0}) {
    for (const int frames : {3, 6, 15}) {
      for (const double periods : {0.1, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        const double sigma_rad = sigma_deg * kDegree;
        const auto error_urad = static_cast<std::uint32_t>(1e6 * sigma_rad * std::sqrt(8.0 / kPi));
        const double reported =
            1e-8 *
            rate_covariance(error_urad, static_cast<std::uint32_t>(frames),
                            static_cast<std::int64_t>(periods * static_cast<double>(kNominalPeriod_ns)))[0];
        const double ratio = std::sqrt(true_rate_variance(frames, periods, sigma_rad) / reported);
        EXPECT_LT(ratio, 1.2) << sigma_deg << " degrees, " << frames << " frames, " << periods << " periods";
      }
    }
  }
}

TEST(RateCovariance, IsUnknownAfterTheFirstFrameAndNeverLarger) {
  EXPECT_EQ(rate_covariance(10, 1, 2'700'000'000)[0], kUnknownRateVarianceE8);
  EXPECT_EQ(rate_covariance(kPi_urad, 2, 1)[0], kUnknownRateVarianceE8);
}

}  // namespace
}  // namespace tumblesight::gnc
