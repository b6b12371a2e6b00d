#include "gnc/registration/pose_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int32_t kRadius_um = 2'500'000;
constexpr double kDegree = M_PI / 180.0;

// A body without torque in double precision: Runge and Kutta's fourth order, 200 steps per period.
struct ExactMotion {
  Eigen::Matrix3d r_lrf_trf;
  Eigen::Vector3d rate_lrf;              // rad per period
  Eigen::Vector3d origin_m, velocity_m;  // per period
};

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

ExactMotion after_a_period(ExactMotion motion, const Eigen::Matrix3d& inertia_trf) {
  constexpr int kSteps = 200;
  const Eigen::Vector3d momentum =
      motion.r_lrf_trf * inertia_trf * motion.r_lrf_trf.transpose() * motion.rate_lrf;
  const auto rate_at = [&](const Eigen::Matrix3d& r) {
    return Eigen::Vector3d(r * inertia_trf.inverse() * r.transpose() * momentum);
  };
  for (int i = 0; i < kSteps; ++i) {
    const double step = 1.0 / kSteps;
    const Eigen::Matrix3d& r = motion.r_lrf_trf;
    const Eigen::Vector3d a = rate_at(r), b = rate_at(rotation_of(0.5 * step * a) * r);
    const Eigen::Vector3d c = rate_at(rotation_of(0.5 * step * b) * r),
                          d = rate_at(rotation_of(step * c) * r);
    motion.r_lrf_trf = rotation_of(step / 6.0 * (a + 2.0 * b + 2.0 * c + d)) * r;
  }
  motion.rate_lrf = rate_at(motion.r_lrf_trf);
  motion.origin_m += motion.velocity_m;
  return motion;
}

Inertia<Fixed> fixed_inertia(const Eigen::Matrix3d& tensor) {
  const Eigen::Matrix3d scaled = tensor * (3.0 / tensor.trace());
  Matrix3<Fixed> given;
  for (int i = 0; i < 9; ++i) given(i) = Fixed(scaled(i));
  Inertia<Fixed> inertia;
  EXPECT_TRUE(make_inertia<Fixed>(given, inertia));
  return inertia;
}

// Equal information about every unknown, of this standard deviation [rad and radii].
PoseMeasurement measured(const ExactMotion& motion, double sigma) {
  NormalEquations equations;
  for (int i = 0; i < kUnknowns; ++i)
    equations.information[element(i, i)] = std::llround(4096.0 / (sigma * sigma));
  return measured_pose(fixed({motion.r_lrf_trf, motion.origin_m}), equations);
}

