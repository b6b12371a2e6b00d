// FrameStream: batches of single rendered frames for training the CNN, made by worker threads while the
// network trains.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gnc/attitude/motion.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "sim/training/ranks.hpp"
#include "sim/training/training_conditions.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/sensor/sensor_description.hpp"

namespace tumblesight::sim {

// A set of effects that act together, and the surfaces that are seen with them.
struct EffectSet {
  EffectRanges effects{};
  std::vector<std::unique_ptr<FlashLidar>> lidars;  // one per mesh
};

// The surfaces of the target that one network is trained for, and how it sees them.
struct TrainingTargets {
  std::vector<EffectSet> effect_sets;  // drawn in turn; at least one
  gnc::DepthProjection projection;     // fits all meshes
  std::uint32_t meshes_crc32 = 0;      // identifies the surfaces
  std::vector<Condition> conditions;   // drawn in turn; may contain one more than once
  SensorDescription sensor{};          // that sees them
  RangeLimits ranges{};                // at which it sees them
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // in the TRF
  gnc::Inertia<float> inertia;                                  // the same, as the flight code takes it
  std::uint32_t mission_crc32 = 0;                              // of the image that is made; 0: no mission
};

// Throws std::runtime_error that names a mesh of which the sensor sees too little in most frames, and
// std::invalid_argument for an inertia that is not symmetric and positive definite, or as observed_bodies()
// does. `effect_sets` take turns, none: no effects. They change what the sensor sees, not the projection.
// `target`: key, for the effects on the body. `ranges_of`: the ranges for a swath in metres; none: the
// paper's.
TrainingTargets make_training_targets(const std::vector<TriangleMesh>& meshes,
                                      const std::vector<Condition>& conditions,
                                      const Eigen::Matrix3d& inertia_kg_m2 = Eigen::Matrix3d::Identity(),
                                      const std::vector<EffectRanges>& effect_sets = {},
                                      const std::string& target = {}, const SensorDescription& sensor = {},
                                      const std::function<RangeLimits(double)>& ranges_of = {});
// Hash of conditions, effects, sensor and ranges, for a checkpoint's fingerprint.
std::uint64_t view_hash(const TrainingTargets& targets);
// A scenario of so many frames, as the targets are seen with the effects.
ScenarioSettings scenario_of(const TrainingTargets& targets, Condition condition, const EffectRanges& effects,
                             int frames);

struct FrameBatch {
  torch::Tensor images;      // [B, 1, 100, 100], depth 0..1
  torch::Tensor r_view_trf;  // [B, 3, 3], attitude in the image's view frame
};

// An endless supply of batches, determined by the seed. Meshes, conditions and sets of effects are drawn in
// turn, the meshes fastest. A frame has strengths of its own within the ranges of its set. Each rendered
// group of frames gives four batches, one for each quarter turn about the view axis: the image is square, so
// that these are exact new views at no rendering cost.
class FrameStream {
 public:
  // `rows`: of each batch, and no others are rendered; none: all.
  FrameStream(const TrainingTargets& targets, std::uint64_t seed, int batch, std::uint64_t first_batch,
              int workers, std::optional<Share> rows = {});
  ~FrameStream();
  FrameBatch next();  // the next batch; the order does not depend on the number of workers

 private:
  void work();

  const TrainingTargets& targets_;
  const std::uint64_t seed_;
  const int batch_;
  const Share rows_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, FrameBatch> ready_;
  std::uint64_t claimed_;  // next group to render
  std::uint64_t wanted_;   // next batch to return
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

// Rows of group `group` of the same supply, rendered by the calling thread. Validation data uses another
// seed.
FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch,
                         Share rows);
// All of them.
FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch);
// The same frames, turned about the view axis counter-clockwise in the image.
FrameBatch turned(const FrameBatch& batch, std::int64_t quarter_turns);

}  // namespace tumblesight::sim
