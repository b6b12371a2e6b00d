#include "sim/cli/evaluate_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <thread>

#include "sim/cli/arguments.hpp"
#include "sim/cli/summary.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/evaluation/monte_carlo.hpp"
#include "sim/evaluation/progress.hpp"
#include "sim/evaluation/report.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kMostThreads = 1024;

struct EvaluateArguments {
  ScenarioArguments scenario;
  int threads = 0;  // 0: one a core
};

nlohmann::ordered_json result_json(const ScenarioArguments& scenario, const TargetSetup& setup,
                                   const std::vector<FrameResult>& results) {
  nlohmann::ordered_json row{{"target", scenario.target},
                             {"mesh", setup.mesh_name},
                             {"condition", scenario.condition},
                             {"sequences", scenario.sequences}};
  row["rcnn"] = summary_json(summarise(last_frame_errors_deg(results, scenario.frames, Estimator::kRcnn)));
  row["cnn"] = summary_json(summarise(last_frame_errors_deg(results, scenario.frames, Estimator::kCnn)));
  return nlohmann::ordered_json{{"rows", {row}}};
}

void evaluate(const EvaluateArguments& arguments) {
  const ScenarioArguments& scenario = arguments.scenario;
  require_bearable_length(scenario);
  if (!scenario.json.empty()) require_writable("--json", scenario.json);
  const TargetSetup setup = set_up_target(scenario);
  if (setup.model_status != gnc::ModelStatus::kOk) {
    throw std::runtime_error(
        fmt::format("model image '{}' is refused: {}", setup.model_path, gnc::to_string(setup.model_status)));
  }
  for (const std::string& warning : setup.warnings) fmt::print(stderr, "  note: {}\n", warning);

  MonteCarloSettings settings;
  settings.condition = condition_from(scenario.condition);
  settings.seed = scenario.seed;
  settings.sequences = scenario.sequences;
  settings.frames = scenario.frames;
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  settings.threads = arguments.threads > 0 ? arguments.threads : cores;

  fmt::print("\n  {}, {}, {} sequences of {} frames, seed {}\n  mesh {}, model {}\n\n", scenario.target,
             scenario.condition, scenario.sequences, scenario.frames, scenario.seed, setup.mesh_name,
             setup.model_path);
  std::fflush(stdout);
  const FlashLidar lidar(setup.mesh);
  ProgressBar bar("evaluating", "sequences", scenario.sequences);
  const std::vector<FrameResult> results =
      run_monte_carlo(lidar, static_cast<double>(setup.projection.swath_m), setup.model, settings,
                      [&](std::uint32_t done) { bar.update(done); });
  bar.finish();

  const PaperFigures paper = paper_figures(scenario.target, settings.condition);
  fmt::print("\n{}\n{}\n", headline_table(results, scenario.frames, paper),
             by_frame_table(results, scenario.frames));
  if (!scenario.json.empty())
    write_text_file(scenario.json, result_json(scenario, setup, results).dump(2) + "\n");
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Measure the accuracy of a model over many sequences, without DDS");
  auto arguments = std::make_shared<EvaluateArguments>();
  arguments->scenario.sequences = 900;
  add_scenario_options(*command, arguments->scenario);
  command
      ->add_option("--threads", arguments->threads,
                   "worker threads; 0: one a core; the figures do not depend on it")
      ->check(whole_number(0, kMostThreads))
      ->type_name("N")
      ->capture_default_str();
  command->footer(
      "\nExample: the paper's test of 900 sequences, degraded frames, figures to a file\n"
      "  tumblesight evaluate --target near_shoemaker --condition degraded --json degraded.json\n");
  command->callback([arguments] { evaluate(*arguments); });
}

}  // namespace tumblesight::sim
