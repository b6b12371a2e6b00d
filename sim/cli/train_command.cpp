#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mesh_warnings.hpp"
#include "sim/cli/mission_arguments.hpp"
#include "sim/cli/quantize_and_report.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/surface/target_surface.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/join_ranks.hpp"
#include "sim/training/local_ranks.hpp"
#include "sim/training/mission_training.hpp"
#include "sim/training/rank_output.hpp"
#include "sim/training/stage.hpp"
#include "sim/training/train.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

std::atomic<bool> stop_requested{false};

struct TrainOptions {
  std::string target = default_target();
  MeshArguments meshes;
  std::vector<std::string> conditions = {"all"};
  Effects effects;
  std::vector<EffectRanges> effect_sets;  // in turn
  bool conditions_given = false, effects_given = false;
  SensorArguments sensor;
  std::string device = "auto";
  std::string precision = "auto";
  std::vector<double> inertia;  // six elements; empty: that of a known target
  std::optional<Mission> mission;
  int ranks = 1;
  bool ranks_given = false, workers_given = false;
  double rank_timeout_s = 120.0;
  double minutes = 0.0;  // of wall-clock time in place of numbers of samples; 0: none
  TrainingSettings settings;
};

Eigen::Matrix3d inertia_of(const TrainOptions& options, const TriangleMesh& mesh) {
  std::optional<Eigen::Matrix3d> inertia = known_inertia_kg_m2(options.target);
  if (!options.inertia.empty()) inertia = checked_inertia(options.inertia);
  if (inertia) {
    require_possible_inertia(*inertia, mesh.radius_m());
    return *inertia;
  }
  std::fprintf(
      stderr,
      "warning: the inertia of '%s' is not known, so the network learns the free rotation of a sphere, a "
      "constant spin; for a target that tumbles give --inertia, or a --mission with one\n",
      options.target.c_str());
  return Eigen::Matrix3d::Identity();
}

// The recurrent part needs about a sixth of the time to learn as well as the CNN.
constexpr double kShareOfRecurrentPart = 0.15;

void share_out_time(TrainOptions& options) {
  const double seconds = 60.0 * options.minutes;
  options.settings.rcnn_seconds = kShareOfRecurrentPart * seconds;
  options.settings.cnn_seconds = seconds - options.settings.rcnn_seconds;
}

void choose_device(TrainOptions& options) {
  const bool cuda = torch::cuda::is_available();
  if (options.device == "cuda" && !cuda) {
    throw std::runtime_error("--device cuda: this LibTorch finds no CUDA device; use --device cpu");
  }
  const bool use_cuda = cuda && options.device != "cpu";
  options.settings.device = torch::Device(use_cuda ? torch::kCUDA : torch::kCPU);
  options.settings.bfloat16 =
      options.precision == "bfloat16" || (options.precision == "auto" && (use_cuda || cpu_has_bfloat16()));
  if (!use_cuda) keep_to_one_thread();
}

// With fewer images than one batch and no CNN to start from, the weights would stay random.
void require_a_cnn(const TrainingSettings& settings) {
  if (!settings.start_from.empty() || settings.cnn_seconds > 0.0 || settings.cnn_images >= settings.cnn_batch)
    return;
  throw ArgumentFault("--cnn-images", "must be at least " + std::to_string(settings.cnn_batch) +
                                          " unless --start-from names a model image");
}

// The reference, and the image that flies.
void write_images(const std::string& stem, const std::vector<TriangleMesh>& meshes,
                  const TrainingTargets& targets, const std::unique_ptr<Float32Model>& model,
                  int sequences = kCalibrationSequences) {
  std::vector<EffectRanges> effect_sets;
  for (const auto& set : targets.effect_sets) effect_sets.push_back(set.effects);
  const ScenarioSettings seen = scenario_of(targets, Condition::kNominal, effect_sets.front(), 1);
  write_model_file<gnc::Float32>(stem + ".float32.tsm", model->header, model->weights);
  std::printf("Reference in float32: %s.float32.tsm\nFixed point, as it flies:\n", stem.c_str());
  const QuantizationReport report =
      quantize_and_report(*model, meshes, sequences, stem + ".tsm", seen, effect_sets);
  if (is_another_network(report.difference))
    fmt::print(
        stderr,
        "warning: the attitudes in fixed point are {:.1f}° (mean) from those in float32; a network that "
        "was not trained for long enough differs like this\n",
        report.difference.mean_deg);
}

