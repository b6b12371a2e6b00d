#include "sim/experiment/monte_carlo.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/world/math/angles.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/sim_models.hpp"

namespace tumblesight::sim {
namespace {

class MonteCarlo : public ::testing::Test {
 protected:
  static MonteCarloSettings settings(int threads, std::uint64_t seed) {
    MonteCarloSettings made;
    made.scenario.condition = Condition::kDegraded;
    made.scenario.frames = 3;
    made.seed = seed;
    made.sequences = 4;
    made.threads = threads;
    return made;
  }
  MonteCarloResult run(const MonteCarloSettings& settings, const TemplateMatcher* matcher = nullptr) {
    return run_monte_carlo(FrameRenderer(lidar_, swath_m(mesh_)), model_, matcher, settings,
                           [&](std::uint32_t done) { last_progress_ = done; });
  }
  std::vector<FrameResult> run(int threads, std::uint64_t seed = 5) {
    return run(settings(threads, seed)).frames;
  }

  TriangleMesh mesh_ = target_by_name("near_shoemaker");
  FlashLidar lidar_{mesh_};
  std::vector<std::uint8_t> model_ = arbitrary_model("near_shoemaker");
  std::uint32_t last_progress_ = 0;
};

bool equal(const FrameResult& a, const FrameResult& b) {
  return a.sequence == b.sequence && a.frame == b.frame && a.valid == b.valid &&
         a.truth.coeffs() == b.truth.coeffs() && a.rcnn.coeffs() == b.rcnn.coeffs() &&
         a.cnn.coeffs() == b.cnn.coeffs() && a.rcnn_predicted_rad == b.rcnn_predicted_rad &&
         a.cnn_predicted_rad == b.cnn_predicted_rad && a.has_baseline == b.has_baseline &&
         a.baseline.coeffs() == b.baseline.coeffs();
}

// Verifies TS-SIL-060.
TEST_F(MonteCarlo, GivesTheSameBitsWithAnyNumberOfThreads) {
  const std::vector<FrameResult> one = run(1);
  const std::vector<FrameResult> two = run(2);
  ASSERT_EQ(one.size(), 12U);
  ASSERT_EQ(two.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_TRUE(equal(one[i], two[i])) << "result " << i;
}

TEST_F(MonteCarlo, OrdersResultsBySequenceAndFrameAndReportsProgress) {
  const std::vector<FrameResult> results = run(2);
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].sequence, i / 3);
    EXPECT_EQ(results[i].frame, i % 3);
    EXPECT_TRUE(results[i].valid);
  }
  EXPECT_EQ(last_progress_, 4U);
}

TEST_F(MonteCarlo, DependsOnTheSeed) {
  const std::vector<FrameResult> a = run(1, 5);
  const std::vector<FrameResult> b = run(1, 6);
  EXPECT_FALSE(equal(a.front(), b.front()));
}

TEST_F(MonteCarlo, ResetsTheEstimatorBeforeEverySequence) {
  const std::vector<FrameResult> results = run(1);
  MonteCarloSettings one_sequence = settings(1, 5);
  one_sequence.sequences = 1;
  const std::vector<FrameResult> first = run(one_sequence).frames;
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(equal(first[i], results[i]));
}

// Training draws its sequences from the seeds mix(seed, attempt).
// Verifies TS-TRN-050.
TEST_F(MonteCarlo, DrawsSequencesThatSimulationDrawsButTrainingDoesNot) {
  const std::vector<FrameResult> results = run(1, 5);
  const ScenarioSettings scenario = settings(1, 5).scenario;
  for (std::uint64_t index = 0; index < 4; ++index) {
    const auto first_attitude = [&](std::uint64_t seed) {
      return make_sequence(scenario, seed, index).frames.front().q_lrf_trf.coeffs();
    };
    EXPECT_EQ(results[3 * index].truth.coeffs(), first_attitude(5));
    for (std::uint64_t attempt = 0; attempt < 3; ++attempt) {
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        EXPECT_NE(results[3 * index].truth.coeffs(), first_attitude(mix(seed, attempt)));
      }
    }
  }
}

TEST_F(MonteCarlo, KeepsRangeAndRateOfTheTruth) {
  MonteCarloSettings fixed = settings(1, 5);
  fixed.scenario.range_m = 42.0;
  fixed.scenario.rate_rad_s = 0.125;
  for (const FrameResult& result : run(fixed).frames) {
    EXPECT_DOUBLE_EQ(result.range_m, 42.0);
    EXPECT_NEAR(result.rate_rad_s, 0.125, 1e-12);
  }
}

