#include "sim/cli/train_command.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sim/target/mesh_file.hpp"
#include "sim/target/targets.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/train.hpp"

namespace tumblesight::sim {
namespace {

std::atomic<bool> stop_requested{false};

struct TrainOptions {
  std::string target = "near_shoemaker";
  std::vector<std::string> meshes{"parametric"};
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
  std::string device = "auto";
  std::string precision = "auto";
  TrainingSettings settings;
};

// Whether bfloat16 convolutions are worth it: oneDNN has fast ones for these x86 extensions.
bool cpu_has_bfloat16() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("flags", 0) == 0) {
      return line.find("avx512_bf16") != std::string::npos || line.find("amx_bf16") != std::string::npos;
    }
  }
  return false;
}

TriangleMesh mesh_from(const TrainOptions& options, const std::string& name) {
  if (name == "parametric") return target_by_name(options.target);
  MeshFileOptions file;
  file.up = mesh_up_from(options.mesh_up);
  file.scale = options.mesh_scale;
  return load_mesh_file(name, file);
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
  // One thread a process: with rendering beside it, more of LibTorch's own threads only wait for each other.
  if (!use_cuda) at::set_num_threads(1);
}

int train(TrainOptions& options) {
  choose_device(options);
  std::filesystem::create_directories(options.settings.folder);
  std::signal(SIGINT, [](int) { stop_requested = true; });
  std::signal(SIGTERM, [](int) { stop_requested = true; });

  std::vector<TriangleMesh> meshes;
  for (const std::string& name : options.meshes) meshes.push_back(mesh_from(options, name));
  const TrainingTargets targets = make_training_targets(meshes);

  torch::manual_seed(options.settings.seed);
  Cnn cnn;
  Recurrent recurrent;
  const bool finished = train_cnn(targets, options.settings, cnn, stop_requested) &&
                        train_rcnn(targets, options.settings, cnn, recurrent, stop_requested);

  const std::string path = options.settings.folder + "/" + options.target + ".tsm";
  const auto weights = std::make_unique<gnc::NetworkWeights>();
  export_weights(cnn, recurrent, *weights);
  write_model_file(path, options.target, targets.projection, *weights);
  std::printf("%s\n  model image    %s\n  training log   %s/log.csv\n  loss curve     %s/curve.svg\n",
              finished ? "Training finished." : "Stopped; the same command goes on from the checkpoint.",
              path.c_str(), options.settings.folder.c_str(), options.settings.folder.c_str());
  return finished ? 0 : 3;
}

}  // namespace

void add_train_command(CLI::App& app) {
  auto options = std::make_shared<TrainOptions>();
  TrainingSettings& settings = options->settings;
  settings.workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency() - 1));
  CLI::App* command = app.add_subcommand("train", "Train a network for a target and write its model image");
  command->footer(
      "Example: train NEAR on the shipped model and on a CAD file at once\n"
      "  tumblesight train --target near_shoemaker --mesh parametric --mesh near.stl --out out/near\n"
      "Kill it at any time: the same command goes on from the last checkpoint.");
  command->add_option("--target", options->target, "Target that the model image is for")
      ->capture_default_str();
  command
      ->add_option("--mesh", options->meshes,
                   "Surface to train on: a CAD file, or 'parametric' for the shipped one; may be repeated")
      ->capture_default_str();
  command->add_option("--mesh-up", options->mesh_up, "Axis that points up in the files")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  command->add_option("--mesh-scale", options->mesh_scale, "Metres to a unit of the files")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "Seed of data and weights")->capture_default_str();
  command->add_option("--out", settings.folder, "Folder of checkpoints, log, curve and model image")
      ->required();
  command->add_option("--cnn-images", settings.cnn_images, "Fresh images for the single-frame network")
      ->check(CLI::Range(std::int64_t{64}, std::int64_t{1'000'000'000}))
      ->capture_default_str();
  command->add_option("--rcnn-sequences", settings.rcnn_sequences, "Different sequences for the LSTM")
      ->check(CLI::Range(std::int64_t{16}, std::int64_t{1'000'000}))
      ->capture_default_str();
  command->add_option("--rcnn-iterations", settings.rcnn_iterations, "Batches of sequences for the LSTM")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{10'000'000}))
      ->capture_default_str();
  command->add_option("--checkpoint-seconds", settings.checkpoint_s, "Wall-clock seconds between checkpoints")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command->add_option("--workers", settings.workers, "Rendering threads")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_option("--device", options->device, "Where to train")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  command->add_option("--precision", options->precision, "Of the convolutions while training")
      ->check(CLI::IsMember({"auto", "float32", "bfloat16"}))
      ->capture_default_str();
  command->callback([options] { throw CLI::RuntimeError(train(*options)); });
}

}  // namespace tumblesight::sim
