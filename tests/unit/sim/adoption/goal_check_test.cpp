#include "sim/adoption/goal_check.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

CellResult cell(Condition condition, double network_deg, double pose_deg, double within_20deg) {
  CellResult result;
  result.condition = condition;
  result.rcnn.count = 100;
  result.rcnn.mean_deg = network_deg;
  result.rcnn.within_20deg = 1.0;
  result.pose.count = 100;
  result.pose.known = 1.0;
  result.pose.mean_within_20_deg = pose_deg;
  result.pose.within_20deg = within_20deg;
  return result;
}

Mission mission_with(const std::string& condition, const MissionGoal& goal) {
  Mission mission;
  mission.goals[condition] = goal;
  return mission;
}

// Verifies TS-TRN-080.
TEST(GoalChecks, CompareEachFigureWithItsLimit) {
  MissionGoal goal;
  goal.network_mean_deg = 2.0;
  goal.pose_mean_deg = 0.3;
  goal.pose_within_20deg = 0.995;
  SubjectResult result;
  result.cells = {cell(Condition::kNominal, 2.5, 0.3, 0.994), cell(Condition::kDegraded, 9.0, 9.0, 0.0)};
  const std::vector<GoalCheck> checks = goal_checks(mission_with("nominal", goal), result);
  ASSERT_EQ(checks.size(), 3U) << "a condition without a goal is not checked";
  EXPECT_FALSE(checks[0].met);
  EXPECT_EQ(to_string(checks[0]), "nominal: network alone, mean error: 2.50°, and at most 2.00° is asked");
  EXPECT_TRUE(checks[1].met) << "the limit itself is allowed";
  EXPECT_FALSE(checks[2].met);
}

TEST(GoalChecks, AFigureThatDoesNotExistMeetsNoGoal) {
  MissionGoal goal;
  goal.pose_mean_deg = 180.0;
  goal.verified_wrong = 1.0;
  SubjectResult result;
  result.cells = {cell(Condition::kNominal, 1.0, 0.1, 1.0)};
  result.cells.front().pose.known = 0.0;
  for (const GoalCheck& check : goal_checks(mission_with("nominal", goal), result)) {
    EXPECT_FALSE(check.met) << check.figure;
    EXPECT_EQ(check.value, "-");
  }
}

TEST(FailingConditions, AreThoseWithMoreThanHalfWrong) {
  SubjectResult result;
  result.cells = {cell(Condition::kNominal, 1.0, 0.1, 1.0), cell(Condition::kOccluded, 60.0, 0.1, 1.0)};
  result.cells[1].rcnn.within_20deg = 0.4;
  EXPECT_EQ(failing_conditions(result),
            std::vector<std::string>{"occluded: 60.0 % of the network's attitudes are more than 20° off"});
}

}  // namespace
}  // namespace tumblesight::sim
