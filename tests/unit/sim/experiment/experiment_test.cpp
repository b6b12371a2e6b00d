#include "sim/experiment/experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/report/results_json.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/sim_models.hpp"

namespace tumblesight::sim {
namespace {

class Experiment : public ::testing::Test {
 protected:
  Experiment() {
    subject_.target = "near_shoemaker";
    subject_.mesh_name = kParametricMesh;
    subject_.mesh = target_by_name("near_shoemaker");
    subject_.swath_m = swath_m(subject_.mesh);
    subject_.model_name = "arbitrary";
    subject_.model = arbitrary_model("near_shoemaker");
    subject_.inertia_kg_m2 = Eigen::Vector3d(372.0, 370.0, 316.0).asDiagonal();
    settings_.sequences = 3;
    settings_.tumbling_sequences = 4;
    settings_.frames = 2;
    settings_.baseline_sequences = 0;
  }

  Subject subject_;
  ExperimentSettings settings_;
};

// Verifies TS-SIL-060.
TEST_F(Experiment, GivesTheSameFiguresWithAnyNumberOfThreads) {
  settings_.conditions = {Condition::kOccluded, Condition::kTumbling};
  const auto figures = [&](int threads) {
    settings_.threads = threads;
    Results results;
    results.subjects.push_back(run_experiment(subject_, settings_, [](std::uint64_t) {}));
    return results_json(results).dump();
  };
  EXPECT_EQ(figures(1), figures(3));
}

TEST_F(Experiment, RunsACellForEachConditionAndTumblingWithItsOwnCount) {
  settings_.conditions = {Condition::kNominal, Condition::kTumbling};
  const SubjectResult result = run_experiment(subject_, settings_, [](std::uint64_t) {});
  ASSERT_EQ(result.cells.size(), 2U);
  EXPECT_EQ(result.cells[0].rcnn.count, 3U);
  EXPECT_EQ(result.cells[1].rcnn.count, 4U);
  EXPECT_EQ(result.cells[1].condition, Condition::kTumbling);
  EXPECT_FALSE(result.cells[0].baseline.has_value());
  EXPECT_FALSE(result.sweeps.has_value());
}

TEST_F(Experiment, SweepsRateHiddenShareAndALongRunAndCountsEveryStep) {
  settings_.curves = true;
  settings_.frames = 1;
  std::uint64_t last = 0;
  const SubjectResult result = run_experiment(subject_, settings_, [&](std::uint64_t done) {
    EXPECT_GE(done, last);
    last = done;
  });
  EXPECT_EQ(last, steps_of(settings_));
  ASSERT_TRUE(result.sweeps.has_value());
  ASSERT_EQ(result.sweeps->by_hidden_share.size(), 10U);
  EXPECT_NEAR(result.sweeps->by_hidden_share.front().at, 0.05, 1e-12);
  EXPECT_NEAR(result.sweeps->by_hidden_share.back().at, 0.5, 1e-12);
  EXPECT_EQ(result.sweeps->long_run.size(), 200U);
  std::size_t counted = 0;
  for (const CurvePoint& point : result.sweeps->by_rate_norm) counted += point.rcnn.count;
  EXPECT_EQ(counted, 3U);
}

// The body that a run shows is its own: of a sphere nothing is left of the target, and the next run has it
// again.
TEST_F(Experiment, RunsEachEffectOfRealSensorsOnItsOwnBody) {
  settings_.sensor_runs = true;
  settings_.sequences = 1;
  std::uint64_t last = 0;
  const SubjectResult result = run_experiment(subject_, settings_, [&](std::uint64_t done) { last = done; });
  EXPECT_EQ(last, steps_of(settings_));
  ASSERT_EQ(result.sensor_runs.size(), sensor_runs().size());
  std::set<double> first_errors_deg;
  for (std::size_t i = 0; i < sensor_runs().size(); ++i) {
    const CellResult& cell = result.sensor_runs[i];
    EXPECT_EQ(to_string(cell.effects), to_string(sensor_runs()[i].effects));
    EXPECT_EQ(to_string(cell.ranges), to_string(sensor_runs()[i].ranges));
    EXPECT_EQ(cell.rcnn.count, 1U);
    first_errors_deg.insert(cell.rcnn.mean_deg);
  }
  EXPECT_GT(first_errors_deg.size(), sensor_runs().size() / 2) << "most effects change the frames";
}

TEST_F(Experiment, ReportsWhatToDoWhenTheInertiaIsUnknown) {
  subject_.inertia_kg_m2.reset();
  settings_.conditions = {Condition::kStress};
  try {
    run_experiment(subject_, settings_, [](std::uint64_t) {});
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("--inertia Ixx,Iyy,Izz"), std::string::npos) << error.what();
  }
}

TEST_F(Experiment, CountsAMatchOfTheBaselineAsSeveralSteps) {
  const std::uint64_t without = steps_of(settings_);
  settings_.baseline_sequences = 2;
  EXPECT_EQ(steps_of(settings_), without + 2 * kStepsPerMatch);
}

}  // namespace
}  // namespace tumblesight::sim
