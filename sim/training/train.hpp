// The two stages of training: first the CNN on an endless stream of newly rendered frames, then the LSTM and
// the recurrent head on the frozen CNN's features over whole sequences. Described in docs/training.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/training/frame_stream.hpp"
#include "sim/training/ranks.hpp"
#include "sim/training/rcnn_module.hpp"
#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

struct TrainingSettings {
  std::string folder;      // for checkpoints, log and model images; must exist
  std::string start_from;  // model image whose CNN is the starting point; empty: random weights
  std::uint64_t seed = 1;
  int workers = 1;  // rendering threads
  // Threads of each rank that share its part of a batch: parts.hpp. Batches are multiples of ranks times
  // trainers.
  int trainers = 1;
  // The processes that train together. A checkpoint does not depend on their number, nor on that of trainers.
  std::shared_ptr<Ranks> ranks = std::make_shared<Ranks>();
  bool bfloat16 = false;  // convolutions in bfloat16
  torch::Device device{torch::kCPU};
  double checkpoint_s = 180.0;  // wall-clock seconds between checkpoints
  // Called after every validation, with the state of the network at that moment; `best`: its mean error is
  // the least of the stage so far.
  std::function<void(const TrainingPoint&, bool best)> after_point{};

  double cnn_seconds = 0.0;  // wall-clock time in place of cnn_images; 0: none
  std::int64_t cnn_images = 2'000'000;
  int cnn_batch = 64;
  double cnn_learning_rate = 1e-3;

  std::int64_t rcnn_sequences = 16'000;  // distinct sequences
  double rcnn_seconds = 0.0;             // wall-clock time in place of rcnn_iterations; 0: none
  std::int64_t rcnn_iterations = 4'000;
  int rcnn_batch = 128;
  double rcnn_learning_rate = 1e-3;
};

// Each stage resumes from the checkpoint in `settings.folder` if there is one, and returns at once if that
// stage was finished. When `stop` becomes true, it saves a checkpoint and returns. Returns whether the stage
// is finished. Throws std::runtime_error if a file cannot be read or written, or if a checkpoint or another
// rank is of other settings, and RankLost. With several ranks all call these functions together; rank 0 reads
// and writes the files of the folder.
bool train_cnn(const TrainingTargets& targets, const TrainingSettings& settings, Cnn& cnn,
               const std::atomic<bool>& stop);
bool train_rcnn(const TrainingTargets& targets, const TrainingSettings& settings, const Cnn& cnn,
                Recurrent& recurrent, const std::atomic<bool>& stop);

// Fills in the validation figures of a log point from the errors [N] of the best and of the chosen
// hypothesis.
void fill_errors(TrainingPoint& point, const torch::Tensor& best_rad, const torch::Tensor& chosen_rad);
// The same from pieces of the rank's share of N = `count` errors, together with those of the other ranks.
void fill_errors(TrainingPoint& point, Ranks& ranks, std::int64_t count,
                 const std::vector<torch::Tensor>& best_rad, const std::vector<torch::Tensor>& chosen_rad);

}  // namespace tumblesight::sim