// Those of --mission, unless their options are given.
std::vector<Condition> conditions_of(const TrainOptions& options) {
  if (options.mission && !options.conditions_given) return training_conditions(*options.mission);
  return training_conditions(options.conditions);
}

std::vector<EffectRanges> effect_sets_of(const TrainOptions& options) {
  if (options.mission && !options.effects_given) return training_effect_sets(*options.mission);
  return options.effect_sets.empty() ? std::vector<EffectRanges>{options.effects} : options.effect_sets;
}

// What identifies the training in its images: the mission, or one of the same content as the options.
Mission mission_of(const TrainOptions& options) {
  if (options.mission) return *options.mission;
  const Mission* known = find_target(options.target);
  Mission mission = known != nullptr ? *known : Mission{};
  mission.name = options.target;
  mission.mesh.file = options.meshes.meshes.front();
  mission.mesh.up = options.meshes.mesh_up;
  mission.mesh.scale = options.meshes.mesh_scale;
  const std::vector<double>& i = options.inertia;
  if (!i.empty()) mission.inertia = InertiaElements{i[0], i[1], i[2], i[3], i[4], i[5]};
  return mission;
}

TrainingTargets targets_of(const TrainOptions& options, const std::vector<TriangleMesh>& meshes) {
  const auto ranges = [&options](double swath_m) {
    std::vector<std::string> warnings;
    const RangeLimits limits = ranges_of(options.sensor, swath_m, warnings);
    for (const std::string& warning : warnings) std::printf("note: %s\n", warning.c_str());
    return limits;
  };
  return make_training_targets(meshes, conditions_of(options), inertia_of(options, meshes.front()),
                               effect_sets_of(options), options.target, options.sensor.sensor, ranges);
}

// Of the sensor's file in the folder it is enough that it is the one of --sensor: it is then left as it is.
void require_usable_folder(const TrainOptions& options, const std::string& stem) {
  const std::string& folder = options.settings.folder;
  require_folder("--out", folder);
  OptionFiles read = files_read(options.meshes, options.sensor);
  read.push_back({"--start-from", options.settings.start_from});
  OptionFiles written;
  for (const std::string& path : {stem + ".tsm", stem + ".float32.tsm", folder + "/log.csv",
                                  folder + "/curve.svg", folder + "/cnn.ckpt", folder + "/rcnn.ckpt"})
    written.push_back({"--out", path});
  if (!is_same_file(sensor_file_of(stem + ".tsm"), options.sensor.file))
    written.push_back({"--out", sensor_file_of(stem + ".tsm")});
  require_usable_files(read, written);
}

// The images of a run that was stopped: of the state that the checkpoint continues from.
void write_images_so_far(const std::string& stem, const std::vector<TriangleMesh>& meshes,
                         const TrainingTargets& targets, const TrainOptions& options, const Cnn& cnn,
                         Recurrent& recurrent, const std::optional<TrainingPoint>& latest) {
  constexpr int kQuickly = 20;  // sequences
  if (!latest) {
    std::printf("Stopped before the first validation: no model image is written.\n");
    return;
  }
  const bool trained = latest->stage == "rcnn";
  if (!trained) make_neutral(recurrent, kRadPerDeg * latest->mean_deg);
  std::printf("Model images of the network so far, for a look at it%s:\n",
              trained ? "" : " (its recurrent part is not trained yet)");
  write_images(stem, meshes, targets, model_of(cnn, recurrent, options.target, targets), kQuickly);
}

// Each part of a batch has the same number of rows.
void require_equal_parts(const TrainingSettings& settings, int ranks) {
  const int parts = ranks * settings.trainers;
  for (const int batch : {settings.cnn_batch, settings.rcnn_batch}) {
    if (batch % parts == 0) continue;
    throw ArgumentFault(
        "--ranks", fmt::format("{} ranks with {} trainers each do not divide a batch of {} without a "
                               "remainder; use ranks and trainers whose product is a power of two up to {}",
                               ranks, settings.trainers, batch, settings.cnn_batch));
  }
}

// The place among the ranks that a launcher has started; alone without one.
RankPlace place_of(const TrainOptions& options) {
  const RankPlace place = rank_place();
  if (place.count > 1 && options.ranks_given && options.ranks != place.count) {
    throw ArgumentFault(
        "--ranks", fmt::format("is {}, but this process was started as one of {} ranks (by Slurm, mpirun or "
                               "RANK and WORLD_SIZE); leave --ranks out",
                               options.ranks, place.count));
  }
  return place;
}

