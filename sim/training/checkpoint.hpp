// Checkpoint: module, optimiser and position of one stage in one file, replaced atomically.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {

struct CheckpointPosition {
  std::int64_t iteration = 0;
  double seconds = 0.0;
  std::int64_t fingerprint = 0;  // of all settings that shape the result
};

// Written beside the old one and renamed over it: a kill at any moment leaves one of the two whole.
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
  archive.write("fingerprint", torch::tensor(position.fingerprint), true);
  archive.save_to(path + ".new");
  std::filesystem::rename(path + ".new", path);
}

// False when there is no checkpoint. Throws std::runtime_error when it cannot be read, or is of a run with
// other settings: going on with those would silently mix two runs.
template <typename Module>
bool load_checkpoint(const std::string& path, Module& module, torch::optim::Optimizer& optimizer,
                     CheckpointPosition& position) {
  if (!std::filesystem::exists(path)) return false;
  torch::serialize::InputArchive archive, module_archive, optimizer_archive;
  torch::Tensor iteration, seconds, fingerprint;
  try {
    archive.load_from(path);
    archive.read("fingerprint", fingerprint, true);
    archive.read("iteration", iteration, true);
    archive.read("seconds", seconds, true);
    archive.read("module", module_archive);
    archive.read("optimizer", optimizer_archive);
  } catch (const c10::Error&) {
    throw std::runtime_error(
        path + ": not a checkpoint of this program; choose another --out, or delete the file to start anew");
  }
  if (fingerprint.item<std::int64_t>() != position.fingerprint) {
    throw std::runtime_error(
        path +
        ": of a training with other settings (meshes, seed, amounts); choose another --out, "
        "or repeat the command that made it");
  }
  module->load(module_archive);
  optimizer.load(optimizer_archive);
  position.iteration = iteration.item<std::int64_t>();
  position.seconds = seconds.item<double>();
  return true;
}

}  // namespace tumblesight::sim
