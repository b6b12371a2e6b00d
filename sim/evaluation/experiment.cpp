#include "sim/evaluation/experiment.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "sim/evaluation/disturbed_runs.hpp"
#include "sim/evaluation/monte_carlo.hpp"
#include "sim/evaluation/pose_goals.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kHiddenSteps = 10;
constexpr double kHiddenStep = 0.05;
constexpr std::uint32_t kSweepFraction = 3;  // a swept value runs a third of a cell's sequences
constexpr std::uint32_t kLongFraction = 9;
constexpr std::uint32_t kLongFrames = 200;
constexpr std::uint32_t kFifth = 4;                // frame, by index
constexpr std::uint32_t kMaxLongSequences = 1000;  // limited by the memory for their frames

struct Run {
  enum class Kind { kCell, kRateNorm, kHiddenShare, kLong, kDisturbed, kSensor };
  Kind kind = Kind::kCell;
  ScenarioSettings scenario;
  std::uint32_t sequences = 0;
  std::uint32_t baseline_sequences = 0;
  std::vector<PosePeerRow> peers{};
};

std::vector<PosePeerRow> peers_of(const ExperimentSettings& settings) {
  std::vector<PosePeerRow> rows;
  if (!settings.peers || settings.baseline_sequences == 0) return rows;
  for (const PosePeerRow& row : pose_peers())
    if (row.missing == nullptr) rows.push_back(row);
  return rows;
}

std::uint64_t steps_of(const Run& run, std::uint32_t sequences_done) {
  return std::uint64_t{sequences_done} * static_cast<std::uint64_t>(run.scenario.frames) +
         (kStepsPerMatch + kStepsPerPeer * run.peers.size()) *
             std::min(sequences_done, run.baseline_sequences);
}

std::vector<Run> cells_of(const ExperimentSettings& settings) {
  std::vector<Run> runs;
  for (const Condition condition : settings.conditions) {
    Run run;
    run.scenario.condition = condition;
    run.scenario.frames = static_cast<int>(settings.frames);
    run.scenario.disturbances = settings.disturbances;
    run.scenario.effects = settings.effects;
    run.sequences = condition == Condition::kTumbling ? settings.tumbling_sequences : settings.sequences;
    run.baseline_sequences = std::min(settings.baseline_sequences, run.sequences);
    run.peers = peers_of(settings);
    runs.push_back(run);
  }
  return runs;
}

std::vector<Run> sweeps_of(const ExperimentSettings& settings) {
  Run base;
  base.scenario.condition = settings.conditions.front();
  base.scenario.frames = static_cast<int>(settings.frames);
  base.scenario.disturbances = settings.disturbances;
  base.scenario.effects = settings.effects;
  base.sequences = settings.sequences;

  std::vector<Run> runs{base};
  runs.back().kind = Run::Kind::kRateNorm;
  runs.back().scenario.rate_law = RateLaw::kNorm;
  for (int step = 1; step <= kHiddenSteps; ++step) {
    runs.push_back(base);
    runs.back().kind = Run::Kind::kHiddenShare;
    runs.back().scenario.condition = Condition::kOccluded;
    runs.back().scenario.hidden_share = kHiddenStep * step;
    runs.back().sequences = std::max(1U, settings.sequences / kSweepFraction);
  }
  runs.push_back(base);
  runs.back().kind = Run::Kind::kLong;
  runs.back().scenario.frames = static_cast<int>(kLongFrames);
  runs.back().sequences = std::clamp(settings.sequences / kLongFraction, 1U, kMaxLongSequences);
  return runs;
}

std::vector<Run> disturbed_runs_of(const ExperimentSettings& settings) {
  std::vector<Run> runs;
  for (const DisturbedRun& disturbed : disturbed_runs()) {
    Run run;
    run.kind = Run::Kind::kDisturbed;
    run.scenario.condition = disturbed.condition;
    run.scenario.frames = static_cast<int>(settings.frames);
    run.scenario.disturbances = disturbed.disturbances;
    run.scenario.effects = settings.effects;
    run.sequences = settings.sequences;
    runs.push_back(run);
  }
  return runs;
}

