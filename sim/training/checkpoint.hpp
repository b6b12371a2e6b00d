// Checkpoint file of one stage: module, optimizer and position. Replaced atomically.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {

struct CheckpointPosition {
  std::int64_t iteration = 0;
  double seconds = 0.0;
  double skipped = 0.0;           // share of the stage that an early end left out
  double least_mean_deg = 180.0;  // validation error of the best point so far
  double fraction_of_best = 0.0;  // of the stage, when it was reached
  std::int64_t fingerprint = 0;   // hash of all settings that affect the result: fingerprint() in stage.hpp
};

// Writes a temporary file and renames it: if the process is killed, either the old or the new checkpoint is
// intact.
template <typename Module>
void save_checkpoint(const std::string& path, const Module& module, const torch::optim::Optimizer& optimizer,
                     const CheckpointPosition& position) {
  torch::serialize::OutputArchive archive, module_archive, optimizer_archive;
  module->save(module_archive);
  optimizer.save(optimizer_archive);
  archive.write("module", module_archive);
  archive.write("optimizer", optimizer_archive);
  archive.write("iteration", torch::tensor(position.iteration), true);
  archive.write("seconds", torch::tensor(position.seconds, torch::kDouble), true);
  archive.write(
      "course",
      torch::tensor({position.skipped, position.least_mean_deg, position.fraction_of_best}, torch::kDouble),
      true);
  archive.write("fingerprint", torch::tensor(position.fingerprint), true);
  archive.save_to(path + ".new");
  std::filesystem::rename(path + ".new", path);
}

// The file's content; empty if there is no checkpoint.
inline std::string read_checkpoint(const std::string& path) {
  if (!std::filesystem::exists(path)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  return content.empty() ? "empty" : content;
}

// Restores all arguments from read_checkpoint(path). Returns false if there was none. Throws
// std::runtime_error that names the file if it is no checkpoint or if its fingerprint differs from
// position.fingerprint: continuing would mix two runs.
template <typename Module>
bool load_checkpoint(const std::string& path, const std::string& content, Module& module,
                     torch::optim::Optimizer& optimizer, CheckpointPosition& position) {
  if (content.empty()) return false;
  torch::serialize::InputArchive archive, module_archive, optimizer_archive;
  torch::Tensor iteration, seconds, fingerprint;
  try {
    std::istringstream file(content);
    archive.load_from(file);
    archive.read("fingerprint", fingerprint, true);
    archive.read("iteration", iteration, true);
    archive.read("seconds", seconds, true);
    archive.read("module", module_archive);
    archive.read("optimizer", optimizer_archive);
  } catch (const c10::Error&) {
    throw std::runtime_error(
        path +
        " is not a checkpoint of this program; choose another --out, or delete the file to start again");
  }
  if (fingerprint.item<std::int64_t>() != position.fingerprint) {
    throw std::runtime_error(path +
                             " belongs to a training with other settings (meshes, target, conditions, "
                             "effects, sensor, ranges, seed, rates, precision, numbers of samples); "
                             "choose another --out, or repeat the command that made it");
  }
  module->load(module_archive);
  optimizer.load(optimizer_archive);
  position.iteration = iteration.item<std::int64_t>();
  position.seconds = seconds.item<double>();
  // Checkpoints from before there was a time of a stage do not have it.
  if (torch::Tensor course; archive.try_read("course", course, true)) {
    position.skipped = course[0].item<double>();
    position.least_mean_deg = course[1].item<double>();
    position.fraction_of_best = course[2].item<double>();
  }
  return true;
}

}  // namespace tumblesight::sim