TEST_F(MonteCarlo, GivesTheBaselineTheLastFramesOfTheFirstSequences) {
  TemplateMatcherSettings coarse;
  coarse.directions = 20;
  coarse.rolls = 4;
  coarse.candidates = 1;
  coarse.icp_iterations = 1;
  const TemplateMatcher matcher(mesh_, swath_m(mesh_), coarse);
  MonteCarloSettings with_baseline = settings(2, 5);
  with_baseline.baseline_sequences = 2;
  const MonteCarloResult result = run(with_baseline, &matcher);
  for (const FrameResult& frame : result.frames) {
    EXPECT_EQ(frame.has_baseline, frame.frame == 2 && frame.sequence < 2)
        << frame.sequence << " " << frame.frame;
    EXPECT_EQ(frame.baseline_valid, frame.has_baseline);
  }
  EXPECT_GT(result.baseline_ms, 0.0);
  EXPECT_GT(result.step_ms, 0.0);
  with_baseline.threads = 1;
  const std::vector<FrameResult> again = run(with_baseline, &matcher).frames;
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_TRUE(equal(result.frames[i], again[i])) << i;
}

// Verifies TS-SIL-310.
TEST_F(MonteCarlo, WithAnEffectSeesTheSameMotionInOtherFrames) {
  MonteCarloSettings with_effect = settings(2, 5);
  const std::vector<FrameResult> plain = run(with_effect).frames;
  with_effect.scenario.effects = effects_from({"dead_pixels=0.5"});
  const std::vector<FrameResult> results = run(with_effect).frames;
  ASSERT_EQ(results.size(), plain.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].truth.coeffs(), plain[i].truth.coeffs());
    EXPECT_FALSE(equal(results[i], plain[i])) << i;
  }
}

// Verifies TS-SIL-200.
TEST_F(MonteCarlo, HasNoResultForALostFrameAndNoAttitudeForARepeatedOne) {
  MonteCarloSettings disturbed = settings(2, 5);
  disturbed.scenario.frames = 5;
  const std::vector<FrameResult> plain = run(disturbed).frames;
  disturbed.scenario.disturbances.lost_frames = 1;
  disturbed.scenario.disturbances.frozen = 2;
  const std::vector<FrameResult> results = run(disturbed).frames;
  ASSERT_EQ(results.size(), 16U);
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].frame, i % 4 + (i % 4 == 3 ? 1 : 0));
    EXPECT_EQ(results[i].valid, i % 4 != 2) << "the third frame repeats the second";
    const FrameResult& same = plain[5 * (i / 4) + results[i].frame];
    EXPECT_EQ(results[i].truth.coeffs(), same.truth.coeffs());
    if (results[i].frame < 2) {
      EXPECT_TRUE(equal(results[i], same)) << i;
    }
  }
}

// Verifies TS-SIL-200.
TEST_F(MonteCarlo, TellsTheEstimatorTheTurnOfTheChaserUnlessAskedNotTo) {
  MonteCarloSettings turning = settings(1, 5);
  turning.sequences = 20;
  turning.scenario.frames = 6;
  turning.scenario.disturbances.chaser_rate_deg_s = 20.0;
  const std::vector<FrameResult> told = run(turning).frames;
  turning.scenario.disturbances.no_ego_motion = true;
  const std::vector<FrameResult> untold = run(turning).frames;
  ASSERT_EQ(told.size(), untold.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].truth.coeffs(), untold[i].truth.coeffs());
    EXPECT_EQ(told[i].cnn.coeffs(), untold[i].cnn.coeffs());
    if (!equal(told[i], untold[i]) || told[i].trusted != untold[i].trusted) ++different;
  }
  EXPECT_GT(different, 0U);
}

// Verifies TS-SIL-390.
TEST_F(MonteCarlo, TakesEveryEstimateToTheNearestAttitudeThatLooksTheSame) {
  TemplateMatcherSettings coarse;
  coarse.directions = 20;
  coarse.rolls = 4;
  coarse.candidates = 1;
  coarse.icp_iterations = 1;
  const TemplateMatcher matcher(mesh_, swath_m(mesh_), coarse);
  MonteCarloSettings symmetric = settings(2, 5);
  symmetric.baseline_sequences = 3;
  const MonteCarloResult plain = run(symmetric, &matcher);
  symmetric.symmetry = target_symmetry_from({"z:4", "x:2"});
  const MonteCarloResult nearest = run(symmetric, &matcher);
  ASSERT_EQ(nearest.frames.size(), plain.frames.size());
  std::size_t nearer = 0;
  for (std::size_t i = 0; i < nearest.frames.size(); ++i) {
    for (const Estimator estimator : {Estimator::kRcnn, Estimator::kCnn, Estimator::kBaseline}) {
      const Eigen::Quaterniond expected =
          nearest_equivalent(estimate(plain.frames[i], estimator), plain.frames[i].truth, symmetric.symmetry);
      EXPECT_EQ(estimate(nearest.frames[i], estimator).coeffs(), expected.coeffs());
      if (has_estimate(nearest.frames[i], estimator)) {
        EXPECT_LE(error_deg(nearest.frames[i], estimator), 98.43) << "the farthest from a square prism's";
      }
      if (error_deg(nearest.frames[i], estimator) < error_deg(plain.frames[i], estimator) - 1.0) ++nearer;
    }
  }
  EXPECT_GT(nearer, 10U);
}

TEST_F(MonteCarlo, RefusesADamagedModel) {
  model_.back() ^= 1U;
  EXPECT_THROW(run(2), std::invalid_argument);
}

}  // namespace
}  // namespace tumblesight::sim
