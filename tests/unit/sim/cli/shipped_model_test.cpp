// The shipped model images are as accurate as the figures stored with them say.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "sim/cli/subject_setup.hpp"
#include "sim/evaluation/monte_carlo.hpp"
#include "sim/evaluation/record.hpp"
#include "sim/evaluation/results.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kSequences = 50;
constexpr std::size_t kLeastRecorded = 500;  // sequences, for a record to hold anything against

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

MonteCarloResult fly(const Subject& subject, const FlashLidar& lidar, const Record& record) {
  MonteCarloSettings settings;
  settings.scenario =
      scenario_settings(record.condition, record.frames, subject.target, subject.inertia_kg_m2);
  settings.seed = record.seed;
  settings.sequences = kSequences;
  settings.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return run_monte_carlo({lidar, subject.swath_m}, subject.model, nullptr, settings, [](std::uint32_t) {});
}

void expect_as_recorded(const Subject& subject, const FlashLidar& lidar, const Record& record) {
  SCOPED_TRACE(to_string(record.condition));
  ASSERT_EQ(record.target, subject.target);
  ASSERT_EQ(record.model_crc32, subject.model_crc32) << "the record is of another image: measure it again";
  ASSERT_GE(record.rcnn.count, kLeastRecorded);
  const std::vector<FrameResult> frames = fly(subject, lidar, record).frames;
  const auto summary = [&](Estimator estimator) {
    return summarise(last_frame_errors_deg(frames, record.frames, estimator));
  };
  EXPECT_EQ(worse_than(record.rcnn, summary(Estimator::kRcnn)), "") << "RCNN";
  EXPECT_EQ(worse_than(record.cnn, summary(Estimator::kCnn)), "") << "CNN";
}

void check(const fs::path& model, const fs::path& record_file) {
  SCOPED_TRACE(model.string());
  const Subject subject = set_up_subject(arguments_for(model));
  const FlashLidar lidar(subject.mesh);
  int checked = 0;
  for (const Record& record : read_records(content(record_file), record_file.string())) {
    if (record.mesh != kParametricMesh) continue;
    expect_as_recorded(subject, lidar, record);
    ++checked;
  }
  EXPECT_GT(checked, 0) << "no row on the parametric mesh in " << record_file;
}

// Verifies TS-EST-180.
TEST(ShippedModels, AreAsGoodAsTheirRecords) {
  int models = 0;
  std::string without_record;
  for (const auto& entry : fs::directory_iterator(TUMBLESIGHT_SOURCE_DIR "/fsw/models")) {
    if (entry.path().extension() != ".tsm") continue;
    ++models;
    const fs::path record = fs::path(entry.path()).replace_extension(".json");
    if (fs::exists(record)) {
      check(entry.path(), record);
    } else {
      without_record += " " + entry.path().filename().string();
    }
  }
  EXPECT_GT(models, 0) << "no model image in fsw/models";
  if (!without_record.empty()) {
    GTEST_SKIP() << "no record beside" << without_record
                 << ": write fsw/models/<name>.json with tumblesight evaluate --json";
  }
}

}  // namespace
}  // namespace tumblesight::sim
