// What `tumblesight evaluate --paper` sets out to measure, by the models and meshes there are.
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "sim/cli/evaluate_paper.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

class PaperPlanTest : public ::testing::Test {
 protected:
  void put(const std::string& name) { std::ofstream(here_.path(name)) << "x"; }
  PaperPlan plan() { return plan_paper(arguments_, here_.path("")); }

  Workplace here_;
  EvaluateArguments arguments_;
};

TEST_F(PaperPlanTest, TakesTheParametricMeshWithCurvesAndNotesWhatHasNoModel) {
  put("magellan.tsm");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 1U);
  EXPECT_EQ(made.subjects[0].scenario.target, "magellan");
  EXPECT_EQ(made.subjects[0].scenario.mesh, "");
  EXPECT_TRUE(made.subjects[0].curves);
  ASSERT_FALSE(made.notes.empty());
  EXPECT_NE(made.notes.front().find("near_shoemaker is left out: no model near_shoemaker.tsm"),
            std::string::npos);
}

TEST_F(PaperPlanTest, TakesABroughtMeshFirstAndDrawsTheCurvesOnIt) {
  put("near_shoemaker.tsm");
  put("magellan.tsm");
  put("near_shoemaker.stl");
  arguments_.mesh_folder = here_.path("");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 3U);
  EXPECT_EQ(stem(made.subjects[0].scenario.mesh), "near_shoemaker");
  EXPECT_TRUE(made.subjects[0].curves);
  EXPECT_EQ(made.subjects[1].scenario.mesh, "");
  EXPECT_FALSE(made.subjects[1].curves);
  EXPECT_EQ(made.subjects[2].scenario.target, "magellan");
  EXPECT_TRUE(made.subjects[2].curves);
}

TEST_F(PaperPlanTest, AddsTheModelTrainedByThePapersRuleAsARowOfItsOwn) {
  put("near_shoemaker.tsm");
  put("near_shoemaker_paper_rule.tsm");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 2U);
  EXPECT_EQ(stem(made.subjects[1].scenario.model), "near_shoemaker_paper_rule");
  EXPECT_EQ(made.subjects[1].scenario.target, "near_shoemaker");
  EXPECT_FALSE(made.subjects[1].baseline);
  EXPECT_FALSE(made.subjects[1].curves);
}

TEST_F(PaperPlanTest, WithoutAnyModelSaysWhatToDo) {
  try {
    plan();
    FAIL() << "planned";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("tumblesight train"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim
