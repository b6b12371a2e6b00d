// SequenceFeatures: what the frozen CNN says of whole rendered sequences: the LSTM's training data. Computed
// by worker threads with the flight network itself, so that the LSTM learns on the very numbers it will see
// in flight.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "gnc/rcnn/network.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

inline constexpr int kTrainingFrames =
    12;  // longer than the paper's sequences: in flight there is no last frame

struct FeatureSet {
  SequenceHypotheses hypotheses;
  torch::Tensor r_lrf_trf;  // [N, T, 3, 3] the truth
};
FeatureSet first_of(const FeatureSet& data, std::int64_t count);
FeatureSet rows_of(const FeatureSet& data, const torch::Tensor& rows, const torch::Device& device);

class SequenceFeatures {
 public:
  // Starts to compute sequences 0 .. count-1 of the seeded supply; meshes and conditions take
  // turns, and so do the laws of the rate; of the bodies that tumble, every
  // second has another inertia than the target, lest the network trust it blindly. `weights` must outlive
  // this object.
  SequenceFeatures(const TrainingTargets& targets, const gnc::NetworkWeights<gnc::Float32>& weights,
                   std::uint64_t seed, std::int64_t count, int workers);
  ~SequenceFeatures();

  std::int64_t ready();  // how many, from the first one on
  // The first `count` sequences, waiting until they are there.
  FeatureSet first(std::int64_t count);

 private:
  void work();
  const TrainingTargets& targets_;
  const gnc::NetworkWeights<gnc::Float32>& weights_;
  const std::uint64_t seed_;
  const std::int64_t count_;
  FeatureSet all_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<bool> done_;
  std::int64_t claimed_ = 0;
  std::int64_t prefix_ = 0;  // sequences 0 .. prefix-1 are done
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace tumblesight::sim