PoseMotion fixed_motion(const ExactMotion& motion) {
  PoseMotion result;
  const Pose pose = fixed({motion.r_lrf_trf, motion.origin_m});
  result.turning.r_lrf_trf = pose.r_lrf_trf;
  result.origin_lrf_um = pose.origin_lrf_um;
  for (int i = 0; i < 3; ++i) {
    result.turning.rate_lrf[i] = Fixed(motion.rate_lrf[i]);
    result.velocity_um_period[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(std::lround(1e6 * motion.velocity_m[i]));
  }
  return result;
}

struct Error {
  double turn_deg, rate_deg, move_mm, velocity_mm;
};
Error error_of(const PoseMotion& found, const ExactMotion& truth) {
  const ExactPose pose = exact({found.turning.r_lrf_trf, found.origin_lrf_um});
  Error error{};
  error.turn_deg =
      Eigen::AngleAxisd(Eigen::Quaterniond(pose.r_lrf_trf.transpose() * truth.r_lrf_trf).normalized())
          .angle() /
      kDegree;
  error.move_mm = 1e3 * (pose.origin_m - truth.origin_m).norm();
  Eigen::Vector3d rate, velocity_m;
  for (int i = 0; i < 3; ++i) {
    rate[i] = std::ldexp(found.turning.rate_lrf[i].raw(), -24);
    velocity_m[i] = 1e-6 * found.velocity_um_period[static_cast<std::size_t>(i)];
  }
  error.rate_deg = (rate - truth.rate_lrf).norm() / kDegree;
  error.velocity_mm = 1e3 * (velocity_m - truth.velocity_m).norm();
  return error;
}

class FitMotion : public testing::Test {
 protected:
  // `count` poses of a body that starts at random, each off by a normal error of `sigma` [rad and radii].
  void observe(int count, double sigma, const Eigen::Matrix3d& inertia_trf, double rate_sigma = 0.3) {
    truth_ = {random_.rotation(), random_.vector(rate_sigma), {0.1, 40.0, -0.2}, random_.vector(0.05)};
    if (truth_.rate_lrf.norm() > 0.9) truth_.rate_lrf *= 0.9 / truth_.rate_lrf.norm();
    history_->count = 0;
    for (int i = 0; i < count; ++i) {
      if (i > 0) truth_ = after_a_period(truth_, inertia_trf);
      ExactMotion seen = truth_;
      seen.r_lrf_trf = rotation_of(random_.vector(sigma)) * seen.r_lrf_trf;
      seen.origin_m += random_.vector(sigma * 1e-6 * kRadius_um);
      add(measured(seen, sigma > 0.0 ? sigma : 1e-3), kNominalPeriod_ns);
    }
  }
  // `elapsed_ns` after the pose before.
  void add(const PoseMeasurement& measurement, std::int64_t elapsed_ns) {
    for (PoseMeasurement& earlier : history_->poses) earlier.age_ns += elapsed_ns;
    history_->add(measurement);
  }
  // False: the budget was exhausted.
  bool fit(const ExactMotion& start, const Eigen::Matrix3d& inertia_trf, int iterations = kMostIterations) {
    return fit_motion(*history_, fixed_inertia(inertia_trf), kRadius_um, fixed_motion(start), iterations,
                      budget_, *result_);
  }
  // Started a degree, a degree per period and some centimetres away from the truth.
  Error fitted(const Eigen::Matrix3d& inertia_trf) {
    ExactMotion start = truth_;
    start.r_lrf_trf = rotation_of(random_.vector(0.01)) * start.r_lrf_trf;
    start.rate_lrf += random_.vector(0.01);
    start.origin_m += random_.vector(0.02);
    start.velocity_m += random_.vector(0.02);
    fit(start, inertia_trf);
    return error_of(result_->motion, truth_);
  }

  Random random_{7};
  ExactMotion truth_;
  std::unique_ptr<PoseHistory> history_ = std::make_unique<PoseHistory>();
  WorkBudget budget_;  // without a limit
  std::unique_ptr<PoseFitResult> result_ = std::make_unique<PoseFitResult>();
};

const Eigen::Matrix3d kSphere = Eigen::Matrix3d::Identity();
const Eigen::Matrix3d kTumbler = Eigen::Vector3d(1.2, 0.7, 1.1).asDiagonal();

TEST_F(FitMotion, ExactPosesOfASpinGiveTheMotion) {
  for (int i = 0; i < trials(40); ++i) {
    observe(2 + i % 9, 0.0, kSphere);
    const Error error = fitted(kSphere);
    EXPECT_LT(error.turn_deg, 0.006);
    EXPECT_LT(error.rate_deg, 0.005);
    EXPECT_LT(error.move_mm, 0.2);
    EXPECT_LT(error.velocity_mm, 0.2);
  }
}

TEST_F(FitMotion, ExactPosesOfATumblingBodyGiveTheMotion) {
  for (int i = 0; i < trials(20); ++i) {
    observe(10, 0.0, kTumbler);
    const Error error = fitted(kTumbler);
    EXPECT_LT(error.turn_deg, 0.1);
    EXPECT_LT(error.rate_deg, 0.05);
  }
}

// The end of a straight line through n values with the error s is known to s sqrt((4n - 2) / (n (n + 1))),
// its slope to s sqrt(12 / (n (n^2 - 1))), for each of three axes.
TEST_F(FitMotion, ErrorsAverageAsThoseOfALine) {
  constexpr double kSigma = 0.004;
  constexpr int kPoses = 10;
  double turn_squares = 0.0, rate_squares = 0.0;
  const int count = trials(150);
  for (int i = 0; i < count; ++i) {
    observe(kPoses, kSigma, kSphere, 0.02);
    const Error error = fitted(kSphere);
    turn_squares += error.turn_deg * error.turn_deg;
    rate_squares += error.rate_deg * error.rate_deg;
  }
  const double n = kPoses, sigma_deg = kSigma / kDegree * std::sqrt(3.0);
  const double turn = std::sqrt(turn_squares / count), rate = std::sqrt(rate_squares / count);
  // Robust weights cost some of it.
  EXPECT_NEAR(turn / (sigma_deg * std::sqrt((4 * n - 2) / (n * (n + 1)))), 1.05, count >= 100 ? 0.15 : 0.4);
  EXPECT_NEAR(rate / (sigma_deg * std::sqrt(12 / (n * (n * n - 1)))), 1.05, count >= 100 ? 0.15 : 0.4);
}

TEST_F(FitMotion, OneWrongPoseDoesNotSpoilTheMotion) {
  for (int i = 0; i < trials(20); ++i) {
    observe(10, 0.001, kSphere);
    const auto wrong = static_cast<std::size_t>(i % 9);
    ExactPose other = exact(history_->poses[wrong].pose);
    other.r_lrf_trf = rotation_of(Eigen::Vector3d(0.0, 0.0, 0.5)) * other.r_lrf_trf;
    other.origin_m += Eigen::Vector3d(0.3, 0.5, 0.0);
    history_->poses[wrong].pose = fixed(other);
    const Error error = fitted(kSphere);
    EXPECT_LT(error.turn_deg, 0.2);
    EXPECT_LT(error.move_mm, 10.0);
    EXPECT_GT(result_->disagreement_q8, 10 * 256);
  }
}

TEST_F(FitMotion, PosesThatAgreeSaySo) {
  double sum = 0.0;
  const int count = trials(40);
  for (int i = 0; i < count; ++i) {
    observe(10, 0.01, kSphere);
    fitted(kSphere);
    sum += std::ldexp(static_cast<double>(result_->disagreement_q8), -8);
  }
  // A quarter of the information is used, and 12 of 60 differences are free: 0.25 * 0.8.
  EXPECT_NEAR(sum / count, 0.2, 0.05);
}

TEST_F(FitMotion, OnePoseKeepsTheRateOfTheStart) {
  observe(1, 0.0, kSphere);
  ExactMotion start = truth_;
  start.r_lrf_trf = rotation_of({0.01, 0.0, 0.02}) * start.r_lrf_trf;
  fit(start, kSphere);
  const Error error = error_of(result_->motion, truth_);
  EXPECT_LT(error.turn_deg, 0.003);
  EXPECT_LT(error.rate_deg, 0.003);
}

TEST_F(FitMotion, InformationOfTheRateComesFromTheSpanOfThePoses) {
  observe(2, 0.01, kSphere);
  fitted(kSphere);
  // Two poses with a quarter of (1 / 0.01)^2 each: the rate has that of the first, one period ago, and 1 of
  // the prior and 1 of a pose's own.
  const double rate = static_cast<double>(result_->information[element(3, 3)]) / 16.0;
  EXPECT_NEAR(rate, 2500.0, 1400.0);
  EXPECT_GT(rate, 100.0);
}

// A pose beyond 60 degrees has no derivative to lead back to it. It is no agreement.
TEST_F(FitMotion, PoseOfAnotherAttitudeNeitherAgreesNorTellsTheRate) {
  for (const double degrees : {61.0, 90.0, 180.0}) {
    observe(2, 0.001, kSphere, 0.02);
    ExactPose other = exact(history_->poses[0].pose);
    other.r_lrf_trf = rotation_of(Eigen::Vector3d(0.0, degrees * kDegree, 0.0)) * other.r_lrf_trf;
    history_->poses[0].pose = fixed(other);
    fitted(kSphere);
    EXPECT_GT(result_->disagreement_q8, 10'000 * 256 / 2) << degrees;
    EXPECT_LT(result_->information[element(4, 4)], 100 * 16) << degrees;
  }
}

TEST_F(FitMotion, RateMayBeOffByDegreesAtTheStart) {
  for (int i = 0; i < trials(10); ++i) {
    observe(10, 0.001, kSphere, 0.1);
    ExactMotion start = truth_;
    start.rate_lrf += 2.0 * kDegree * random_.vector(1.0).normalized();
    fit(start, kSphere);
    EXPECT_LT(error_of(result_->motion, truth_).rate_deg, 0.1);
  }
}

TEST_F(FitMotion, VelocityIsRightOverLongGaps) {
  truth_ = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), {0.0, 40.0, 0.0}, {0.003, 0.0, 0.0}};
  constexpr int kGap = 8, kPoses = 3;  // periods; the history reaches back over 16 of them
  for (int i = 0; i < kPoses; ++i) {
    ExactMotion seen = truth_;
    seen.origin_m += i * kGap * truth_.velocity_m;
    add(measured(seen, 0.001), kGap * kNominalPeriod_ns);
    if (i + 1 == kPoses) truth_ = seen;
  }
  ExactMotion start = truth_;
  start.velocity_m.setZero();
  fit(start, kSphere);
  EXPECT_LT(error_of(result_->motion, truth_).velocity_mm, 0.05);
}

