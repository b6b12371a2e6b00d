// Verifies TS-TRN-090.
#include "sim/training/mission_training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

TEST(MissionTraining, WithoutConditionsItIsTheUsualOne) {
  EXPECT_EQ(training_conditions(Mission{}), all_training_conditions());
}

TEST(MissionTraining, ConditionsHaveTheirWeightsAndAreMixed) {
  Mission mission;
  mission.conditions = {{"nominal", 100}, {"occluded", 50}, {"degraded", 50}};
  const std::vector<Condition> conditions = training_conditions(mission);
  ASSERT_EQ(conditions.size(), 4U) << "divided by what the weights have in common";
  EXPECT_EQ(std::count(conditions.begin(), conditions.end(), Condition::kNominal), 2);
  EXPECT_EQ(std::count(conditions.begin(), conditions.end(), Condition::kOccluded), 1);
  EXPECT_NE(conditions[0], conditions[1]) << "no two of the same one after the other";

  mission.conditions = {{"nominal", 7}, {"tumbling", 3}};
  const std::vector<Condition> many = training_conditions(mission);
  ASSERT_EQ(many.size(), 10U);
  EXPECT_EQ(std::count(many.begin(), many.begin() + 5, Condition::kTumbling) +
                std::count(many.begin() + 5, many.end(), Condition::kTumbling),
            3);
  EXPECT_GE(std::count(many.begin(), many.begin() + 5, Condition::kTumbling), 1) << "evenly";
  EXPECT_LE(std::count(many.begin(), many.begin() + 5, Condition::kTumbling), 2);
}

TEST(MissionTraining, AConditionForTestsOnlyIsRefused) {
  Mission mission;
  mission.conditions = {{"stress", 1}};
  EXPECT_THROW((void)training_conditions(mission), std::invalid_argument);
}

TEST(MissionTraining, PanelsThatTurnAddASetWithThemAtEveryAngle) {
  Mission mission;
  EXPECT_EQ(training_effect_sets(mission).size(), 1U);
  mission.panels = JointLimits{0.0, 0.0};
  EXPECT_EQ(training_effect_sets(mission).size(), 1U) << "fixed";
  mission.panels = JointLimits{-90.0, 0.0};
  const std::vector<EffectRanges> sets = training_effect_sets(mission);
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets[1].high.joints, 1.0);
}

}  // namespace
}  // namespace tumblesight::sim
