// Verifies TS-EST-150. The gains are constant from the tenth frame on.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <string>
#include <vector>

#include "tests/unit/gnc/rcnn/reference_track.hpp"
#include "tests/unit/gnc/rcnn/track_frames.hpp"

namespace tumblesight::gnc {
namespace {

constexpr HeadOutput<float> kNoCorrection{};

const Eigen::Vector3d kAxis = Eigen::Vector3d(0.4, -0.3, 0.8).normalized();
const Eigen::Matrix3d kStart = turn(2.2, {1.0, -2.0, 0.5});

// The second column of a rotation about x determines its angle, and the mean of two such columns has an exact
// formula.
TEST(AttitudeFilter, HasTheGainsOfTheLeastSquaresLine) {
  constexpr double kAngle = 15.0 * kDegree;
  const Hypotheses<float> frame = make_frame({{turn(kAngle, Eigen::Vector3d::UnitX()), 1.0F}});
  const Prediction<float> at_rest;
  for (int before = 0; before < 14; ++before) {
    SCOPED_TRACE(before);
    AttitudeTrack<float> track;
    track.frames = static_cast<std::uint32_t>(before);
    const Eigen::Matrix3f now = advance<float>(frame, at_rest, kNoCorrection, track).r_lrf_trf;
    const double angle = std::atan2(now(2, 1), now(1, 1));
    const double predicted_weight = std::sin(kAngle) / std::tan(angle) - std::cos(kAngle);
    EXPECT_NEAR(predicted_weight, predicted_weight_after(before), 3e-6);
    EXPECT_EQ(track.frames, static_cast<std::uint32_t>(before + 1));
    const double rate_gain = before == 0 ? 0.0 : rate_gain_after(before);
    for (const Motion<float>& motion : track.motion) {
      EXPECT_EQ(motion.r_lrf_trf, now);
      EXPECT_NEAR(motion.rate_lrf.x() / angle, rate_gain, 1e-5);
      EXPECT_NEAR(motion.rate_lrf.tail<2>().norm(), 0.0, 1e-6);
    }
  }
}

// Below and above the angle within which the prediction of the second frame (at rest) has an influence.
TEST(AttitudeFilter, FollowsAConstantRateAndLearnsIt) {
  for (const double step_deg : {0.0, 2.0, 12.0, 25.0, 54.0}) {
    SCOPED_TRACE(step_deg);
    const Eigen::Vector3d rate = step_deg * kDegree * kAxis;
    AttitudeTrack<float> track;
    Eigen::Matrix3d truth = kStart;
    for (int k = 0; k < 25; ++k, truth = turn(rate) * truth) {
      const TrackedAttitude<float> tracked = follow(make_frame({{truth, 1.0F}}), kNoCorrection, track);
      EXPECT_LT(angle_between(tracked.r_lrf_trf, truth), k == 0 ? 1e-6 : 0.02 * kDegree) << k;
      if (k == 0) continue;
      const Motion<float>& motion = track.motion[static_cast<int>(track.motion_model())];
      EXPECT_EQ(tracked.r_lrf_trf, motion.r_lrf_trf);
      const double rate_error = (motion.rate_lrf.cast<double>() - rate).norm();
      EXPECT_LT(rate_error, 0.1 * kDegree) << k;
      if (k < 24) continue;
      EXPECT_LT(angle_between(tracked.r_lrf_trf, truth), 2e-6);
      EXPECT_LT(rate_error, 2e-6);
    }
  }
}

// Error of the attitude at the last frame of the least-squares line through the measured errors, in the LRF.
// The unknowns are the errors of the first attitude and of the rate; both rotate with the target from frame
// to frame.
Eigen::Vector3d line_fit_error(const std::vector<Eigen::Vector3d>& errors, const Eigen::Matrix3d& step) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Rows = Eigen::Matrix<double, 3, 6>;
  Matrix6 normal = Matrix6::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  Rows rows = Rows::Zero();  // the error at this frame as a function of the unknowns
  rows.leftCols<3>().setIdentity();
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (k > 0) {
      rows = step * rows;
      rows.rightCols<3>() += Eigen::Matrix3d::Identity();
    }
    normal += rows.transpose() * rows;
    right += rows.transpose() * errors[k];
  }
  return rows * normal.ldlt().solve(right);
}

// Innovations rotate with the attitude, while the error of the rate stays constant in the LRF. The filter and
// the fit therefore diverge slowly, the more the target rotates.
TEST(AttitudeFilter, IsAsGoodAsTheLeastSquaresLineOfTheFirstTenFrames) {
  struct Case {
    double step_deg;
    double error_ratio;  // of the filter to the fit
    double difference;   // between filter and fit, relative to the error of the fit; 1: not checked
  };
  for (const Case& limits : {Case{1.0, 1.002, 0.03}, Case{5.0, 1.01, 0.13}, Case{12.0, 1.05, 1.0}}) {
    const Eigen::Matrix3d step = turn(limits.step_deg * kDegree, kAxis);
    std::mt19937 engine(3);
    std::normal_distribution<double> normal(0.0, 0.5 * kDegree);
    for (const int frames : {3, 5, 10}) {
      SCOPED_TRACE(std::to_string(limits.step_deg) + " degrees, frames " + std::to_string(frames));
      double filter_square = 0.0, fit_square = 0.0, difference_square = 0.0, single_square = 0.0;
      for (int trial = 0; trial < 300; ++trial) {
        AttitudeTrack<float> track;
        Eigen::Matrix3d truth = kStart, answer = kStart;
        std::vector<Eigen::Vector3d> errors;
        for (int k = 0; k < frames; ++k) {
          if (k > 0) truth = step * truth;
          errors.emplace_back(normal(engine), normal(engine), normal(engine));
          const Hypotheses<float> frame = make_frame({{turn(errors.back()) * truth, 1.0F}});
          answer = follow(frame, kNoCorrection, track).r_lrf_trf.cast<double>();
        }
        const Eigen::AngleAxisd error(Eigen::Matrix3d(answer * truth.transpose()));
        const Eigen::Vector3d filter = error.angle() * error.axis();
        const Eigen::Vector3d fit = line_fit_error(errors, step);
        filter_square += filter.squaredNorm();
        fit_square += fit.squaredNorm();
        difference_square += (filter - fit).squaredNorm();
        single_square += errors.back().squaredNorm();
      }
      EXPECT_LT(std::sqrt(filter_square / fit_square), limits.error_ratio);
      EXPECT_LT(std::sqrt(difference_square / fit_square), limits.difference);
      EXPECT_LT(filter_square, (frames == 10 ? 0.4 : 0.95) * single_square);
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
