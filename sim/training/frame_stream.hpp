// FrameStream: batches of single rendered frames, made by worker threads while the network trains.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gnc/attitude/motion.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

// The targets' surfaces that one network is trained for, and how it sees them.
struct TrainingTargets {
  std::vector<std::unique_ptr<FlashLidar>> lidars;  // one a mesh
  gnc::DepthProjection projection;
  std::uint32_t meshes_crc32 = 0;     // names the surfaces
  std::vector<Condition> conditions;  // that take turns; one may be there more than once
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // in the TRF
  gnc::Inertia<float> inertia;                                  // the same, as the flight code takes it
};
// What the shipped networks are trained on, and the paper's rule: nominal and degraded frames only.
std::vector<Condition> all_conditions();
std::vector<Condition> paper_conditions();
// By words, one after the other: "all", "paper", or the name of a condition, which for the command line is
// any but stress: that is for tests only. Throws std::invalid_argument for what is none.
std::vector<std::string> training_condition_words();
std::vector<Condition> training_conditions(const std::vector<std::string>& words);
std::uint64_t number_of(const std::vector<Condition>& conditions);  // names them, for a fingerprint

// Throws std::runtime_error that names a mesh of which the sensor never sees enough, and
// std::invalid_argument for an impossible inertia.
TrainingTargets make_training_targets(const std::vector<TriangleMesh>& meshes,
                                      const std::vector<Condition>& conditions,
                                      const Eigen::Matrix3d& inertia_kg_m2 = Eigen::Matrix3d::Identity());

struct FrameBatch {
  torch::Tensor images;      // [B, 1, 100, 100]
  torch::Tensor r_view_trf;  // [B, 3, 3], in the images' view
};

// The endless, seeded supply. Meshes and conditions take turns. Each rendered group of
// frames gives four batches, turned about the view axis by quarter turns: exact new views for free, since the
// image is square.
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
// The same frames turned about the view axis, counter-clockwise as the image is seen.
FrameBatch turned(const FrameBatch& batch, std::int64_t quarter_turns);

}  // namespace tumblesight::sim
