// Faults as a person gives them.
#include "sim/operations/fault_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <variant>

#include "sim/sil/frame_faults.hpp"
#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {
namespace {

std::string refusal_of(const InjectedFault& fault) {
  try {
    require_possible(fault);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(FaultTable, HasEveryFaultOnce) {
  std::set<std::string> names;
  for (const FaultRow& row : fault_table()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
  for (const EffectRow& row : effect_table())
    EXPECT_EQ(names.count(row.name), std::holds_alternative<BodyEffect>(row.apply) ? 0U : 1U) << row.name;
}

TEST(FaultTable, FaultsThatAreNotOfTheSceneAreOfTheFrames) {
  for (const FaultRow& row : fault_table()) {
    FrameFaults::Kind kind{};
    EXPECT_EQ(read_fault(row.name, kind), !row.is_of_scene) << row.name;
  }
}

TEST(FaultTable, TakesTheLimitsOfEveryStrengthAndRefusesWhatIsBeyond) {
  for (const FaultRow& row : fault_table()) {
    for (const double limit : {row.lowest, row.highest})
      EXPECT_EQ(refusal_of({row.name, limit, 1}), "") << row.name;
    for (const double beyond : {row.lowest - 0.001, row.highest + 1.0})
      EXPECT_NE(refusal_of({row.name, beyond, 1}), "") << row.name << ' ' << beyond;
  }
  EXPECT_NE(refusal_of({"range_bias", 0.0, 1}).find("and not 0"), std::string::npos);
  EXPECT_NE(refusal_of({"rays", 64.5, 1}).find("whole number from 16 to 128"), std::string::npos);
  EXPECT_NE(refusal_of({"drop", 1.0, 1}).find("has no strength"), std::string::npos);
}

TEST(FaultTable, NamesTheLimitOfSteps) {
  EXPECT_EQ(refusal_of({"drop", 0.0, kMostFaultSteps}), "");
  EXPECT_NE(refusal_of({"drop", 0.0, 0}).find("1 to 1000, not 0"), std::string::npos);
  EXPECT_NE(refusal_of({"drop", 0.0, kMostFaultSteps + 1}).find("1 to 1000, not 1001"), std::string::npos);
}

TEST(FaultTable, ListsTheNamesOrSaysWhyAnEffectIsNone) {
  EXPECT_NE(refusal_of({"melt", 1.0, 1}).find("drop, freeze, delay, occlude, turn"), std::string::npos);
  EXPECT_NE(refusal_of({"panel_turn", 10.0, 1}).find("simulate --effect panel_turn"), std::string::npos);
}

TEST(FaultTable, SaysAFaultInWords) {
  EXPECT_EQ(to_string(InjectedFault{"debris", 1.5, 5}), "debris 1.5 m for 5 steps");
  EXPECT_EQ(to_string(InjectedFault{"lobe", 20, 2}), "lobe 20 deg for 2 steps");
  EXPECT_EQ(to_string(InjectedFault{"drop", 0, 1}), "drop for 1 step");
}

}  // namespace
}  // namespace tumblesight::sim