TEST_F(FitMotion, EndsWithARotationWhateverThePoses) {
  for (int i = 0; i < trials(20); ++i) {
    history_->count = 0;
    for (int k = 0; k < PoseHistory::kMost; ++k) {
      NormalEquations equations;
      for (std::int64_t& value : equations.information)
        value = static_cast<std::int64_t>(random_.uniform(-1e11, 1e11));
      const Eigen::Matrix3d r = random_.rotation();
      const Eigen::Vector3d origin_m = 500.0 * random_.vector(1.0).normalized();
      add(measured_pose(fixed({r, origin_m}), equations), std::int64_t{1'000'000'000} * (1 + i));
    }
    truth_ = {random_.rotation(), random_.vector(1.0), {0.0, 100.0, 0.0}, random_.vector(1.0)};
    fit(truth_, kTumbler);
    const Eigen::Matrix3d r =
        exact({result_->motion.turning.r_lrf_trf, result_->motion.origin_lrf_um}).r_lrf_trf;
    EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-5);
  }
}

// Verifies TS-TIM-120.
// Whatever the poses, the gaps between them and the rate: what is held back for a fit covers it.
TEST_F(FitMotion, TakesNoMoreThanIsHeldBackForIt) {
  for (int i = 0; i < trials(200); ++i) {
    const double rate = random_.happens(0.5) ? 0.02 : 1.0;
    observe(1 + random_.below(PoseHistory::kMost), 0.01, kTumbler, rate);
    const auto longest_gap_ms = random_.happens(0.5) ? 3'000 : 50'000;
    for (int k = history_->count - 1; k >= 0; --k) {
      const auto at = static_cast<std::size_t>(k);
      const std::int64_t gap_ns = std::int64_t{1'000'000} * random_.below(longest_gap_ms);
      history_->poses[at].age_ns =
          k + 1 == history_->count
              ? gap_ns
              : std::min(history_->poses[at + 1].age_ns + gap_ns, PoseHistory::kOldest_ns);
    }
    const int iterations = 1 + random_.below(kMostIterations);
    const std::int32_t reserve = work_of_fit(*history_, iterations);
    budget_.begin(reserve);
    EXPECT_TRUE(fit(truth_, kTumbler, iterations)) << i;
    // With the pose of this frame, the newest, of now.
    add(measured(truth_, 0.01), 0);
    budget_.begin(reserve);
    EXPECT_TRUE(fit(truth_, kTumbler, iterations)) << i;
  }
}

TEST_F(FitMotion, EndsWithTheBudget) {
  observe(6, 0.01, kTumbler);
  budget_.begin(100'000'000);
  ASSERT_TRUE(fit(truth_, kTumbler));
  const std::int32_t work = 100'000'000 - budget_.left();
  const Error whole = error_of(result_->motion, truth_);
  budget_.begin(work);
  EXPECT_TRUE(fit(truth_, kTumbler));
  EXPECT_EQ(error_of(result_->motion, truth_).turn_deg, whole.turn_deg);
  for (std::int32_t budget = work - 1; budget > 0; budget -= work / 100) {
    budget_.begin(budget);
    EXPECT_FALSE(fit(truth_, kTumbler)) << budget;
    EXPECT_TRUE(budget_.is_exhausted()) << budget;
  }
}

}  // namespace
}  // namespace tumblesight::gnc
