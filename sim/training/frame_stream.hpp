// FrameStream: batches of single rendered frames, made by worker threads while the network trains.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "sim/lidar/flash_lidar.hpp"

namespace tumblesight::sim {

// The targets' surfaces that one network is trained for, and how it sees them.
struct TrainingTargets {
  std::vector<std::unique_ptr<FlashLidar>> lidars;  // one a mesh
  gnc::DepthProjection projection;
  std::uint32_t meshes_crc32 = 0;  // names the surfaces
};
// Throws std::runtime_error that names a mesh of which the sensor never sees enough.
TrainingTargets make_training_targets(const std::vector<TriangleMesh>& meshes);

struct FrameBatch {
  torch::Tensor images;     // [B, 1, 100, 100]
  torch::Tensor r_lrf_trf;  // [B, 3, 3]
};

// The endless, seeded supply. Meshes and conditions (nominal, degraded) take turns. Each rendered group of
// frames gives two batches: as it is, and turned about the boresight by quarter turns, which are exact new
// views for free, since the image is square and the boresight its axis.
class FrameStream {
 public:
  FrameStream(const TrainingTargets& targets, std::uint64_t seed, int batch, std::uint64_t first_batch,
              int workers);
  ~FrameStream();
  FrameBatch next();  // in order, whatever the number of workers

 private:
  void work();

  const TrainingTargets& targets_;
  const std::uint64_t seed_;
  const int batch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, FrameBatch> ready_;
  std::uint64_t claimed_;  // next group to render
  std::uint64_t wanted_;   // next batch to hand out
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

// Group `group` of the supply, without threads (validation data: another seed).
FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch);
// The same frames turned about the boresight, counter-clockwise as the image is seen.
FrameBatch turned(const FrameBatch& batch, std::int64_t quarter_turns);

}  // namespace tumblesight::sim
