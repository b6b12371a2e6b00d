// The goals of the registered pose, and the trust that the report has to earn in each run.
#include "sim/evaluation/pose_goals.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace tumblesight::sim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

PoseSummary poses(double mean_within_20_deg, double within_20deg) {
  PoseSummary made;
  made.count = 900;
  made.known = 1.0;
  made.mean_within_20_deg = mean_within_20_deg;
  made.within_20deg = within_20deg;
  return made;
}

// Meets everything, of a run under effects.
CellResult trusted_cell() {
  CellResult cell;
  cell.effects.plume = 0.01;
  cell.pose.known = 1.0;
  cell.rcnn.count = 900;
  cell.rcnn.within_20deg = 0.9;
  cell.rcnn.wrong_and_valid = 0.01;
  cell.rcnn.right_and_valid = 0.9 * 0.97;
  cell.rcnn.error_below_3_expected = 0.97;
  cell.rcnn.expected_over_real = 1.5;
  return cell;
}

TEST(SensorRuns, DifferFromEachOtherAndFromThePapersConditions) {
  std::set<std::string> seen;
  for (const SensorRun& run : sensor_runs()) {
    CellResult cell;
    cell.effects = run.effects;
    cell.ranges = run.ranges;
    EXPECT_TRUE(differs_from_paper(cell));
    EXPECT_TRUE(seen.insert(differences_from_paper(cell)).second) << differences_from_paper(cell);
    const std::optional<PoseGoal> goal = pose_goal("magellan", cell);
    EXPECT_EQ(goal.has_value(), show_the_target(run.effects));
    EXPECT_EQ(goal.has_value(), run.goal.has_value());
    if (goal) {
      EXPECT_EQ(goal->most_mean_within_20_deg, run.goal->most_mean_within_20_deg);
    }
    EXPECT_FALSE(pose_goal("sacd_aquarius", cell).has_value()) << "its panels do not turn";
    cell.condition = Condition::kOccluded;
    EXPECT_FALSE(pose_goal("magellan", cell).has_value());
  }
}

TEST(PoseGoal, IsThatOfTargetAndCondition) {
  CellResult cell;
  ASSERT_TRUE(pose_goal("near_shoemaker", cell).has_value());
  EXPECT_EQ(pose_goal("near_shoemaker", cell)->most_mean_within_20_deg, 0.10);
  cell.condition = Condition::kOccluded;
  EXPECT_EQ(pose_goal("near_shoemaker", cell)->least_within_20deg, 0.995);
  EXPECT_EQ(pose_goal("sacd_aquarius_stowed", cell)->most_mean_within_20_deg, 0.7);
  EXPECT_FALSE(pose_goal("mine", cell).has_value());
  cell.condition = Condition::kStress;
  EXPECT_FALSE(pose_goal("near_shoemaker", cell).has_value());
  cell.condition = Condition::kNominal;
  cell.disturbances.lost_frames = 1;
  EXPECT_FALSE(pose_goal("near_shoemaker", cell).has_value());
}

TEST(PoseGoal, IsMetByMeanAndShareTogether) {
  const PoseGoal goal{0.10, kAllButOne};
  EXPECT_TRUE(meets(poses(0.10, 899.0 / 900.0), goal));
  EXPECT_FALSE(meets(poses(0.11, 1.0), goal));
  EXPECT_FALSE(meets(poses(0.05, 898.0 / 900.0), goal));
  EXPECT_FALSE(meets(poses(kNone, 0.0), goal));
  EXPECT_FALSE(meets({}, goal)) << "no surface in the image";
  EXPECT_EQ(text_of({0.3, 0.995}), "0.30°, 99.5 %");
}

TEST(Trust, NamesWhatIsMissed) {
  EXPECT_EQ(missed_trust(trusted_cell()), "");
  CellResult cell = trusted_cell();
  cell.rcnn.wrong_and_valid = 0.011;
  EXPECT_EQ(missed_trust(cell), "wrong and valid");
  cell = trusted_cell();
  cell.rcnn.right_and_valid = 0.87;
  EXPECT_EQ(missed_trust(cell), "right and valid");
  cell = trusted_cell();
  cell.rcnn.error_below_3_expected = 0.96;
  cell.rcnn.expected_over_real = 1.51;
  EXPECT_EQ(missed_trust(cell), "error below 3 expected, expected error");
  cell.rcnn.expected_over_real = kNone;
  EXPECT_EQ(missed_trust(cell), "error below 3 expected, expected error");
  cell = trusted_cell();
  cell.effects = {};
  EXPECT_EQ(missed_trust(cell), "right and valid") << "99.5 % under the paper's conditions";
}

TEST(Trust, OfAnotherObjectIsNeverToCallItValid) {
  CellResult cell;
  cell.effects.sphere = 1.0;
  cell.never_valid_from_fifth = 0.995;
  EXPECT_EQ(missed_trust(cell), "");
  cell.never_valid_from_fifth = 0.994;
  EXPECT_EQ(missed_trust(cell), "valid");
}

TEST(WrongAndValid, IsSummedOverTheRunsThatShowTheTarget) {
  SubjectResult subject;
  subject.target = "magellan";
  subject.cells.resize(2);
  subject.cells[0].pose.known = 1.0;
  subject.cells[0].rcnn.count = 900;
  subject.cells[0].rcnn.wrong_and_valid = 3.0 / 900.0;
  subject.cells[1].condition = Condition::kStress;  // without a goal
  subject.cells[1].pose.known = 1.0;
  subject.cells[1].rcnn.count = 900;
  subject.cells[1].rcnn.wrong_and_valid = 1.0;
  subject.sensor_runs = {trusted_cell(), trusted_cell()};
  subject.sensor_runs[1].effects = {};
  subject.sensor_runs[1].effects.sphere = 1.0;
  const WrongAndValid sum = wrong_and_valid({subject});
  EXPECT_EQ(sum.wrong, 12U);
  EXPECT_EQ(sum.frames, 1800U);
  EXPECT_DOUBLE_EQ(sum.share(), 12.0 / 1800.0);
  EXPECT_EQ(wrong_and_valid({}).share(), 0.0);
}

TEST(RightAndValid, IsSummedOverThePapersConditions) {
  SubjectResult subject;
  subject.target = "magellan";
  subject.cells.resize(3);
  for (CellResult& cell : subject.cells) {
    cell.pose.known = 1.0;
    cell.rcnn.count = 900;
    cell.rcnn.within_20deg = 800.0 / 900.0;
    cell.rcnn.right_and_valid = 780.0 / 900.0;
  }
  subject.cells[1].condition = Condition::kStress;  // without a goal
  subject.cells[2].condition = Condition::kOccluded;
  subject.cells[2].rcnn.right_and_valid = 700.0 / 900.0;
  subject.sensor_runs = {trusted_cell()};  // not the paper's
  const RightAndValid sum = right_and_valid({subject});
  EXPECT_EQ(sum.right, 1600U);
  EXPECT_EQ(sum.valid, 1480U);
  EXPECT_DOUBLE_EQ(sum.share(), 1480.0 / 1600.0);
  EXPECT_EQ(right_and_valid({}).share(), 0.0);
}

}  // namespace
}  // namespace tumblesight::sim
