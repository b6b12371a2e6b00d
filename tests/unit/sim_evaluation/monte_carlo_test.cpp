#include "sim/evaluation/monte_carlo.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/target/targets.hpp"
#include "tests/unit/sim_evaluation/arbitrary_model.hpp"

namespace tumblesight::sim {
namespace {

class MonteCarlo : public ::testing::Test {
 protected:
  std::vector<FrameResult> run(int threads, std::uint64_t seed = 5) {
    MonteCarloSettings settings;
    settings.condition = Condition::kDegraded;
    settings.seed = seed;
    settings.sequences = 4;
    settings.frames = 3;
    settings.threads = threads;
    last_progress_ = 0;
    return run_monte_carlo(lidar_, swath_m(mesh_), model_, settings,
                           [&](std::uint32_t done) { last_progress_ = done; });
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
         a.cnn_predicted_rad == b.cnn_predicted_rad;
}

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

TEST_F(MonteCarlo, StartsEverySequenceAnew) {
  const std::vector<FrameResult> results = run(1);
  MonteCarloSettings settings;
  settings.condition = Condition::kDegraded;
  settings.seed = 5;
  settings.sequences = 1;
  settings.frames = 3;
  const auto first = run_monte_carlo(lidar_, swath_m(mesh_), model_, settings, [](std::uint32_t) {});
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(equal(first[i], results[i]));
}

TEST_F(MonteCarlo, RefusesADamagedModel) {
  model_.back() ^= 1U;
  EXPECT_THROW(run(2), std::invalid_argument);
}

}  // namespace
}  // namespace tumblesight::sim