// Ranks on the same cores share them: of each rank's part one core is for its trainers.
int workers_of(int sharing_ranks) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / sharing_ranks - 1);
}

int train(TrainOptions& options) {
  if (options.minutes > 0.0) share_out_time(options);
  for (const EffectRanges& effects : effect_sets_of(options)) {
    require_the_target(effects.high);
    require_whole_scans(options.effect_sets.empty() ? "--effect" : "--effect-set", effects.high,
                        options.sensor.sensor);
  }
  require_a_cnn(options.settings);
  choose_device(options);
  // Beside the checkpoints and the images that follow.
  const std::string stem = options.settings.folder + "/" + options.target;
  require_usable_folder(options, stem);
  (void)check_sensor_of_model(stem + ".tsm", options.sensor.sensor);
  const std::vector<TriangleMesh> meshes = load_meshes(options.meshes, options.target);
  print_mesh_warnings(options.meshes, meshes);
  TrainingTargets targets = targets_of(options, meshes);
  targets.mission_crc32 = mission_crc32(mission_of(options));
  // Now rather than after hours of training: a mesh whose surface the image that flies cannot have.
  (void)target_surface(meshes.front(),
                       1e-3 * model_header(options.target, targets).projection.target_radius_mm);
  const bool leads = options.settings.ranks->leads();
  if (leads && !is_same_file(sensor_file_of(stem + ".tsm"), options.sensor.file))
    write_sensor_file(stem + ".tsm", options.sensor.sensor);
  print_sensor(options.sensor.sensor, targets.ranges);

  torch::manual_seed(options.settings.seed);
  Cnn cnn;
  Recurrent recurrent(targets.inertia);
  std::optional<TrainingPoint> latest;
  options.settings.after_point = [&latest](const TrainingPoint& point, bool) { latest = point; };
  const bool finished = train_cnn(targets, options.settings, cnn, stop_requested) &&
                        train_rcnn(targets, options.settings, cnn, recurrent, stop_requested);

  if (!leads) return finished ? 0 : kStopped;
  const std::string& folder = options.settings.folder;
  if (!finished) {
    write_images_so_far(stem, meshes, targets, options, cnn, recurrent, latest);
    std::printf("Stopped. The same command continues from the checkpoint in %s.\n", folder.c_str());
    return kStopped;
  }
  std::printf("Training finished. Log: %s/log.csv, error curve: curve.svg.\n", folder.c_str());
  write_images(stem, meshes, targets, model_of(cnn, recurrent, options.target, targets));
  return 0;
}

// As one of the ranks, or alone.
int train_as_rank(TrainOptions& options, const RankPlace& place) {
  // Before this there is nothing to save, and a signal ends the process also while it waits for the others.
  options.settings.ranks = join_ranks(place, options.settings.folder, options.rank_timeout_s);
  std::signal(SIGINT, [](int) { stop_requested = true; });
  std::signal(SIGTERM, [](int) { stop_requested = true; });
  if (place.count > 1 && !options.workers_given)
    options.settings.workers = workers_of(options.settings.ranks->sharing_cores());
  return train(options);
}

int start_training(TrainOptions& options) {
  const RankPlace place = place_of(options);
  const int ranks = std::max(place.count, options.ranks);
  require_equal_parts(options.settings, ranks);
  if (ranks > 1 && !can_have_several_ranks()) {
    throw ArgumentFault("--ranks",
                        "several ranks need a build with Gloo: install libgloo-dev, then configure "
                        "and build again");
  }
  if (ranks > place.count) return run_local_ranks(ranks);
  return run_quietly_unless_first(place.rank, [&] { return train_as_rank(options, place); });
}

