// SequenceFeatures: the output of the frozen CNN for whole rendered sequences, which is the training data of
// the LSTM. Worker threads compute it with the flight network, so that the LSTM is trained on the same
// numbers as in flight.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gnc/rcnn/network.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Longer than the paper's sequences, because flight does not end after ten frames.
inline constexpr int kTrainingFrames = 12;

struct FeatureSet {
  SequenceHypotheses hypotheses;
  torch::Tensor r_lrf_trf;  // [N, T, 3, 3], true attitudes
};
// The first `count` sequences, without a copy.
FeatureSet first_of(const FeatureSet& data, std::int64_t count);
// The given sequences, copied to `device`.
FeatureSet rows_of(const FeatureSet& data, const torch::Tensor& rows, const torch::Device& device);

class SequenceFeatures {
 public:
  // Starts to compute sequences 0 .. count-1 of the seed. Meshes, conditions, distributions of the rate and
  // sets of effects are drawn in turn. A sequence keeps the strengths that it draws within the ranges of its
  // set. Half of the tumbling bodies have a random inertia instead of the target's, so that the network does
  // not rely on it. Half of the sequences come in the sensor's period, the others at other times or with
  // single frames lost. Several ranks take turns, too: each sequence is computed by one of them. `targets`
  // and `weights` must outlive this object.
  SequenceFeatures(const TrainingTargets& targets, const gnc::NetworkWeights<gnc::Float32>& weights,
                   std::uint64_t seed, std::int64_t count, int workers,
                   std::shared_ptr<Ranks> ranks = std::make_shared<Ranks>());
  ~SequenceFeatures();

  // Number of sequences, from the first one, of which none that this rank computes is missing.
  std::int64_t ready();
  // The first `count` sequences. Waits until they are computed. All ranks call it together.
  FeatureSet first(std::int64_t count);

 private:
  void work();
  void pass_over_done();
  void exchange_until(std::int64_t count);
  const TrainingTargets& targets_;
  const gnc::NetworkWeights<gnc::Float32>& weights_;
  const std::uint64_t seed_;
  const std::int64_t count_;
  const std::shared_ptr<Ranks> ranks_;
  FeatureSet all_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<bool> done_;      // or computed by another rank
  std::int64_t claimed_;        // the next sequence to compute
  std::int64_t prefix_ = 0;     // sequences 0 .. prefix-1 are done
  std::int64_t exchanged_ = 0;  // of sequences 0 .. exchanged-1 those of the other ranks are here, too
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace tumblesight::sim
