#include "sim/training/sequence_features.hpp"

#include <algorithm>
#include <memory>

#include "gnc/rcnn/network_shape.hpp"
#include "sim/scenario/random.hpp"
#include "sim/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kFrames = kFramesPerSequence;

// Buffers of one worker.
struct Workspace {
  explicit Workspace(const gnc::NetworkWeights& weights) { network.weights() = weights; }
  gnc::RangeImage frame;
  gnc::DepthImage image;
  gnc::DepthImageScratch scratch;
  gnc::Network network;
  gnc::LstmState lstm;
  gnc::OutputVector single, recurrent;
};

// One sequence into row `index` of `all`; false when the sensor saw too little in one of its frames.
bool compute(const TrainingTargets& targets, std::uint64_t seed, std::int64_t index, Workspace& work,
             FeatureSet& all) {
  const auto number = static_cast<std::uint64_t>(index);
  const auto& lidar = *targets.lidars[number % targets.lidars.size()];
  const Condition condition =
      (number / targets.lidars.size()) % 2 == 0 ? Condition::kNominal : Condition::kDegraded;
  const Sequence sequence = make_sequence(condition, seed, number, kFrames);
  float* dense2 = all.dense2.data_ptr<float>() + index * kFrames * shape::kDense2;
  float* output = all.output.data_ptr<float>() + index * kFrames * shape::kOutput;
  work.lstm = {};
  float* rotation = all.r_lrf_trf.data_ptr<float>() + index * kFrames * 9;
  for (int k = 0; k < kFrames; ++k) {
    const FrameTruth& truth = sequence.frames[k];
    lidar.expose(truth, sensor_settings(condition), targets.projection.swath_m,
                 mix(sequence.noise_seed, static_cast<std::uint64_t>(k)), work.frame);
    if (make_depth_image(work.frame, targets.projection, work.scratch, work.image) != gnc::FrameStatus::kOk)
      return false;
    work.network.infer(work.image, work.lstm, work.single, work.recurrent);
    dense2 = std::copy(work.network.dense2_output().begin(), work.network.dense2_output().end(), dense2);
    output = std::copy(work.single.begin(), work.single.end(), output);
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = truth.q_lrf_trf.toRotationMatrix().cast<float>();
    rotation = std::copy(r.data(), r.data() + 9, rotation);
  }
  return true;
}

}  // namespace

SequenceFeatures::SequenceFeatures(const TrainingTargets& targets, const gnc::NetworkWeights& weights,
                                   std::uint64_t seed, std::int64_t count, int workers)
    : targets_(targets),
      weights_(weights),
      seed_(seed),
      count_(count),
      all_{torch::empty({count, kFrames, shape::kDense2}), torch::empty({count, kFrames, shape::kOutput}),
           torch::empty({count, kFrames, 3, 3})},
      done_(static_cast<std::size_t>(count), false) {
  for (int i = 0; i < workers; ++i) workers_.emplace_back([this] { work(); });
}

SequenceFeatures::~SequenceFeatures() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  for (std::thread& worker : workers_) worker.join();
}

void SequenceFeatures::work() {
  const auto work = std::make_unique<Workspace>(weights_);
  for (;;) {
    std::int64_t index = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stop_ || claimed_ == count_) return;
      index = claimed_++;
    }
    for (std::uint64_t attempt = 0; !compute(targets_, mix(seed_, attempt), index, *work, all_); ++attempt) {
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_[static_cast<std::size_t>(index)] = true;
      while (prefix_ < count_ && done_[static_cast<std::size_t>(prefix_)]) ++prefix_;
    }
    changed_.notify_all();
  }
}

FeatureSet SequenceFeatures::first(std::int64_t count) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return prefix_ >= count; });
  return {all_.dense2.narrow(0, 0, count), all_.output.narrow(0, 0, count),
          all_.r_lrf_trf.narrow(0, 0, count)};
}

}  // namespace tumblesight::sim
