// Checkpoint: module, optimiser and position of one stage in one file, replaced atomically.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace tumblesight::sim {

struct CheckpointPosition {
  std::int64_t iteration = 0;
  double seconds = 0.0;
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
  archive.save_to(path + ".new");
  std::filesystem::rename(path + ".new", path);
}

// False when there is no checkpoint; throws (c10::Error) when it is not one of this network.
template <typename Module>
bool load_checkpoint(const std::string& path, Module& module, torch::optim::Optimizer* optimizer,
                     CheckpointPosition& position) {
  if (!std::filesystem::exists(path)) return false;
  torch::serialize::InputArchive archive, module_archive, optimizer_archive;
  archive.load_from(path);
  archive.read("module", module_archive);
  module->load(module_archive);
  if (optimizer != nullptr) {
    archive.read("optimizer", optimizer_archive);
    optimizer->load(optimizer_archive);
  }
  torch::Tensor iteration, seconds;
  archive.read("iteration", iteration, true);
  archive.read("seconds", seconds, true);
  position = {iteration.item<std::int64_t>(), seconds.item<double>()};
  return true;
}

}  // namespace tumblesight::sim
