// The model images that ship with Tumblesight know attitudes as well as they have to.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "sim/cli/target_setup.hpp"
#include "sim/evaluation/monte_carlo.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSequences = 100;

std::vector<std::filesystem::path> shipped_models() {
  std::vector<std::filesystem::path> models;
  for (const auto& entry : std::filesystem::directory_iterator(TUMBLESIGHT_SOURCE_DIR "/fsw/models")) {
    if (entry.path().extension() == ".tsm") models.push_back(entry.path());
  }
  return models;
}

std::vector<FrameResult> fly(const TargetSetup& setup) {
  MonteCarloSettings settings;
  settings.sequences = kSequences;
  settings.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const FlashLidar lidar(setup.mesh);
  return run_monte_carlo(lidar, static_cast<double>(setup.projection.swath_m), setup.model, settings,
                         [](std::uint32_t) {});
}

void expect_accuracy(const std::vector<FrameResult>& results, Estimator estimator, double most_mean_deg,
                     double least_within_20deg) {
  const ErrorSummary summary = summarise(last_frame_errors_deg(results, kFramesPerSequence, estimator));
  EXPECT_EQ(summary.count, kSequences);
  EXPECT_LE(summary.mean_deg, most_mean_deg);
  EXPECT_GE(summary.within_20deg, least_within_20deg);
}

TEST(ShippedModels, MeetTheAccuracyRequired) {
  const std::vector<std::filesystem::path> models = shipped_models();
  ASSERT_FALSE(models.empty()) << "no model image in fsw/models";
  for (const std::filesystem::path& model : models) {
    SCOPED_TRACE(model.string());
    ScenarioArguments arguments;
    arguments.target = model.stem().string();
    const TargetSetup setup = set_up_target(arguments);
    ASSERT_EQ(setup.model_status, gnc::ModelStatus::kOk) << gnc::to_string(setup.model_status);
    EXPECT_TRUE(setup.warnings.empty()) << setup.warnings.front();
    const std::vector<FrameResult> results = fly(setup);
    expect_accuracy(results, Estimator::kRcnn, 8.0, 0.95);
    expect_accuracy(results, Estimator::kCnn, 25.0, 0.80);
  }
}

}  // namespace
}  // namespace tumblesight::sim
