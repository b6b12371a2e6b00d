// Requirement: sequences follow the paper's sampling, and a seed names the same ones everywhere.
#include "sim/scenario/sequence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sim/dynamics/spin.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kMany = 4000;
constexpr double kDegree = 0.017453292519943295;

TEST(Sequence, AttitudesAreUniformOnSo3) {
  // For a uniform rotation the angle has density (1 - cos a) / pi: its mean is pi/2 + 2/pi, and the image of
  // any axis is uniform on the sphere: mean 0, second moment 1/3.
  double angle = 0.0;
  Eigen::Vector3d axis_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_squared = Eigen::Vector3d::Zero();
  for (int i = 0; i < kMany; ++i) {
    const Eigen::Quaterniond q = make_sequence(Condition::kNominal, 7, i, 1).frames[0].q_lrf_trf;
    ASSERT_NEAR(q.norm(), 1.0, 1e-12);
    angle += 2.0 * std::acos(std::min(1.0, std::abs(q.w())));
    const Eigen::Vector3d z = q * Eigen::Vector3d::UnitZ();
    axis_sum += z;
    axis_squared += z.cwiseAbs2();
  }
  EXPECT_NEAR(angle / kMany, M_PI / 2 + 2 / M_PI, 0.04);
  EXPECT_LT((axis_sum / kMany).norm(), 0.05);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(axis_squared[i] / kMany, 1.0 / 3.0, 0.02);
}

TEST(Sequence, RangesAndRatesStayWithinThePapersLimitsAndFillThem) {
  double least_m = 1e9, most_m = 0.0, fastest = 0.0;
  for (int i = 0; i < kMany; ++i) {
    const FrameTruth truth = make_sequence(Condition::kNominal, 8, i, 1).frames[0];
    least_m = std::min(least_m, truth.range_m);
    most_m = std::max(most_m, truth.range_m);
    fastest = std::max(fastest, truth.rate_lrf_rad_s.norm() / kDegree);
  }
  EXPECT_GE(least_m, 20.0);
  EXPECT_LT(least_m, 20.2);
  EXPECT_LE(most_m, 100.0);
  EXPECT_GT(most_m, 99.8);
  EXPECT_LE(fastest, 20.0);
  EXPECT_GT(fastest, 19.8);
}

TEST(Sequence, TurnsAtAConstantRateInTheLidarFrame) {
  const Sequence sequence = make_sequence(Condition::kNominal, 9, 3);
  ASSERT_EQ(sequence.frames.size(), 10U);
  const double rate = sequence.frames[0].rate_lrf_rad_s.norm();
  const Eigen::Vector3d axis = sequence.frames[0].rate_lrf_rad_s / rate;
  for (std::size_t k = 1; k < sequence.frames.size(); ++k) {
    EXPECT_EQ(sequence.frames[k].range_m, sequence.frames[0].range_m);
    const Eigen::Quaterniond step =
        sequence.frames[k].q_lrf_trf * sequence.frames[k - 1].q_lrf_trf.conjugate();
    EXPECT_LT(step.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(rate * 2.7, axis))), 1e-9);
  }
}

TEST(Spin, NinetyDegreesAboutZTakesXToY) {
  const Eigen::Quaterniond q =
      spin(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 30.0 * kDegree), 3.0);
  EXPECT_LT((q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(spin(q, Eigen::Vector3d::Zero(), 100.0).coeffs(), q.coeffs());
}

TEST(Sequence, SameSeedSameSequenceAndAnotherSeedAnother) {
  const Sequence a = make_sequence(Condition::kDegraded, 1, 2);
  const Sequence b = make_sequence(Condition::kDegraded, 1, 2);
  EXPECT_EQ(a.noise_seed, b.noise_seed);
  EXPECT_EQ(a.frames[9].q_lrf_trf.coeffs(), b.frames[9].q_lrf_trf.coeffs());
  EXPECT_NE(a.noise_seed, make_sequence(Condition::kDegraded, 2, 2).noise_seed);
  EXPECT_NE(a.noise_seed, make_sequence(Condition::kDegraded, 1, 3).noise_seed);
}

TEST(Sequence, IsTheSameWithEveryCompiler) {
  // Golden values: of the first build of this code with GCC 12. The order of the draws is part of the
  // interface, since seeds name sequences in every report.
  const FrameTruth truth = make_sequence(Condition::kNominal, 1, 0, 1).frames[0];
  const Eigen::Quaterniond q(-0.742786412024, -0.293947363779, 0.077305679075, -0.596562758997);
  EXPECT_LT((truth.q_lrf_trf.coeffs() - q.coeffs()).norm(), 1e-9);
  EXPECT_LT(
      (truth.rate_lrf_rad_s - Eigen::Vector3d(-0.140603296598, -0.218248134189, -0.201950533381)).norm(),
      1e-9);
  EXPECT_NEAR(truth.range_m, 59.252414092324, 1e-9);
}

TEST(Condition, NamesRoundTripAndUnknownOnesListTheKnown) {
  for (const Condition condition : {Condition::kNominal, Condition::kDegraded}) {
    EXPECT_EQ(condition_from(to_string(condition)), condition);
  }
  try {
    condition_from("foggy");
    FAIL() << "accepted an unknown condition";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("nominal, degraded"), std::string::npos);
  }
}

}  // namespace
}  // namespace tumblesight::sim