std::vector<Run> sensor_runs_of(const ExperimentSettings& settings) {
  std::vector<Run> runs;
  for (const SensorRun& of_sensor : sensor_runs()) {
    Run run;
    run.kind = Run::Kind::kSensor;
    run.scenario.frames = static_cast<int>(settings.frames);
    run.scenario.effects = of_sensor.effects;
    run.scenario.ranges = of_sensor.ranges;
    run.sequences = settings.sequences;
    runs.push_back(run);
  }
  return runs;
}

void append(std::vector<Run>& runs, const std::vector<Run>& more) {
  runs.insert(runs.end(), more.begin(), more.end());
}

std::vector<Run> runs_of(const ExperimentSettings& settings) {
  if (settings.conditions.empty()) throw std::invalid_argument("an experiment needs at least one condition");
  std::vector<Run> runs = cells_of(settings);
  if (settings.curves) append(runs, sweeps_of(settings));
  if (settings.disturbed_runs) append(runs, disturbed_runs_of(settings));
  if (settings.sensor_runs) append(runs, sensor_runs_of(settings));
  return runs;
}

// Every attitude of a peer counts as valid: it gives no other verdict.
PeerErrors peer_errors(const PosePeerRow& row, const PeerRun& run) {
  PeerErrors errors{row.key, row.name, summarise(run.errors_deg), run.ms};
  if (errors.summary.count == 0) return errors;
  const double found = static_cast<double>(run.found) / static_cast<double>(errors.summary.count);
  errors.summary.right_and_valid = errors.summary.within_20deg;
  errors.summary.wrong_and_valid = found - errors.summary.within_20deg;
  return errors;
}

CellResult cell_result(const Run& run, const std::string& target, const MonteCarloResult& result) {
  const auto frames = static_cast<std::uint32_t>(run.scenario.frames);
  const std::vector<FrameResult> last = last_frames(result.frames, frames);
  const auto errors = [&](Estimator estimator) {
    return last_frame_errors_deg(result.frames, frames, estimator);
  };
  const std::vector<NearSymmetry> symmetries = near_symmetries(target);
  CellResult cell;
  cell.condition = run.scenario.condition;
  cell.sequences = run.sequences;
  cell.frames = frames;
  cell.disturbances = run.scenario.disturbances;
  cell.effects = run.scenario.effects.low;
  cell.ranges = run.scenario.ranges;
  cell.rcnn = last_frame_summary(result.frames, frames, Estimator::kRcnn);
  cell.cnn = last_frame_summary(result.frames, frames, Estimator::kCnn);
  cell.pose = pose_summary(result.frames, frames - 1);
  cell.pose_first = pose_summary(result.frames, 0);
  cell.never_valid_from_fifth = share_never_trusted(result.frames, kFifth);
  cell.common_turn = common_turn(last, Estimator::kRcnn);
  cell.rcnn_histogram = histogram(errors(Estimator::kRcnn));
  cell.cnn_histogram = histogram(errors(Estimator::kCnn));
  if (run.baseline_sequences > 0) {
    cell.baseline = last_frame_summary(result.frames, frames, Estimator::kBaseline);
    cell.baseline_histogram = histogram(errors(Estimator::kBaseline));
  }
  cell.network_ms = result.network_ms;
  cell.baseline_ms = result.baseline_ms;
  for (std::size_t i = 0; i < run.peers.size(); ++i)
    cell.peers.push_back(peer_errors(run.peers[i], result.peers[i]));
  cell.by_frame = errors_by_frame(result.frames, frames);
  cell.by_range = errors_by_range(last, run.scenario.ranges);
  cell.by_rate = errors_by_rate(last);
  cell.rcnn_confusion = confusion(last, Estimator::kRcnn, symmetries);
  cell.cnn_confusion = confusion(last, Estimator::kCnn, symmetries);
  cell.reliability = reliability(result.frames);
  cell.detection = detection(result.frames);
  return cell;
}

