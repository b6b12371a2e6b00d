// What the simulated sensor sees with faults that are put into a run.
// Verifies TS-SIL-198.
#include "sim/operations/scene_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "sim/sil/simulated_steps.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/effects.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSequences = 2, kFrames = 10;

struct SeenStep {
  FrameTruth truth;
  gnc::RangeImage frame;
  gnc::ChaserAttitude chaser;
};

const FlashLidar& lidar() {
  static const FlashLidar kLidar = [] {
    std::vector<TriangleMesh> bodies{target_by_name("near_shoemaker")};
    mark_panels(bodies[0]);
    return FlashLidar(bodies);
  }();
  return kLidar;
}

// All steps, with a fault that begins at a step.
std::vector<SeenStep> steps_with(const InjectedFault& fault, std::uint32_t first,
                                 const std::vector<Sequence>& sequences = test::sequences(kSequences, 7)) {
  SimulatedSteps source(lidar(), test::kSwath_m, sequences, true);
  std::vector<SeenStep> steps;
  for (std::uint32_t k = 0; k < source.steps(); ++k) {
    if (k == first) source.begin_fault(fault);
    const SourcedStep sourced = source.next();
    steps.push_back({sourced.step.truth, *sourced.input.frames.at(0), sourced.input.navigations.at(0)});
  }
  return steps;
}
const std::vector<SeenStep>& steps_without() {
  static const std::vector<SeenStep> kSteps = steps_with({"noise", 2.0, 1}, 1000);
  return kSteps;
}

bool same(const gnc::RangeImage& a, const gnc::RangeImage& b) {
  return a.rays == b.rays && a.fov_urad == b.fov_urad && a.ranges == b.ranges &&
         a.exposure_time_ns == b.exposure_time_ns && a.sequence_number == b.sequence_number;
}

double strength_of(const FaultRow& row) {
  if (row.name == "rays") return 64;
  if (row.name == "link_budget") return 0.05;  // of a few photons
  if (row.name == "panel_lobe") return 5;
  if (row.name == "fixed_fov") return 0.5;
  return row.name == "range_scale" ? 0.05 : row.highest * 0.5;
}

// Every fault: it shows in its steps, and in no other.
TEST(SceneFault, ShowsInItsStepsOnly) {
  for (const FaultRow& row : fault_table()) {
    if (!row.is_of_scene || row.name == "turn") continue;
    constexpr std::uint32_t kFirst = 8, kSteps = 4;  // goes on into the next sequence
    const std::vector<SeenStep> steps = steps_with(
        {row.name, row.must_be_whole ? std::floor(strength_of(row)) : strength_of(row), kSteps}, kFirst);
    for (std::uint32_t k = 0; k < steps.size(); ++k) {
      const bool is_on = k >= kFirst && k < kFirst + kSteps;
      EXPECT_EQ(same(steps[k].frame, steps_without()[k].frame), !is_on) << row.name << ", step " << k;
      EXPECT_EQ(steps[k].truth.q_lrf_trf.coeffs(), steps_without()[k].truth.q_lrf_trf.coeffs());
    }
  }
}

std::size_t returns_of(const gnc::RangeImage& frame, double nearest_m, double farthest_m) {
  std::size_t count = 0;
  for (const std::uint16_t range : frame.ranges)
    if (range != 0 && range / 128.0 >= nearest_m && range / 128.0 < farthest_m) ++count;
  return count;
}

// The target is at 20 to 100 m, and an occluder nearer than 10 m.
TEST(SceneFault, AnOccluderHidesItsShareOfTheTarget) {
  const std::vector<SeenStep> steps = steps_with({"occlude", 0.4, 3}, 2);
  for (std::uint32_t k = 2; k < 5; ++k) {
    const double seen = static_cast<double>(returns_of(steps[k].frame, 12.0, 500.0));
    const double whole = static_cast<double>(returns_of(steps_without()[k].frame, 12.0, 500.0));
    EXPECT_NEAR(seen / whole, 0.6, 0.01) << k;
    EXPECT_GT(returns_of(steps[k].frame, 0.1, 12.0), 0U);
    EXPECT_EQ(steps[k].truth.occluder.hidden_share, 0.4);
  }
}

Eigen::Quaterniond inertial_attitude(const SeenStep& step) {
  return step.truth.q_inertial_lrf * step.truth.q_lrf_trf;
}

Eigen::Vector3d origin_of(const FrameTruth& truth) {
  return {test::kSwath_m * truth.offset_swaths.x(), truth.range_m, test::kSwath_m * truth.offset_swaths.y()};
}

