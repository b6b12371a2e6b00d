#include "sim/campaign/campaign_results.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "sim/report/results_files.hpp"
#include "sim/report/results_json.hpp"
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

TEST_F(CampaignResults, MeshesOfOneFileAreToldApart) {
  const auto mesh_changed_by = [](float change_m) {
    return [change_m](SmallEvaluation& other) { other.subject.mesh.vertices_trf_m[0].x() += change_m; };
  };
  add_run([](SmallEvaluation&) {}, {"--mesh", "near.stl"});
  add_run(mesh_changed_by(1e-3F), {"--mesh", "near.stl", "--mesh-scale", "1.1"});
  add_run(mesh_changed_by(2e-3F), {"--mesh", "near.stl", "--mesh-up", "z"});
  add_run(mesh_changed_by(3e-3F), {"--mesh", "near.stl"});  // the file has changed since
  const std::vector<std::string> all = titles();
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[1], "NEAR Shoemaker, near.stl, model arbitrary, mesh-scale 1.1");
  EXPECT_EQ(all[2], "NEAR Shoemaker, near.stl, model arbitrary, mesh-up z");
  EXPECT_NE(all[0].find("mesh with CRC-32"), std::string::npos) << all[0];
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 4U);
}

TEST_F(CampaignResults, InertiasThatDifferALittleAreToldApart) {
  for (const double inertia : {500.0001, 500.0002})
    add_run([inertia](SmallEvaluation& other) {
      other.subject.inertia_kg_m2 = Eigen::Vector3d(inertia, 300.0, 400.0).asDiagonal();
    });
  EXPECT_NE(titles().at(0).find("inertia 500.0001,300,400,0,0,0"), std::string::npos) << titles()[0];
  EXPECT_NE(titles().at(1).find("inertia 500.0002,300,400,0,0,0"), std::string::npos);
  // A script can tell the rows apart.
  const std::string json = results_json(results()).dump(), csv = results_csv(results());
  for (const char* variant : {"500.0001,300", "500.0002,300"}) {
    EXPECT_NE(json.find(variant), std::string::npos) << json;
    EXPECT_NE(csv.find(variant), std::string::npos) << csv;
  }
}

TEST_F(CampaignResults, SequencesThatWouldCountTwiceAreRefused) {
  add_run([](SmallEvaluation&) {});
  add_run([](SmallEvaluation& other) {
    other.subject.mesh_name = "copy.stl";
    other.settings.sequences = 3;
  });
  try {
    results();
    FAIL() << "not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "runs run0 and run1 have the same sequences, which would count twice; leave out one of them");
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
