#include "sim/experiment/experiment.hpp"

#include <memory>
#include <numeric>
#include <utility>

#include "sim/experiment/monte_carlo.hpp"
#include "sim/experiment/replay_command.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kFifth = 4;  // frame, by index

CellResult cell_result(const ExperimentRun& run, const SubjectDescription& subject,
                       const MonteCarloResult& result) {
  const auto frames = static_cast<std::uint32_t>(run.scenario.frames);
  const std::vector<FrameResult> last = last_frames(result.frames, frames);
  const auto errors = [&](Estimator estimator) {
    return last_frame_errors_deg(result.frames, frames, estimator);
  };
  const std::vector<NearSymmetry> symmetries = near_symmetries(subject.target);
  CellResult cell;
  cell.condition = run.scenario.condition;
  cell.sequences = run.sequences;
  cell.frames = frames;
  static_cast<RunConditions&>(cell) = {run.scenario.disturbances, run.scenario.effects.low, subject.sensor,
                                       run.scenario.ranges, subject.symmetry};
  cell.rcnn = last_frame_summary(result.frames, frames, Estimator::kRcnn);
  cell.cnn = last_frame_summary(result.frames, frames, Estimator::kCnn);
  cell.pose = pose_summary(result.frames, frames - 1);
  cell.pose_first = pose_summary(result.frames, 0);
  cell.never_valid_from_fifth = share_never_trusted(result.frames, kFifth);
  cell.common_turn = common_turn(last, Estimator::kRcnn);
  cell.rare = rare_events(last);
  cell.rcnn_histogram = histogram(errors(Estimator::kRcnn));
  cell.cnn_histogram = histogram(errors(Estimator::kCnn));
  if (run.baseline_sequences > 0) {
    cell.baseline = last_frame_summary(result.frames, frames, Estimator::kBaseline);
    cell.baseline_histogram = histogram(errors(Estimator::kBaseline));
  }
  cell.step_ms = result.step_ms;
  cell.baseline_ms = result.baseline_ms;
  cell.by_frame = errors_by_frame(result.frames, frames);
  cell.by_range = errors_by_range(last, run.scenario.ranges);
  cell.by_rate = errors_by_rate(last);
  cell.rcnn_confusion = confusion(last, Estimator::kRcnn, symmetries);
  cell.cnn_confusion = confusion(last, Estimator::kCnn, symmetries);
  cell.reliability = reliability(result.frames);
  cell.detection = detection(result.frames);
  return cell;
}

void take_sweep(const ExperimentRun& run, const MonteCarloResult& result, Sweeps& sweeps) {
  const auto frames = static_cast<std::uint32_t>(run.scenario.frames);
  const std::vector<FrameResult> last = last_frames(result.frames, frames);
  if (run.kind == ExperimentRun::Kind::kRateNorm) {
    sweeps.base = run.scenario.condition;
    sweeps.by_rate_norm = errors_by_rate(last);
  } else if (run.kind == ExperimentRun::Kind::kHiddenShare) {
    sweeps.sweep_sequences = run.sequences;
    sweeps.by_hidden_share.push_back(curve_point(run.scenario.hidden_share.value_or(0.0), last));
  } else {
    sweeps.long_sequences = run.sequences;
    sweeps.long_run = errors_by_frame(result.frames, frames);
  }
}

// Where the figures of a kind of run go; the curves have a place of their own.
std::vector<CellResult>* cells_of(ExperimentRun::Kind kind, SubjectResult& figures) {
  switch (kind) {
    case ExperimentRun::Kind::kCell:
      return &figures.cells;
    case ExperimentRun::Kind::kDisturbed:
      return &figures.disturbed;
    case ExperimentRun::Kind::kSensor:
      return &figures.sensor_runs;
    default:
      return nullptr;
  }
}

// What belongs to the subject.
void complete(ScenarioSettings& scenario, ExperimentRun::Kind kind, const SubjectDescription& subject) {
  scenario.sensor = subject.sensor.settings;
  if (kind != ExperimentRun::Kind::kSensor) scenario.ranges = subject.ranges;
  scenario.swath_m = subject.swath_m;
}

// With the inertia, which only the run itself needs.
std::vector<ExperimentRun> complete_runs(const Subject& subject, const ExperimentSettings& settings) {
  std::vector<ExperimentRun> runs = runs_of(settings);
  for (ExperimentRun& run : runs) {
    complete(run.scenario, run.kind, subject);
    run.scenario.inertia_kg_m2 =
        scenario_settings(run.scenario.condition, settings.frames, subject.target, subject.inertia_kg_m2)
            .inertia_kg_m2;
  }
  return runs;
}

}  // namespace

void set_replay(SubjectResult& figures, const std::string& command) {
  for (CellResult& cell : figures.cells) cell.replay = replay_command(command, cell.condition);
}

ExperimentFigures::ExperimentFigures(const SubjectDescription& subject, const ExperimentSettings& settings)
    : subject_(subject),
      runs_([&] {
        std::vector<ExperimentRun> runs = runs_of(settings);
        for (ExperimentRun& run : runs) complete(run.scenario, run.kind, subject);
        return runs;
      }()),
      figures_{subject.target, subject.mesh_name, subject.model_name, subject.model_crc32, {}, {}, {}, {}} {}

void ExperimentFigures::add(std::size_t run, SequenceResult&& result) {
  while (run_ < run) finish_run();
  results_.push_back(std::move(result));
}

SubjectResult ExperimentFigures::finish() {
  while (run_ < runs_.size()) finish_run();
  return std::move(figures_);
}

void ExperimentFigures::finish_run() {
  ExperimentRun& run = runs_[run_++];
  run.sequences = static_cast<std::uint32_t>(results_.size());
  const MonteCarloResult result = joined(std::move(results_), subject_.symmetry);
  results_ = {};
  if (std::vector<CellResult>* cells = cells_of(run.kind, figures_)) {
    cells->push_back(cell_result(run, subject_, result));
    return;
  }
  if (!figures_.sweeps) figures_.sweeps.emplace();
  take_sweep(run, result, *figures_.sweeps);
}

void run_chosen(const Subject& subject, const ExperimentSettings& settings, const SequenceChoice& choice,
                const std::function<void(std::size_t run, SequenceResult&&)>& take,
                const std::function<void(std::uint64_t)>& progress) {
  const std::vector<ExperimentRun> runs = complete_runs(subject, settings);
  const FlashLidar lidar(observed_bodies(settings.effects, subject.target, subject.mesh));
  const auto matcher = settings.baseline_sequences > 0
                           ? std::make_unique<TemplateMatcher>(subject.mesh, subject.swath_m)
                           : nullptr;
  std::uint64_t done = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ExperimentRun& run = runs[i];
    std::unique_ptr<FlashLidar> own_lidar;
    if (run.kind == ExperimentRun::Kind::kSensor)
      own_lidar =
          std::make_unique<FlashLidar>(observed_bodies(run.scenario.effects, subject.target, subject.mesh));
    const FrameRenderer renderer(own_lidar ? *own_lidar : lidar, subject.swath_m);
    const MonteCarloSettings monte_carlo{run.scenario,           settings.seed,    run.sequences,
                                         run.baseline_sequences, settings.threads, subject.symmetry};
    const std::vector<std::uint32_t> indices = choice(i, run);
    run_sequences(
        renderer, subject.model, matcher.get(), monte_carlo, indices,
        [&](SequenceResult&& result) { take(i, std::move(result)); },
        [&](std::uint32_t sequences) { progress(done + steps_of(run, sequences)); });
    done += steps_of(run, static_cast<std::uint32_t>(indices.size()));
  }
}

SubjectResult run_experiment(const Subject& subject, const ExperimentSettings& settings,
                             const std::function<void(std::uint64_t)>& progress) {
  ExperimentFigures figures(subject, settings);
  const auto all = [](std::size_t, const ExperimentRun& run) {
    std::vector<std::uint32_t> indices(run.sequences);
    std::iota(indices.begin(), indices.end(), 0U);
    return indices;
  };
  run_chosen(
      subject, settings, all,
      [&](std::size_t run, SequenceResult&& result) { figures.add(run, std::move(result)); }, progress);
  return figures.finish();
}

}  // namespace tumblesight::sim