// The chaser turns by rate x time from the step in which the fault begins. The target does not.
TEST(SceneFault, AChaserThatTurnsLeavesTheTargetsMotionAsItIs) {
  constexpr double kRate_deg_s = 3.0;
  constexpr std::uint32_t kFirst = 2, kSteps = 4;
  const std::vector<SeenStep> steps = steps_with({"turn", kRate_deg_s, kSteps}, kFirst);
  for (std::uint32_t k = 0; k < steps.size(); ++k) {
    EXPECT_LT(inertial_attitude(steps[k]).angularDistance(inertial_attitude(steps_without()[k])), 1e-7) << k;
    const std::uint32_t since = k < kFirst ? 0 : std::min(k - kFirst, kSteps);
    const double turned_rad = k < kFrames ? kRadPerDeg * kRate_deg_s * 2.7 * since : 0.0;
    const FrameTruth& base = steps_without()[k].truth;
    EXPECT_NEAR(steps[k].truth.q_inertial_lrf.angularDistance(base.q_inertial_lrf), turned_rad, 1e-7) << k;
    EXPECT_EQ(same(steps[k].frame, steps_without()[k].frame), turned_rad == 0.0) << k;
    // The rate of the target in inertial axes.
    EXPECT_LT((steps[k].truth.q_inertial_lrf * steps[k].truth.rate_lrf_rad_s -
               base.q_inertial_lrf * base.rate_lrf_rad_s)
                  .norm(),
              1e-9);
    // What the chaser's navigation says is what was rendered.
    EXPECT_NEAR(steps[k].chaser.q_inertial_lrf[0] / 1073741824.0, steps[k].truth.q_inertial_lrf.w(), 1e-9);
    const bool is_turning = k >= kFirst && k < kFirst + kSteps;
    EXPECT_EQ(steps[k].truth.velocity_lrf_m_s.norm() > 0.0, is_turning) << k;
    if (!is_turning) continue;
    // The velocity by the definition: of the target's place in axes that do not turn, w from the next step.
    const Eigen::Vector3d place_m = origin_of(steps[k].truth);
    const Eigen::AngleAxisd turn(steps[k].truth.q_inertial_lrf.conjugate() *
                                 steps[k + 1].truth.q_inertial_lrf);
    constexpr double kShort_s = 1e-4;
    const Eigen::AngleAxisd a_bit(turn.angle() / 2.7 * kShort_s, turn.axis());
    EXPECT_LT(((a_bit * place_m - place_m) / kShort_s - steps[k].truth.velocity_lrf_m_s).norm(), 1e-3) << k;
  }
}

TEST(SceneFault, TakesThePlaceOfOneOfTheSameName) {
  const std::vector<Sequence> sequences = test::sequences(1, 7);
  SimulatedSteps source(lidar(), test::kSwath_m, sequences, true);
  source.begin_fault({"occlude", 0.9, 10});
  (void)source.next();
  source.begin_fault({"occlude", 0.2, 1});
  EXPECT_EQ(source.next().step.truth.occluder.hidden_share, 0.2);
  EXPECT_EQ(source.next().step.truth.occluder.shape, OccluderShape::kNone);
}

TEST(SceneFault, SeveralActTogether) {
  const std::vector<Sequence> sequences = test::sequences(1, 7);
  SimulatedSteps source(lidar(), test::kSwath_m, sequences, true);
  source.begin_fault({"occlude", 0.3, 2});
  source.begin_fault({"rays", 64, 2});
  const SourcedStep step = source.next();
  EXPECT_EQ(step.input.frames.at(0)->rays, 64);
  EXPECT_EQ(step.step.truth.occluder.hidden_share, 0.3);
}

std::string refusal_of(SimulatedSteps& source, const InjectedFault& fault) {
  try {
    source.begin_fault(fault);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(SceneFault, IsRefusedWhereItCannotBe) {
  const std::vector<Sequence> sequences = test::sequences(1, 7);
  TriangleMesh mesh = target_by_name("near_shoemaker");
  mesh.is_panel.clear();
  const FlashLidar unmarked(mesh);
  SimulatedSteps without_panels(unmarked, test::kSwath_m, sequences, true);
  EXPECT_NE(refusal_of(without_panels, {"panel_lobe", 20, 1}).find("no solar panels"), std::string::npos);
  std::vector<Sequence> turning = sequences;
  turning[0].frames[3].q_inertial_lrf = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  SimulatedSteps source(lidar(), test::kSwath_m, turning, true);
  EXPECT_NE(refusal_of(source, {"turn", 1.0, 1}).find("turns already"), std::string::npos);
  for (std::uint32_t k = 0; k < source.steps(); ++k) (void)source.next();
  EXPECT_NE(refusal_of(source, {"noise", 2.0, 1}).find("at its end"), std::string::npos);
}

// Also with a fault that is new in every frame.
TEST(SceneFault, AFrozenSensorRepeatsWhatItSawWithTheFault) {
  std::vector<Sequence> sequences = test::sequences(1, 7);
  sequences[0].frames[3].frozen_for = 1;
  sequences[0].frames[4].frozen_for = 2;
  for (const char* fault : {"noise", "occlude", "turn"}) {
    SimulatedSteps source(lidar(), test::kSwath_m, sequences, true);
    source.begin_fault({fault, 0.5, 8});
    std::vector<gnc::RangeImage> frames;
    for (int k = 0; k < 5; ++k) frames.push_back(*source.next().input.frames.at(0));
    EXPECT_EQ(frames[3].ranges, frames[2].ranges) << fault;
    EXPECT_EQ(frames[4].ranges, frames[2].ranges) << fault;
    EXPECT_NE(frames[2].ranges, frames[1].ranges) << fault;
  }
}

// Frames that a disturbance of the run has lost stay lost.
TEST(SceneFault, DoesNotBringBackALostFrame) {
  std::vector<Sequence> sequences = test::sequences(1, 7);
  sequences[0].frames[1].lost = true;
  SimulatedSteps source(lidar(), test::kSwath_m, sequences, true);
  (void)source.next();
  source.begin_fault({"occlude", 0.3, 3});
  EXPECT_TRUE(source.next().input.frames.empty());
  EXPECT_EQ(source.next().input.frames.size(), 1U);
}

}  // namespace
}  // namespace tumblesight::sim
