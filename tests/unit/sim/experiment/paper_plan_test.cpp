// What `tumblesight evaluate --paper` measures, given the models and meshes that exist.
#include "sim/experiment/paper_plan.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

class PaperPlanTest : public ::testing::Test {
 protected:
  void put(const std::string& name) { std::ofstream(here_.path(name)) << "x"; }
  PaperPlan plan() { return plan_paper(mesh_folder_, here_.path("")); }

  TemporaryFolder here_;
  std::string mesh_folder_;
};

TEST_F(PaperPlanTest, TakesTheParametricMeshWithCurvesAndNotesTargetsWithoutAModel) {
  put("magellan.tsm");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 1U);
  EXPECT_EQ(made.subjects[0].target, "magellan");
  EXPECT_EQ(made.subjects[0].mesh, "");
  EXPECT_TRUE(made.subjects[0].curves);
  ASSERT_FALSE(made.notes.empty());
  EXPECT_NE(made.notes.front().find("near_shoemaker is left out: no model near_shoemaker.tsm"),
            std::string::npos);
}

TEST_F(PaperPlanTest, TakesAMeshFileFirstAndDrawsTheCurvesOnIt) {
  put("near_shoemaker.tsm");
  put("magellan.tsm");
  put("near_shoemaker.stl");
  mesh_folder_ = here_.path("");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 3U);
  EXPECT_EQ(stem(made.subjects[0].mesh), "near_shoemaker");
  EXPECT_TRUE(made.subjects[0].curves);
  EXPECT_TRUE(made.subjects[0].sensor_runs);
  EXPECT_EQ(made.subjects[1].mesh, "");
  EXPECT_FALSE(made.subjects[1].curves);
  EXPECT_FALSE(made.subjects[1].sensor_runs) << "once per target";
  EXPECT_EQ(made.subjects[2].target, "magellan");
  EXPECT_TRUE(made.subjects[2].curves);
}

TEST_F(PaperPlanTest, AddsTheModelTrainedByThePapersRuleAsARowOfItsOwn) {
  put("near_shoemaker.tsm");
  put("near_shoemaker_paper_rule.tsm");
  const PaperPlan made = plan();
  ASSERT_EQ(made.subjects.size(), 2U);
  EXPECT_EQ(stem(made.subjects[1].model), "near_shoemaker_paper_rule");
  EXPECT_EQ(made.subjects[1].target, "near_shoemaker");
  EXPECT_FALSE(made.subjects[1].baseline);
  EXPECT_FALSE(made.subjects[1].curves);
}

TEST_F(PaperPlanTest, WithoutAnyModelSaysWhatToDo) {
  try {
    plan();
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("tumblesight train"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim
