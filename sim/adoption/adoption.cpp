#include "sim/adoption/adoption.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>

#include "sim/adoption/adoption_plan.hpp"
#include "sim/adoption/adoption_report.hpp"
#include "sim/adoption/image_keeper.hpp"
#include "sim/adoption/outlook.hpp"
#include "sim/adoption/start_choice.hpp"
#include "sim/adoption/time_plan.hpp"
#include "sim/experiment/experiment.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/sil/flight_process.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/mission_training.hpp"
#include "sim/training/stage.hpp"
#include "sim/training/train.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMesh = "mesh";
constexpr const char* kStart = "choice of the start";
constexpr const char* kCnn = "training of the CNN";
constexpr const char* kRecurrent = "training of the recurrent part";
constexpr const char* kFixedPoint = "fixed point";
constexpr const char* kEvaluation = "evaluation";
constexpr const char* kFlight = "flight over DDS";

constexpr double kTrial_s = 15.0;
constexpr std::int64_t kTrialImages = 6400;
constexpr double kLeastForTrials_s = 20 * 60.0;
constexpr std::uint32_t kProbeSequences = 16;
constexpr double kUsualSequence_s = 0.02;
constexpr std::uint32_t kFlownSequences = 10;
constexpr double kLongestFlight_s = 300.0;
constexpr int kMostlyWrong = 4;               // exit status of `simulate`
constexpr std::uint32_t kShareForJoints = 3;  // a row of an angle has a third of the sequences

// The largest number of threads that divides the batch, up to the point where parts become too small to be
// normalized.
int trainers_of(int threads) {
  constexpr int kMost = 4;
  int trainers = 1;
  while (2 * trainers <= std::min(threads, kMost)) trainers *= 2;
  return trainers;
}

// In the order of the table of conditions. Tumbling needs an inertia.
std::vector<Condition> judged_conditions(const Mission& mission) {
  std::vector<Condition> conditions;
  for (const ConditionRow& row : kConditions) {
    if (mission.goals.count(row.name) == 0) continue;
    if (needs_inertia(row.condition) && !mission.inertia) continue;
    conditions.push_back(row.condition);
  }
  return conditions;
}

std::vector<double> joint_angles_deg(const JointLimits& limits) {
  std::vector<double> angles;
  for (const double share : {1.0, 0.5}) {
    if (limits.lowest_deg < 0.0) angles.push_back(share * limits.lowest_deg);
  }
  for (const double share : {0.5, 1.0}) {
    if (limits.highest_deg > 0.0) angles.push_back(share * limits.highest_deg);
  }
  return angles;
}

class Adoption {
 public:
  Adoption(const AdoptionSettings& settings, const std::atomic<bool>& stop)
      : settings_(settings),
        mission_(settings.mission),
        stop_(stop),
        plan_path_(settings.folder + "/training/plan.json"),
        found_plan_(read_plan(plan_path_, mission_crc32(settings.mission), settings.minutes, settings.seed)),
        symmetry_(target_symmetry_from(settings.mission.symmetry)),
        steps_(mission_.title, settings.folder, 60.0 * settings.minutes,
               found_plan_ ? found_plan_->elapsed_s : 0.0) {}

  AdoptionOutcome run() {
    fs::create_directories(settings_.folder + "/training");
    const double budget_s = 60.0 * settings_.minutes;
    for (const char* step : {kMesh, kStart, kCnn, kRecurrent, kFixedPoint, kEvaluation, kFlight})
      steps_.plan(step, 0.0);
    if (check_mesh()) {
      prepare();
      const bool done = choose_start(budget_s) && train() && go_on([this] { to_fixed_point(); }) &&
                        go_on([this] { evaluate(); }) && go_on([this] { fly(); });
      outcome_.stopped = !done;
    }
    judge();
    return std::move(outcome_);
  }

 private:
  // One more step. False if the run was stopped before its end.
  bool go_on(const std::function<void()>& step) {
    if (stop_) return false;
    step();
    save_plan();
    return !stop_;
  }

  void save_plan() {
    plan_.elapsed_s = steps_.elapsed_s();
    write_plan(plan_path_, plan_);
  }

  // False if no network could be right.
  bool check_mesh() {
    steps_.begin(kMesh);
    const MeshFileOptions options = mesh_file_options(mission_.mesh);
    mesh_ = mission_.mesh.file == kParametricMesh ? target_by_name(mission_.name)
                                                  : read_mesh_file(mission_.mesh.file, options);
    outcome_.mesh = inspect(mesh_, options);
    const MeshGate gate = mesh_gate(mission_, outcome_.mesh);
    for (const std::string& doubt : gate.doubts) {
      print_message("  warning: " + doubt);
      steps_.remark(doubt);
    }
    for (const std::string& remark : gate.remarks) print_note(remark);
    outcome_.remarks = gate.remarks;
    outcome_.reasons = gate.faults;
    outcome_.reasons.insert(outcome_.reasons.end(), gate.doubts.begin(), gate.doubts.end());
    if (!mission_.inertia)
      outcome_.remarks.emplace_back(
          "The mission has no inertia: the network learns the free rotation of a sphere, and tumbling is not "
          "judged.");
    steps_.say(fmt::format("{} triangles, radius {:.2f} m", outcome_.mesh.triangles, outcome_.mesh.radius_m));
    return gate.faults.empty();
  }

  void prepare() {
    const Eigen::Matrix3d inertia =
        mission_.inertia ? tensor_of(*mission_.inertia) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    targets_ =
        make_training_targets({mesh_}, training_conditions(mission_), inertia, training_effect_sets(mission_),
                              mission_.name, settings_.sensor, settings_.ranges_of);
    targets_.mission_crc32 = mission_crc32(mission_);
    training_.folder = settings_.folder + "/training";
    training_.seed = settings_.seed;
    training_.workers = std::max(1, settings_.threads - 1);
    training_.trainers = found_plan_ ? found_plan_->trainers : trainers_of(settings_.threads);
    training_.bfloat16 = cpu_has_bfloat16();
    training_.checkpoint_s = 60.0;
    keep_to_one_thread();
    torch::manual_seed(settings_.seed);
    keeper_ = std::make_unique<ImageKeeper>(
        settings_.folder + "/" + mission_.name, mesh_,
        1e-3 * model_header(mission_.name, targets_).projection.target_radius_mm,
        scenario_of(targets_, Condition::kNominal, {}, 1), symmetry_);
    write_file(settings_.folder + "/" + mission_.name + ".sensor.json", to_json(settings_.sensor));
  }

  // Also shares out the time. False if it was stopped.
  bool choose_start(double budget_s) {
    steps_.begin(kStart);
    if (found_plan_) {
      plan_ = *found_plan_;
      require_same_start();
    } else {
      plan_.mission_crc32 = mission_crc32(mission_);
      plan_.minutes = settings_.minutes;
      plan_.seed = settings_.seed;
      plan_.trainers = training_.trainers;
      plan_.start_from = nearest_start(budget_s);
      if (stop_) return false;
      const auto rows = static_cast<std::uint32_t>(judged_conditions(mission_).size());
      plan_.time = time_plan(steps_.left_s(), rows + 1, sequence_s(), settings_.sequences);
      save_plan();
    }
    training_.start_from = plan_.start_from;
    training_.cnn_seconds = plan_.time.cnn_s;
    training_.rcnn_seconds = plan_.time.rcnn_s;
    steps_.plan(kCnn, plan_.time.cnn_s);
    steps_.plan(kRecurrent, plan_.time.rcnn_s);
    steps_.plan(kEvaluation, plan_.time.after_s);
    outcome_.start_from =
        plan_.start_from.empty() ? "random weights" : fs::path(plan_.start_from).filename().string();
    if (plan_.start_from.empty())
      outcome_.remarks.emplace_back(
          "The training began from random weights, since there is no trained network in float32 to begin "
          "from: "
          "fsw/models/fetch_images gets them from the history of the repository.");
    fmt::print("    {}\n", outcome_.start_from);
    steps_.say(outcome_.start_from);
    return true;
  }

  void require_same_start() const {
    const bool same = !settings_.start_was_given ||
                      (settings_.start_from.empty() ? plan_.start_from.empty()
                                                    : settings_.start_from.front() == plan_.start_from);
    if (same && (settings_.sequences == 0 || settings_.sequences == plan_.time.sequences)) return;
    throw std::runtime_error(fmt::format(
        "'{}' is of a run that began from {} and evaluates {} sequences; leave --start-from and --sequences "
        "out to go "
        "on, or choose another --out",
        plan_path_, plan_.start_from.empty() ? "random weights" : plan_.start_from, plan_.time.sequences));
  }

  std::string nearest_start(double budget_s) {
    const std::vector<std::string>& candidates = settings_.start_from;
    if (candidates.empty()) return {};
    if (candidates.size() == 1 || budget_s < kLeastForTrials_s) return candidates.front();
    steps_.plan(kStart, kTrial_s * static_cast<double>(candidates.size()));
    const std::vector<StartTrial> trials =
        start_trials(targets_, training_, candidates, kTrialImages, training_.folder, stop_);
    if (trials.empty()) return candidates.front();
    for (const StartTrial& trial : trials)
      fmt::print("    after {} images from {}: {:.1f}°\n", kTrialImages,
                 fs::path(trial.image).filename().string(), trial.mean_deg);
    return trials.front().image;
  }

  Subject subject_of(const std::string& image) {
    Subject subject;
    subject.target = mission_.name;
    subject.mesh_name = mission_.mesh.file == kParametricMesh
                            ? std::string(kParametricMesh)
                            : fs::path(mission_.mesh.file).filename().string();
    subject.mesh = mesh_;
    subject.swath_m = 1e-3 * targets_.projection.swath_mm;
    subject.model = read_model_bytes(image);
    subject.model_crc32 = gnc::model_image_crc32(subject.model.data());
    subject.model_name = fs::path(image).stem().string();
    if (mission_.inertia) subject.inertia_kg_m2 = tensor_of(*mission_.inertia);
    subject.sensor = settings_.sensor;
    subject.ranges = targets_.ranges;
    subject.symmetry = symmetry_;
    return subject;
  }

  ExperimentSettings experiment_settings(std::uint32_t sequences) const {
    ExperimentSettings experiment;
    experiment.seed = settings_.seed;
    experiment.sequences = experiment.tumbling_sequences = sequences;
    experiment.baseline_sequences = 0;
    experiment.disturbances.period_s = settings_.sensor.period_s;
    experiment.threads = settings_.threads;
    return experiment;
  }

  // Measured with the network to start from, where its image in fixed point is at hand.
  double sequence_s() {
    const std::string image = model_stem(plan_.start_from) + ".tsm";
    if (plan_.start_from.empty() || !fs::is_regular_file(image)) return kUsualSequence_s;
    const auto start = std::chrono::steady_clock::now();
    (void)run_experiment(subject_of(image), experiment_settings(kProbeSequences), [](std::uint64_t) {});
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kProbeSequences;
  }

  // False if it was stopped.
  bool train() {
    Cnn cnn;
    Recurrent recurrent(targets_.inertia);
    training_.after_point = [&](const TrainingPoint& point, bool best) {
      steps_.say(fmt::format("validation error {:.2f}°", point.mean_deg));
      save_plan();
      if (best) keep_images(cnn, recurrent, point);
    };
    steps_.begin(kCnn);
    bool finished = train_cnn(targets_, training_, cnn, stop_);
    if (finished) {
      // A run that was continued has less time.
      training_.rcnn_seconds = std::max(0.25 * plan_.time.rcnn_s,
                                        std::min(plan_.time.rcnn_s, steps_.left_s() - plan_.time.after_s));
      steps_.begin(kRecurrent);
      finished = train_rcnn(targets_, training_, cnn, recurrent, stop_);
    }
    save_plan();
    outcome_.training = read_training_log(training_.folder);
    if (finished) network_ = model_of(cnn, recurrent, mission_.name, targets_);
    return finished;
  }

  void keep_images(const Cnn& cnn, const Recurrent& recurrent, const TrainingPoint& point) {
    if (point.stage == "rcnn") return keeper_->keep(model_of(cnn, recurrent, mission_.name, targets_));
    Recurrent neutral(targets_.inertia);
    make_neutral(neutral, kRadPerDeg * point.mean_deg);
    keeper_->keep(model_of(cnn, neutral, mission_.name, targets_));
  }

  void to_fixed_point() {
    steps_.begin(kFixedPoint);
    const QuantizationReport report = keeper_->finish(*network_, plan_.time.calibration_sequences);
    outcome_.model_path = keeper_->fixed_path();
    outcome_.model_crc32 = report.crc32;
    steps_.say(fmt::format("differs from float32 by {:.2f}°", report.difference.median_deg));
  }

  void evaluate() {
    steps_.begin(kEvaluation);
    const Subject subject = subject_of(outcome_.model_path);
    ExperimentSettings experiment = experiment_settings(plan_.time.sequences);
    experiment.conditions = judged_conditions(mission_);
    ProgressBar bar("evaluating", "steps", steps_of(experiment));
    outcome_.result = run_experiment(subject, experiment, [&bar](std::uint64_t done) { bar.update(done); });
    bar.finish();
    if (panels_turn(mission_)) evaluate_joints(subject);
    std::string text;
    for (const CellResult& cell : outcome_.result.cells)
      text += fmt::format("{}{} {:.2f}°", text.empty() ? "network: " : ", ", to_string(cell.condition),
                          cell.rcnn.mean_deg);
    steps_.say(text);
  }

  void evaluate_joints(const Subject& subject) {
    for (const double angle_deg : joint_angles_deg(*mission_.panels)) {
      ExperimentSettings experiment =
          experiment_settings(std::max(1U, plan_.time.sequences / kShareForJoints));
      experiment.effects.panel_turn = angle_deg;
      outcome_.joint_angles_deg.push_back(angle_deg);
      outcome_.joint_cells.push_back(run_experiment(subject, experiment, [](std::uint64_t) {}).cells.front());
    }
  }

  void fly() {
    steps_.begin(kFlight);
    const std::string& folder = settings_.folder;
    std::vector<std::string> arguments{"simulate",
                                       "--mission",
                                       mission_.file,
                                       "--model",
                                       outcome_.model_path,
                                       "--sequences",
                                       std::to_string(kFlownSequences),
                                       "--json",
                                       folder + "/flight.json",
                                       "--report",
                                       folder + "/flight.html"};
    outcome_.flight.command = "tumblesight";
    for (const std::string& argument : arguments) {
      const bool spaced = argument.find(' ') != std::string::npos;
      outcome_.flight.command += spaced ? " '" + argument + "'" : " " + argument;
    }
    FlightProcess process(settings_.program, arguments, folder + "/flight.log");
    outcome_.flight.flown = process.wait_for_end(kLongestFlight_s);
    outcome_.flight.wrong = process.exit_status() == kMostlyWrong;
    outcome_.flight.well = process.ended_well() || outcome_.flight.wrong;
    steps_.say(outcome_.flight.well    ? fmt::format("{} sequences", kFlownSequences)
               : outcome_.flight.flown ? std::string("did not end well")
                                       : fmt::format("took longer than {:g} s", kLongestFlight_s));
  }

  // The verdict. A run that was stopped has none.
  void judge() {
    outcome_.steps = steps_.steps();
    outcome_.minutes_taken = steps_.elapsed_s() / 60.0;
    if (outcome_.stopped) {
      steps_.finish("Stopped. The same command goes on.");
      return;
    }
    outcome_.checks = goal_checks(mission_, outcome_.result);
    for (const GoalCheck& check : outcome_.checks)
      if (!check.met) outcome_.reasons.push_back(to_string(check));
    for (const std::string& reason : failing_conditions(outcome_.result)) outcome_.reasons.push_back(reason);
    judge_joints();
    const bool trained = !outcome_.model_path.empty();
    if (trained && !outcome_.flight.well)
      outcome_.reasons.push_back(
          fmt::format("the flight over DDS did not end well: see {}/flight.log", settings_.folder));
    if (outcome_.flight.wrong)
      outcome_.reasons.emplace_back(
          "in the flight over DDS more than half of the attitudes were more than 20° off");
    add_outlook();
    outcome_.go = trained && outcome_.reasons.empty();
    write_adoption_report(settings_, outcome_, mesh_);
    steps_.finish(outcome_.go ? "GO" : "NO-GO");
    outcome_.steps = steps_.steps();
    write_adoption_report(settings_, outcome_, mesh_);
  }

  void judge_joints() {
    for (std::size_t i = 0; i < outcome_.joint_cells.size(); ++i) {
      const ErrorSummary& network = outcome_.joint_cells[i].rcnn;
      if (network.count == 0 || network.within_20deg >= 0.5) continue;
      outcome_.reasons.push_back(
          fmt::format("nominal, panels at {:g}°: {:.1f} % of the network's attitudes are more than 20° off",
                      outcome_.joint_angles_deg[i], 100.0 * (1.0 - network.within_20deg)));
    }
  }

  void add_outlook() {
    const bool missed = std::any_of(outcome_.checks.begin(), outcome_.checks.end(),
                                    [](const GoalCheck& check) { return !check.met; });
    const std::optional<Outlook> outlook = outlook_of(outcome_.training);
    if (!missed || !outlook) return;
    for (const CellResult& cell : outcome_.result.cells) {
      outcome_.outlook.push_back(fmt::format(
          "{}: the network's mean error of {:.2f}° would be about {:.2f}° with twice the time, {:.2f}° "
          "with four times",
          to_string(cell.condition), cell.rcnn.mean_deg, cell.rcnn.mean_deg * outlook->error_factor(2.0),
          cell.rcnn.mean_deg * outlook->error_factor(4.0)));
    }
  }

  const AdoptionSettings& settings_;
  const Mission& mission_;
  const std::atomic<bool>& stop_;
  std::string plan_path_;
  std::optional<AdoptionPlan> found_plan_;
  AdoptionPlan plan_;
  TargetSymmetry symmetry_;
  AdoptionSteps steps_;
  AdoptionOutcome outcome_;
  TriangleMesh mesh_;
  TrainingTargets targets_;
  TrainingSettings training_;
  std::unique_ptr<ImageKeeper> keeper_;
  std::unique_ptr<Float32Model> network_;
};

}  // namespace

AdoptionOutcome adopt(const AdoptionSettings& settings, const std::atomic<bool>& stop) {
  return Adoption(settings, stop).run();
}

}  // namespace tumblesight::sim