void take_sweep(const Run& run, const MonteCarloResult& result, Sweeps& sweeps) {
  const auto frames = static_cast<std::uint32_t>(run.scenario.frames);
  const std::vector<FrameResult> last = last_frames(result.frames, frames);
  if (run.kind == Run::Kind::kRateNorm) {
    sweeps.base = run.scenario.condition;
    sweeps.by_rate_norm = errors_by_rate(last);
  } else if (run.kind == Run::Kind::kHiddenShare) {
    sweeps.sweep_sequences = run.sequences;
    sweeps.by_hidden_share.push_back(curve_point(run.scenario.hidden_share.value_or(0.0), last));
  } else {
    sweeps.long_sequences = run.sequences;
    sweeps.long_run = errors_by_frame(result.frames, frames);
  }
}

void take(const Run& run, const MonteCarloResult& result, SubjectResult& into) {
  if (run.kind == Run::Kind::kCell) {
    into.cells.push_back(cell_result(run, into.target, result));
    return;
  }
  if (run.kind == Run::Kind::kDisturbed) {
    into.disturbed.push_back(cell_result(run, into.target, result));
    return;
  }
  if (run.kind == Run::Kind::kSensor) {
    into.sensor_runs.push_back(cell_result(run, into.target, result));
    return;
  }
  if (!into.sweeps) into.sweeps.emplace();
  take_sweep(run, result, *into.sweeps);
}

}  // namespace

std::uint64_t steps_of(const ExperimentSettings& settings) {
  std::uint64_t steps = 0;
  for (const Run& run : runs_of(settings)) steps += steps_of(run, run.sequences);
  return steps;
}

SubjectResult run_experiment(const Subject& subject, const ExperimentSettings& settings,
                             const std::function<void(std::uint64_t)>& progress) {
  std::vector<Run> runs = runs_of(settings);
  for (Run& run : runs) {
    run.scenario.inertia_kg_m2 =
        scenario_settings(run.scenario.condition, settings.frames, subject.target, subject.inertia_kg_m2)
            .inertia_kg_m2;
    run.scenario.sensor = subject.sensor.settings;
    if (run.kind != Run::Kind::kSensor) run.scenario.ranges = subject.ranges;
    run.scenario.swath_m = subject.swath_m;
  }
  const FlashLidar lidar(observed_bodies(settings.effects, subject.target, subject.mesh));
  std::unique_ptr<TemplateMatcher> matcher;
  if (settings.baseline_sequences > 0) {
    matcher = std::make_unique<TemplateMatcher>(subject.mesh, subject.swath_m);
  }
  std::vector<std::unique_ptr<PosePeer>> peers;
  std::vector<const PosePeer*> peers_run;
  for (const PosePeerRow& row : peers_of(settings)) {
    peers.push_back(row.make(subject.mesh, subject.swath_m));
    peers_run.push_back(peers.back().get());
  }
  SubjectResult result{
      subject.target, subject.mesh_name, subject.model_name, subject.model_crc32, {}, {}, {}, {}};
  std::uint64_t done = 0;
  for (const Run& run : runs) {
    const bool with_peers = !run.peers.empty();
    std::unique_ptr<FlashLidar> own_lidar;
    if (run.kind == Run::Kind::kSensor)
      own_lidar =
          std::make_unique<FlashLidar>(observed_bodies(run.scenario.effects, subject.target, subject.mesh));
    const FrameRenderer renderer(own_lidar ? *own_lidar : lidar, subject.swath_m);
    const MonteCarloSettings monte_carlo{
        run.scenario,           settings.seed,    run.sequences,
        run.baseline_sequences, settings.threads, with_peers ? peers_run : std::vector<const PosePeer*>{},
        subject.symmetry};
    take(run,
         run_monte_carlo(renderer, subject.model, matcher.get(), monte_carlo,
                         [&](std::uint32_t sequences) { progress(done + steps_of(run, sequences)); }),
         result);
    done += steps_of(run, run.sequences);
  }
  for (auto* cells : {&result.cells, &result.disturbed, &result.sensor_runs}) {
    for (CellResult& cell : *cells) {
      cell.sensor = subject.sensor;
      cell.symmetry = subject.symmetry;
    }
  }
  return result;
}

}  // namespace tumblesight::sim
