// The shipped model images are as accurate as the figures stored with them say.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/experiment/experiment.hpp"
#include "sim/experiment/monte_carlo.hpp"
#include "sim/experiment/shipped_figures.hpp"
#include "sim/model/model_file.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kSequences = 50;
constexpr std::size_t kMinShipped = 500;  // sequences, for figures that are worth a comparison

// <target>.tsm, <target>_paper_rule.tsm and those with .float32 before .tsm
ScenarioArguments arguments_for(const fs::path& model) {
  ScenarioArguments arguments;
  arguments.target = model.stem().string();
  for (const char* const suffix : {".float32", "_paper_rule"}) {
    const std::size_t found = arguments.target.find(suffix);
    if (found != std::string::npos) arguments.target.erase(found);
  }
  arguments.model = model.string();
  return arguments;
}

MonteCarloResult run(const Subject& subject, const FlashLidar& lidar, const ShippedFigures& shipped) {
  MonteCarloSettings settings;
  settings.scenario =
      scenario_settings(shipped.condition, shipped.frames, subject.target, subject.inertia_kg_m2);
  settings.seed = shipped.seed;
  settings.sequences = kSequences;
  settings.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return run_monte_carlo(FrameRenderer(lidar, subject.swath_m), subject.model, nullptr, settings,
                         [](std::uint32_t) {});
}

void expect_as_shipped(const Subject& subject, const FlashLidar& lidar, const ShippedFigures& shipped) {
  SCOPED_TRACE(to_string(shipped.condition));
  ASSERT_EQ(shipped.target, subject.target);
  ASSERT_EQ(shipped.model_crc32, subject.model_crc32) << "the figures are of another image: measure again";
  ASSERT_GE(shipped.rcnn.count, kMinShipped);
  const std::vector<FrameResult> frames = run(subject, lidar, shipped).frames;
  const auto summary = [&](Estimator estimator) {
    return summarise(last_frame_errors_deg(frames, shipped.frames, estimator));
  };
  EXPECT_EQ(worse_than(shipped.rcnn, summary(Estimator::kRcnn)), "") << "RCNN";
  EXPECT_EQ(worse_than(shipped.cnn, summary(Estimator::kCnn)), "") << "CNN";
}

void check(const fs::path& model, const fs::path& figures_file) {
  SCOPED_TRACE(model.string());
  const Subject subject = set_up_subject(arguments_for(model));
  const FlashLidar lidar(subject.mesh);
  int checked = 0;
  for (const ShippedFigures& shipped : read_shipped_figures(content(figures_file), figures_file.string())) {
    if (shipped.mesh != kParametricMesh) continue;
    expect_as_shipped(subject, lidar, shipped);
    ++checked;
  }
  EXPECT_GT(checked, 0) << "no row on the parametric mesh in " << figures_file;
}

// The figures of every image are in the tree, but some images are only in the history. None may be left out
// unnoticed: in a clone without history this test is skipped with the list of the missing images.
TEST(ShippedModels, AreThereForEveryRecord) {
  constexpr int kNoHistory = 3;  // exit status of fetch_images
  int records = 0;
  std::string not_in_clone;
  for (const auto& entry : fs::directory_iterator(TUMBLESIGHT_SOURCE_DIR "/fsw/models")) {
    if (entry.path().extension() != ".json") continue;
    ++records;
    const fs::path image = fs::path(entry.path()).replace_extension(".tsm");
    if (fs::exists(image)) continue;
    const std::string remedy = remedy_for_missing_image(image.string());
    ASSERT_FALSE(remedy.empty()) << image << " is missing";
    const std::string command =
        TUMBLESIGHT_SOURCE_DIR "/fsw/models/fetch_images '" + image.stem().string() + "'";
    const int status = std::system(command.c_str());
    ASSERT_EQ(WEXITSTATUS(status), kNoHistory) << image << " is missing" << remedy;
    not_in_clone += " " + image.filename().string();
  }
  EXPECT_GT(records, 0) << "no figures in fsw/models";
  if (!not_in_clone.empty()) GTEST_SKIP() << "not in the history of this clone:" << not_in_clone;
}

// Verifies TS-EST-180.
TEST(ShippedModels, AreAsAccurateAsTheirFigures) {
  int models = 0;
  std::string without_figures;
  for (const auto& entry : fs::directory_iterator(TUMBLESIGHT_SOURCE_DIR "/fsw/models")) {
    if (entry.path().extension() != ".tsm") continue;
    ++models;
    const fs::path figures = fs::path(entry.path()).replace_extension(".json");
    if (fs::exists(figures)) {
      check(entry.path(), figures);
    } else {
      without_figures += " " + entry.path().filename().string();
    }
  }
  EXPECT_GT(models, 0) << "no model image in fsw/models";
  if (!without_figures.empty()) {
    GTEST_SKIP() << "no figures beside" << without_figures
                 << ": write fsw/models/<name>.json with tumblesight evaluate --json";
  }
}

}  // namespace
}  // namespace tumblesight::sim