void add_length_options(Command& command, TrainOptions& options) {
  TrainingSettings& settings = options.settings;
  limit_number(
      command.add_option("--cnn-rate", settings.cnn_learning_rate, "highest learning rate of the CNN"), 1e-6,
      1e-1)
      ->type_name("X")
      ->capture_default_str();
  limit_whole_number(
      command.add_option("--cnn-images", settings.cnn_images, "new images to train the CNN on"), 0,
      1'000'000'000)
      ->type_name("N")
      ->capture_default_str();
  limit_whole_number(command.add_option("--rcnn-sequences", settings.rcnn_sequences,
                                        "different sequences to train the LSTM on"),
                     16, 1'000'000)
      ->type_name("N")
      ->capture_default_str();
  limit_whole_number(command.add_option("--rcnn-iterations", settings.rcnn_iterations,
                                        "batches of sequences to train the LSTM on"),
                     1, 10'000'000)
      ->type_name("N")
      ->capture_default_str();
  CommandOption minutes =
      limit_number(
          command.add_option("--minutes", options.minutes,
                             "wall-clock minutes to train for, in place of numbers of images, sequences "
                             "and batches; ends early if nothing improves any more"),
          0.1, 100'000.0)
          ->type_name("X");
  for (const char* number : {"--cnn-images", "--rcnn-iterations"})
    minutes->excludes(command.get_option(number));
}

void add_rank_options(Command& command, TrainOptions& options) {
  limit_whole_number(
      command.add_option("--ranks", options.ranks,
                         "processes on this machine that train one network together; each has its own "
                         "trainers and rendering threads"),
      1, 64)
      ->type_name("N")
      ->capture_default_str();
  limit_number(command.add_option("--rank-timeout", options.rank_timeout_s,
                                  "seconds without an answer after which a rank counts as lost"),
               1.0, 86'400.0)
      ->type_name("X")
      ->capture_default_str();
}

void add_machine_options(Command& command, TrainOptions& options) {
  TrainingSettings& settings = options.settings;
  limit_whole_number(
      command.add_option("--trainers", settings.trainers,
                         "threads that share the batches, beside the rendering ones: 1, 2, 4, 8"),
      1, 8)
      ->check(one_of({"1", "2", "4", "8"}))
      ->type_name("N")
      ->capture_default_str();
  limit_number(command.add_option("--checkpoint-seconds", settings.checkpoint_s,
                                  "wall-clock seconds between checkpoints"),
               0.0, 3600.0)
      ->type_name("X")
      ->capture_default_str();
  limit_whole_number(command.add_option("--workers", settings.workers, "rendering threads"), 1, 256)
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--device", options.device, "device to train on")
      ->check(one_of({"auto", "cpu", "cuda"}))
      ->type_name("auto|cpu|cuda")
      ->capture_default_str();
  command.add_option("--precision", options.precision, "precision of the convolutions in training")
      ->check(one_of({"auto", "float32", "bfloat16"}))
      ->type_name("auto|float32|bfloat16")
      ->capture_default_str();
}

}  // namespace

void add_train_command(Command& app, const std::string&) {
  auto options = std::make_shared<TrainOptions>();
  TrainingSettings& settings = options->settings;
  settings.workers = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
  Command command = add_verb(app, "train");
  command.footer(
      "\nA run may be interrupted at any time: the same command continues from the last\n"
      "checkpoint, and the exit status is 3. Several processes train together with\n"
      "--ranks, by srun or mpirun: docs/training.md.\n\n"
      "Example: train for NEAR Shoemaker on the shipped mesh and on a CAD file\n"
      "  tumblesight train --target near_shoemaker --mesh parametric --mesh near.stl \\\n"
      "      --out out/near\n");
  add_target_option(command, options->target, TargetChoice::kAny);
  add_mesh_options(command, options->meshes);
  add_inertia_option(command, options->inertia);
  add_mission_option(command, options->target, options->meshes, options->sensor, options->mission);
  add_seed_option(command, settings.seed);
  command.add_option("--out", settings.folder, "folder for checkpoints, log, error curve and model images")
      ->required()
      ->check(file_path())
      ->type_name("DIR");
  command
      .add_option(
          "--condition,--conditions", options->conditions,
          "conditions to train on in turn: all, paper (nominal and degraded), names, or a list of these; "
          "all,degraded has more degraded frames than all")
      ->delimiter(',')
      ->check(one_of(training_condition_words()))
      ->type_name("NAMES")
      ->capture_default_str();
  add_sensor_options(command, options->sensor);
  add_effect_option(command, options->effects);
  add_effect_set_option(command, options->effect_sets);
  command
      .add_option("--start-from", settings.start_from,
                  "model image whose CNN to start from; that of another target saves most of the time")
      ->check(existing_model_image())
      ->type_name("FILE");
  add_length_options(command, *options);
  add_machine_options(command, *options);
  add_rank_options(command, *options);
  command.callback([options, command] {
    require_a_name(command, options->meshes.meshes);
    options->conditions_given = command.count("--condition") > 0;
    options->effects_given = command.count("--effect") > 0 || command.count("--effect-set") > 0;
    options->ranks_given = command.count("--ranks") > 0;
    options->workers_given = command.count("--workers") > 0;
    throw Exit(start_training(*options));
  });
}

}  // namespace tumblesight::sim
