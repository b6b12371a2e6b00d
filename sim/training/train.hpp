// The two stages of training: first the single-frame CNN on endless fresh frames, then the LSTM and its head
// on the frozen CNN's features over whole sequences.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"
#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

struct TrainingSettings {
  std::string folder;      // checkpoints, log and model image go here
  std::string start_from;  // model image whose CNN training begins with; empty: random weights
  std::uint64_t seed = 1;
  int workers = 1;        // rendering threads
  bool bfloat16 = false;  // convolutions in bfloat16
  torch::Device device{torch::kCPU};
  double checkpoint_s = 180.0;  // wall-clock seconds between checkpoints

  std::int64_t cnn_images = 2'000'000;
  int cnn_batch = 64;
  double cnn_learning_rate = 1e-3;

  std::int64_t rcnn_sequences = 16'000;  // different ones
  std::int64_t rcnn_iterations = 4'000;
  int rcnn_batch = 128;
  double rcnn_learning_rate = 1e-3;
};

// Each stage resumes from the checkpoint in `settings.folder` if there is one and returns at once if it was
// finished. Both end early, after a checkpoint, when `stop` becomes true; they return whether the stage is
// finished.
bool train_cnn(const TrainingTargets& targets, const TrainingSettings& settings, Cnn& cnn,
               const std::atomic<bool>& stop);
bool train_rcnn(const TrainingTargets& targets, const TrainingSettings& settings, const Cnn& cnn,
                Recurrent& recurrent, const std::atomic<bool>& stop);

// Validation figures in degrees of a point of the log, from the errors of the best and of the chosen
// hypothesis.
void fill_errors(TrainingPoint& point, const torch::Tensor& best_rad, const torch::Tensor& chosen_rad);

}  // namespace tumblesight::sim
