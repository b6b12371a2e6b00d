#include "sim/training/frame_stream.hpp"

#include <algorithm>

#include "sim/scenario/random.hpp"
#include "sim/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kUses = 2;   // batches made of one rendered group: as it is, and turned
constexpr std::uint64_t kAhead = 8;  // batches rendered ahead of the consumer
constexpr int kSide = gnc::DepthImage::kSide;

// Buffers of one rendering thread.
struct Workspace {
  gnc::RangeImage frame;
  gnc::DepthImage image;
  gnc::DepthImageScratch scratch;
};

// Renders frame `index`; draws again in the rare case that the sensor sees too little to be used.
FrameTruth render(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t index, Workspace& work) {
  const auto& lidar = *targets.lidars[index % targets.lidars.size()];
  const Condition condition =
      (index / targets.lidars.size()) % 2 == 0 ? Condition::kNominal : Condition::kDegraded;
  for (std::uint64_t attempt = 0;; ++attempt) {
    const Sequence sequence = make_sequence(condition, mix(seed, attempt), index, 1);
    const FrameTruth& truth = sequence.frames.front();
    lidar.expose(truth, sensor_settings(condition), targets.projection.swath_m, sequence.noise_seed,
                 work.frame);
    if (make_depth_image(work.frame, targets.projection, work.scratch, work.image) == gnc::FrameStatus::kOk) {
      return truth;
    }
  }
}

// Turned a quarter about the boresight, counter-clockwise as the image is seen: (x, z) -> (-z, x).
torch::Tensor quarter_turn() {
  return torch::tensor({0.0F, 0.0F, -1.0F, 0.0F, 1.0F, 0.0F, 1.0F, 0.0F, 0.0F}).view({3, 3});
}

torch::Tensor rotation_tensor(const FrameTruth& truth) {
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = truth.q_lrf_trf.toRotationMatrix().cast<float>();
  return torch::from_blob(const_cast<float*>(r.data()), {3, 3}, torch::kFloat).clone();
}

}  // namespace

TrainingTargets make_training_targets(const std::vector<TriangleMesh>& meshes) {
  TrainingTargets targets;
  for (const TriangleMesh& mesh : meshes) {
    targets.lidars.push_back(std::make_unique<FlashLidar>(mesh));
    targets.projection.swath_m = std::max(targets.projection.swath_m, static_cast<float>(swath_m(mesh)));
    targets.projection.target_radius_m = std::max(targets.projection.target_radius_m, mesh.radius_m());
  }
  return targets;
}

FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch) {
  thread_local Workspace work;
  FrameBatch result{torch::empty({batch, 1, kSide, kSide}), torch::empty({batch, 3, 3})};
  for (int i = 0; i < batch; ++i) {
    const FrameTruth truth = render(targets, seed, group * batch + i, work);
    result.images[i].copy_(torch::from_blob(work.image.value.data(), {1, kSide, kSide}, torch::kFloat));
    result.r_lrf_trf[i].copy_(rotation_tensor(truth));
  }
  return result;
}

FrameBatch turned(const FrameBatch& batch, std::int64_t quarter_turns) {
  return {torch::rot90(batch.images, quarter_turns, {2, 3}).contiguous(),
          torch::matmul(torch::matrix_power(quarter_turn(), quarter_turns), batch.r_lrf_trf)};
}

FrameStream::FrameStream(const TrainingTargets& targets, std::uint64_t seed, int batch,
                         std::uint64_t first_batch, int workers)
    : targets_(targets), seed_(seed), batch_(batch), claimed_(first_batch / kUses), wanted_(first_batch) {
  for (int i = 0; i < workers; ++i) workers_.emplace_back([this] { work(); });
}

FrameStream::~FrameStream() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void FrameStream::work() {
  for (;;) {
    std::uint64_t group = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || claimed_ * kUses < wanted_ + kAhead; });
      if (stop_) return;
      group = claimed_++;
    }
    const FrameBatch batch = render_frames(targets_, seed_, group, batch_);
    FrameBatch second = turned(batch, 1 + static_cast<std::int64_t>(mix(seed_, group) % 3));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ready_.emplace(group * kUses, batch);
      ready_.emplace(group * kUses + 1, std::move(second));
    }
    changed_.notify_all();
  }
}

FrameBatch FrameStream::next() {
  FrameBatch batch;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return ready_.count(wanted_) != 0; });
    batch = std::move(ready_.at(wanted_));
    ready_.erase(wanted_++);
  }
  changed_.notify_all();
  return batch;
}

}  // namespace tumblesight::sim
