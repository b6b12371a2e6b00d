#include "sim/campaign/campaign_results.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

class CampaignResults : public ::testing::Test {
 protected:
  // Adds a run of one task, and runs it.
  void add_run(const std::function<void(SmallEvaluation&)>& change, std::vector<std::string> options = {}) {
    SmallEvaluation evaluation;
    evaluation.settings.sequences = 2;
    change(evaluation);
    CampaignRun run;
    run.name = "run" + std::to_string(campaign_.runs.size());
    run.options = std::move(options);
    run.sequences = evaluation.settings.sequences;
    tasks_.push_back(
        {campaign_.runs.size(), {0, 1}, evaluation.run({0, 1}, folder_, run.name), run.sequences});
    campaign_.runs.push_back(run);
  }
  Results results() const {
    return campaign_results(campaign_, tasks_, MergeMode::kComplete, [](std::size_t) {});
  }
  std::vector<std::string> titles() const {
    std::vector<std::string> titles;
    for (const SubjectResult& subject : results().subjects) titles.push_back(title_of(subject));
    return titles;
  }

  Campaign campaign_;
  std::vector<CampaignTask> tasks_;
  const TemporaryFolder folder_;
};

void change_mesh(SmallEvaluation& evaluation) {
  evaluation.subject.mesh.vertices_trf_m[0].x() += 1e-3F;
}

TEST_F(CampaignResults, RunsThatDifferInWhatTheirNamesTellAreOneSubject) {
  add_run([](SmallEvaluation&) {});
  add_run([](SmallEvaluation& other) { other.settings.conditions = {Condition::kDegraded}; });
  add_run([](SmallEvaluation& other) { other.settings.effects = effects_from({"noise=2"}); });
  const Results all = results();
  ASSERT_EQ(all.subjects.size(), 1U);
  EXPECT_EQ(title_of(all.subjects[0]), "NEAR Shoemaker, parametric mesh, model arbitrary");
  EXPECT_EQ(all.subjects[0].cells.size(), 2U);
  EXPECT_EQ(all.subjects[0].sensor_runs.size(), 1U);
}

TEST_F(CampaignResults, MeshesOfOneFileNameAreNamedWithTheirFolders) {
  add_run([](SmallEvaluation& first) { first.subject.mesh_name = "near.stl"; }, {"--mesh", "a/near.stl"});
  const auto second = [](SmallEvaluation& other) {
    other.subject.mesh_name = "near.stl";
    change_mesh(other);
  };
  add_run(second, {"--mesh", "b/near.stl"});
  EXPECT_EQ(titles(), (std::vector<std::string>{"NEAR Shoemaker, a/near.stl, model arbitrary",
                                                "NEAR Shoemaker, b/near.stl, model arbitrary"}));
  EXPECT_EQ(results().subjects[1].mesh, "b/near.stl");
}

// Tables with a line per frame read as many frames of every cell of a subject.
TEST_F(CampaignResults, RunsWithOtherFramesAreAnotherSubject) {
  add_run([](SmallEvaluation&) {});
  add_run([](SmallEvaluation& other) { other.settings.frames = 1; });
  EXPECT_EQ(titles(),
            (std::vector<std::string>{"NEAR Shoemaker, parametric mesh, model arbitrary, 3 frames",
                                      "NEAR Shoemaker, parametric mesh, model arbitrary, 1 frame"}));
  for (const SubjectResult& subject : results().subjects) {
    ASSERT_EQ(subject.cells.size(), 1U);
    EXPECT_EQ(subject.cells[0].by_frame.size(), subject.cells[0].frames);
  }
}

TEST_F(CampaignResults, WhateverElseDiffersIsInTheTitle) {
  add_run([](SmallEvaluation&) {});
  add_run([](SmallEvaluation& other) { other.subject.model_crc32 = 0xABC; });
  add_run(change_mesh);
  add_run([](SmallEvaluation& other) {
    other.subject.inertia_kg_m2 = Eigen::Vector3d(372.0, 370.0, 400.0).asDiagonal();
  });
  const std::vector<std::string> all = titles();
  ASSERT_EQ(all.size(), 4U);
  EXPECT_NE(all[1].find("model with CRC-32 00000abc"), std::string::npos) << all[1];
  EXPECT_NE(all[2].find("mesh with CRC-32 "), std::string::npos) << all[2];
  EXPECT_NE(all[3].find("inertia 372,370,400,0,0,0"), std::string::npos) << all[3];
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 4U);
}

}  // namespace
}  // namespace tumblesight::sim
