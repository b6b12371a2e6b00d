// Verifies TS-SIL-080. A seed names the same sequences everywhere.
#include "sim/world/scenario/sequence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "sim/world/math/angles.hpp"
#include "tests/unit/sim/world/scenario/uniformity.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kSequences = 4000;

TEST(Sequence, AttitudesAreUniformOnSo3) {
  // For a uniform rotation the angle has density (1 - cos a) / pi: its mean is pi/2 + 2/pi, and the image of
  // any axis is uniform on the sphere: mean 0, second moment 1/3.
  double angle = 0.0;
  Eigen::Vector3d axis_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_squared = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSequences; ++i) {
    const Eigen::Quaterniond q = make_sequence({Condition::kNominal, 1}, 7, i).frames[0].q_lrf_trf;
    ASSERT_NEAR(q.norm(), 1.0, 1e-12);
    angle += 2.0 * std::acos(std::min(1.0, std::abs(q.w())));
    const Eigen::Vector3d z = q * Eigen::Vector3d::UnitZ();
    axis_sum += z;
    axis_squared += z.cwiseAbs2();
  }
  EXPECT_NEAR(angle / kSequences, M_PI / 2 + 2 / M_PI, 0.04);
  EXPECT_LT((axis_sum / kSequences).norm(), 0.05);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(axis_squared[i] / kSequences, 1.0 / 3.0, 0.02);
}

TEST(Sequence, RangesAndRatesStayWithinThePapersLimitsAndFillThem) {
  double least_m = 1e9, most_m = 0.0, fastest = 0.0;
  for (int i = 0; i < kSequences; ++i) {
    const FrameTruth truth = make_sequence({Condition::kNominal, 1}, 8, i).frames[0];
    least_m = std::min(least_m, truth.range_m);
    most_m = std::max(most_m, truth.range_m);
    fastest = std::max(fastest, truth.rate_lrf_rad_s.norm() / kRadPerDeg);
  }
  EXPECT_GE(least_m, 20.0);
  EXPECT_LT(least_m, 20.2);
  EXPECT_LE(most_m, 100.0);
  EXPECT_GT(most_m, 99.8);
  EXPECT_LE(fastest, 20.0);
  EXPECT_GT(fastest, 19.8);
}

TEST(Sequence, TurnsAtAConstantRateInTheLidarFrame) {
  const Sequence sequence = make_sequence({Condition::kNominal}, 9, 3);
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

TEST(Sequence, SameSeedSameSequenceAndAnotherSeedAnother) {
  const Sequence a = make_sequence({Condition::kDegraded}, 1, 2);
  const Sequence b = make_sequence({Condition::kDegraded}, 1, 2);
  EXPECT_EQ(a.noise_seed, b.noise_seed);
  EXPECT_EQ(a.frames[9].q_lrf_trf.coeffs(), b.frames[9].q_lrf_trf.coeffs());
  EXPECT_NE(a.noise_seed, make_sequence({Condition::kDegraded}, 2, 2).noise_seed);
  EXPECT_NE(a.noise_seed, make_sequence({Condition::kDegraded}, 1, 3).noise_seed);
}

TEST(Sequence, IsTheSameWithEveryCompiler) {
  // Golden values from the first build with GCC 12. The order of the draws is part of the interface, because
  // seeds name sequences in every report.
  const FrameTruth truth = make_sequence({Condition::kNominal, 1}, 1, 0).frames[0];
  const Eigen::Quaterniond q(-0.742786412024, -0.293947363779, 0.077305679075, -0.596562758997);
  EXPECT_LT((truth.q_lrf_trf.coeffs() - q.coeffs()).norm(), 1e-9);
  EXPECT_LT(
      (truth.rate_lrf_rad_s - Eigen::Vector3d(-0.140603296598, -0.218248134189, -0.201950533381)).norm(),
      1e-9);
  EXPECT_NEAR(truth.range_m, 59.252414092324, 1e-9);
}

// Norms relative to the largest possible one.
std::vector<double> relative_norms(RateDistribution distribution) {
  std::vector<double> norms;
  for (int i = 0; i < kSequences; ++i) {
    ScenarioSettings settings;
    settings.frames = 1;
    settings.rate_distribution = distribution;
    norms.push_back(make_sequence(settings, 10, i).frames[0].rate_lrf_rad_s.norm() / (20.0 * kRadPerDeg));
  }
  return norms;
}

TEST(RateDistribution, NormIsUniformUpTo20DegreesPerSecond) {
  EXPECT_LT(unlikeliness(relative_norms(RateDistribution::kNorm)), kUnlikely);
}

TEST(RateDistribution, ComponentsFillTheBallOf20DegreesPerSecondEvenly) {
  std::vector<double> volumes = relative_norms(RateDistribution::kComponents);
  for (double& v : volumes) v = v * v * v;
  EXPECT_LT(unlikeliness(volumes), kUnlikely);
}

// A mission may bound the rate; both distributions keep the bound and draw the same directions.
TEST(RateDistribution, BothKeepALimitBelow20DegreesPerSecond) {
  for (const RateDistribution distribution : {RateDistribution::kComponents, RateDistribution::kNorm}) {
    ScenarioSettings usual, slow;
    usual.rate_distribution = slow.rate_distribution = distribution;
    slow.ranges.largest_rate_deg_s = 5.0;
    EXPECT_FALSE(slow.ranges.are_the_papers());
    for (std::uint64_t i = 0; i < 300; ++i) {
      const Eigen::Vector3d fast_rad_s = make_sequence(usual, 3, i).frames.front().rate_lrf_rad_s;
      const Eigen::Vector3d slow_rad_s = make_sequence(slow, 3, i).frames.front().rate_lrf_rad_s;
      EXPECT_LE(slow_rad_s.norm(), 5.0 * kRadPerDeg * (1.0 + 1e-12)) << i;
      EXPECT_LT((slow_rad_s - 0.25 * fast_rad_s).norm(), 1e-12) << i;
    }
  }
}

TEST(RateDistribution, ChangesTheNormOnly) {
  ScenarioSettings settings;
  const Sequence components = make_sequence(settings, 11, 5);
  settings.rate_distribution = RateDistribution::kNorm;
  const Sequence norm = make_sequence(settings, 11, 5);
  EXPECT_EQ(norm.frames[0].q_lrf_trf.coeffs(), components.frames[0].q_lrf_trf.coeffs());
  EXPECT_EQ(norm.frames[0].range_m, components.frames[0].range_m);
  EXPECT_EQ(norm.noise_seed, components.noise_seed);
  EXPECT_LT(
      (norm.frames[0].rate_lrf_rad_s.normalized() - components.frames[0].rate_lrf_rad_s.normalized()).norm(),
      1e-12);
  EXPECT_GT((norm.frames[0].rate_lrf_rad_s - components.frames[0].rate_lrf_rad_s).norm(), 1e-3);
}

TEST(Sequence, FixedValuesReplaceTheDrawnOnesAndChangeNoOtherDraw) {
  ScenarioSettings settings;
  settings.condition = Condition::kOccluded;
  for (const RateDistribution distribution : {RateDistribution::kComponents, RateDistribution::kNorm}) {
    settings.rate_distribution = distribution;
    const Sequence drawn = make_sequence(settings, 12, 1);
    ScenarioSettings fixed_settings = settings;
    fixed_settings.range_m = 35.0;
    fixed_settings.rate_rad_s = 12.5 * kRadPerDeg;
    fixed_settings.hidden_share = 0.4;
    const Sequence fixed = make_sequence(fixed_settings, 12, 1);
    EXPECT_EQ(fixed.noise_seed, drawn.noise_seed);
    EXPECT_EQ(fixed.frames[0].q_lrf_trf.coeffs(), drawn.frames[0].q_lrf_trf.coeffs());
    for (std::size_t k = 0; k < fixed.frames.size(); ++k) {
      const FrameTruth &a = fixed.frames[k], &b = drawn.frames[k];
      EXPECT_EQ(a.range_m, 35.0);
      EXPECT_NEAR(a.rate_lrf_rad_s.norm(), 12.5 * kRadPerDeg, 1e-12);
      EXPECT_LT((a.rate_lrf_rad_s.normalized() - b.rate_lrf_rad_s.normalized()).norm(), 1e-12);
      EXPECT_EQ(a.occluder.hidden_share, 0.4);
      EXPECT_EQ(a.occluder.shape, b.occluder.shape);
      EXPECT_EQ(a.occluder.side_rad, b.occluder.side_rad);
      EXPECT_EQ(a.occluder.across, b.occluder.across);
      EXPECT_EQ(a.occluder.distance_m, b.occluder.distance_m);
    }
  }
}

// Verifies TS-SIL-340.
TEST(Sequence, DrawsStrengthsWithinTheirRangesAndChangesNoOtherDraw) {
  ScenarioSettings settings;
  const Sequence plain = make_sequence(settings, 12, 1);
  settings.effects = effect_ranges_from({"noise=1:5", "dropout=0.3"});
  std::set<double> noises;
  for (std::uint64_t index = 0; index < 100; ++index) {
    const Effects effects = make_sequence(settings, 12, index).effects;
    EXPECT_GT(effects.noise, 1.0);
    EXPECT_LT(effects.noise, 5.0);
    EXPECT_EQ(effects.dropout, 0.3);
    noises.insert(effects.noise);
  }
  EXPECT_EQ(noises.size(), 100U);
  const Sequence with_range = make_sequence(settings, 12, 1);
  EXPECT_EQ(with_range.effects.noise, make_sequence(settings, 12, 1).effects.noise);
  EXPECT_EQ(with_range.noise_seed, plain.noise_seed);
  for (std::size_t k = 0; k < plain.frames.size(); ++k) {
    EXPECT_EQ(with_range.frames[k].q_lrf_trf.coeffs(), plain.frames[k].q_lrf_trf.coeffs());
    EXPECT_EQ(with_range.frames[k].range_m, plain.frames[k].range_m);
    EXPECT_EQ(with_range.frames[k].scene_seed, plain.frames[k].scene_seed);
  }
}

TEST(Sequence, AtRateZeroTheTargetStandsStillUnderEveryLawAndCondition) {
  for (const std::string& name : condition_names()) {
    for (const RateDistribution distribution : {RateDistribution::kComponents, RateDistribution::kNorm}) {
      ScenarioSettings settings;
      settings.condition = condition_from(name);
      settings.rate_distribution = distribution;
      settings.rate_rad_s = 0.0;
      const Sequence sequence = make_sequence(settings, 13, 2);
      for (const FrameTruth& frame : sequence.frames) {
        EXPECT_EQ(frame.rate_lrf_rad_s.norm(), 0.0) << name;
        const FrameTruth& first = sequence.frames[0];
        const Eigen::Quaterniond q_inertial_trf = frame.q_inertial_lrf * frame.q_lrf_trf;
        EXPECT_LT((q_inertial_trf.coeffs() - (first.q_inertial_lrf * first.q_lrf_trf).coeffs()).norm(), 1e-12)
            << name;
      }
    }
  }
}

}  // namespace
}  // namespace tumblesight::sim
