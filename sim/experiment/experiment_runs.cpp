#include "sim/experiment/experiment_runs.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/evaluation/disturbed_runs.hpp"
#include "sim/evaluation/pose_goals.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kHiddenSteps = 10;
constexpr double kHiddenStep = 0.05;
constexpr std::uint32_t kSweepFraction = 3;  // a swept value runs a third of a cell's sequences
constexpr std::uint32_t kLongFraction = 9;
constexpr std::uint32_t kLongFrames = 200;
constexpr std::uint32_t kMaxLongSequences = 1000;  // limited by the memory for their frames

ExperimentRun plain_run(const ExperimentSettings& settings, Condition condition) {
  ExperimentRun run;
  run.scenario.condition = condition;
  run.scenario.frames = static_cast<int>(settings.frames);
  run.scenario.disturbances = settings.disturbances;
  run.scenario.effects = settings.effects;
  run.sequences = settings.sequences;
  return run;
}

std::uint32_t sequences_of(const ExperimentSettings& settings, Condition condition) {
  return condition == Condition::kTumbling ? settings.tumbling_sequences : settings.sequences;
}

std::vector<ExperimentRun> cells_of(const ExperimentSettings& settings) {
  std::vector<ExperimentRun> runs;
  for (const Condition condition : settings.conditions) {
    ExperimentRun& run = runs.emplace_back(plain_run(settings, condition));
    run.sequences = sequences_of(settings, condition);
    run.baseline_sequences = std::min(settings.baseline_sequences, run.sequences);
  }
  return runs;
}

std::vector<ExperimentRun> sweeps_of(const ExperimentSettings& settings) {
  const ExperimentRun base = plain_run(settings, settings.conditions.front());
  std::vector<ExperimentRun> runs{base};
  runs.back().kind = ExperimentRun::Kind::kRateNorm;
  runs.back().scenario.rate_distribution = RateDistribution::kNorm;
  for (int step = 1; step <= kHiddenSteps; ++step) {
    runs.push_back(base);
    runs.back().kind = ExperimentRun::Kind::kHiddenShare;
    runs.back().scenario.condition = Condition::kOccluded;
    runs.back().scenario.hidden_share = kHiddenStep * step;
    runs.back().sequences = std::max(1U, settings.sequences / kSweepFraction);
  }
  runs.push_back(base);
  runs.back().kind = ExperimentRun::Kind::kLong;
  runs.back().scenario.frames = static_cast<int>(kLongFrames);
  runs.back().sequences = std::clamp(settings.sequences / kLongFraction, 1U, kMaxLongSequences);
  return runs;
}

std::vector<ExperimentRun> disturbed_runs_of(const ExperimentSettings& settings) {
  std::vector<ExperimentRun> runs;
  for (const DisturbedRun& disturbed : disturbed_runs()) {
    ExperimentRun& run = runs.emplace_back(plain_run(settings, disturbed.condition));
    run.kind = ExperimentRun::Kind::kDisturbed;
    run.sequences = sequences_of(settings, disturbed.condition);  // those of the run without the disturbance
    run.scenario.disturbances = disturbed.disturbances;
  }
  return runs;
}

std::vector<ExperimentRun> sensor_runs_of(const ExperimentSettings& settings) {
  std::vector<ExperimentRun> runs;
  for (const SensorRun& of_sensor : sensor_runs()) {
    ExperimentRun& run = runs.emplace_back(plain_run(settings, Condition::kNominal));
    run.kind = ExperimentRun::Kind::kSensor;
    run.scenario.disturbances = {};
    run.scenario.effects = of_sensor.effects;
    run.scenario.ranges = of_sensor.ranges;
  }
  return runs;
}

void append(std::vector<ExperimentRun>& runs, const std::vector<ExperimentRun>& more) {
  runs.insert(runs.end(), more.begin(), more.end());
}

}  // namespace

std::uint64_t steps_of(const ExperimentRun& run, std::uint32_t sequences_done) {
  return std::uint64_t{sequences_done} * static_cast<std::uint64_t>(run.scenario.frames) +
         kStepsPerMatch * std::min(sequences_done, run.baseline_sequences);
}

std::vector<ExperimentRun> runs_of(const ExperimentSettings& settings) {
  if (settings.conditions.empty()) throw std::invalid_argument("an experiment needs at least one condition");
  std::vector<ExperimentRun> runs = cells_of(settings);
  if (settings.curves) append(runs, sweeps_of(settings));
  if (settings.disturbed_runs) append(runs, disturbed_runs_of(settings));
  if (settings.sensor_runs) append(runs, sensor_runs_of(settings));
  return runs;
}

std::uint64_t steps_of(const ExperimentSettings& settings) {
  std::uint64_t steps = 0;
  for (const ExperimentRun& run : runs_of(settings)) steps += steps_of(run, run.sequences);
  return steps;
}

}  // namespace tumblesight::sim
