#include "sim/training/frame_stream.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"
#include "sim/training/stage.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kUses = 4;   // batches per rendered group: one for each quarter turn
constexpr std::uint64_t kAhead = 8;  // batches rendered ahead of the consumer
constexpr int kSide = gnc::DepthImage::kSide;

// Buffers of one rendering thread.
struct Workspace {
  gnc::RangeImage frame;
  gnc::DepthImage image;
  gnc::DepthImageScratch scratch;
};

// Renders frame `index` of a seed. False if the sensor sees too little of the target.
bool try_render(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t index, Workspace& work,
                FrameTruth& truth) {
  const std::uint64_t meshes = targets.effect_sets.front().lidars.size();
  const std::uint64_t conditions = targets.conditions.size();
  const EffectSet& seen = targets.effect_sets[index / (meshes * conditions) % targets.effect_sets.size()];
  const FlashLidar& lidar = *seen.lidars[index % meshes];
  const Condition condition = targets.conditions[index / meshes % conditions];
  const Sequence sequence = make_sequence(scenario_of(targets, condition, seen.effects, 1), seed, index);
  truth = sequence.frames.front();
  FrameRenderer(lidar, 1e-3 * targets.projection.swath_mm, noise_seed_per_sequence)
      .render(sequence, 0, work.frame);
  return make_depth_image(work.frame, targets.projection, work.scratch, work.image) == gnc::FrameStatus::kOk;
}

// Renders frame `index`. In the rare case that the sensor sees too little it is drawn again from another
// seed. The loop ends, because make_training_targets has checked that every target is visible.
FrameTruth render(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t index, Workspace& work) {
  FrameTruth truth;
  for (std::uint64_t attempt = 0; !try_render(targets, mix(seed, attempt), index, work, truth); ++attempt) {
  }
  return truth;
}

// The index of try `i` with a set of effects and a mesh: the conditions take turns.
std::uint64_t index_of_try(const TrainingTargets& targets, std::uint64_t set, std::uint64_t mesh,
                           std::uint64_t i) {
  const std::uint64_t conditions = targets.conditions.size();
  const std::uint64_t turn = i / conditions * targets.effect_sets.size() + set;
  return (turn * conditions + i % conditions) * targets.effect_sets.front().lidars.size() + mesh;
}

// Requires that at least half of a few dozen frames of a mesh can be used with a set of effects.
void require_visible(const TrainingTargets& targets, std::uint64_t set, std::uint64_t mesh,
                     const std::string& name, Workspace& work) {
  constexpr std::uint64_t kTries = 32;
  std::uint64_t seen = 0;
  FrameTruth truth;
  for (std::uint64_t i = 0; i < kTries; ++i)
    seen += try_render(targets, 1, index_of_try(targets, set, mesh, i), work, truth);
  if (2 * seen >= kTries) return;
  const std::string effects = to_string(targets.effect_sets[set].effects);
  throw std::runtime_error(
      name + (effects.empty() ? "" : " with " + effects) + ": the sensor sees too little of it (fewer than " +
      std::to_string(gnc::kMinReturns) + " returns) in " + std::to_string(kTries - seen) + " of " +
      std::to_string(kTries) + " frames; " +
      (effects.empty() ? "is the surface complete and in metres?"
                       : "is the surface complete and in metres, or an effect too strong?"));
}

EffectSet effect_set(const EffectRanges& effects, const std::string& target,
                     const std::vector<TriangleMesh>& meshes) {
  EffectSet set{effects, {}};
  for (const TriangleMesh& mesh : meshes)
    set.lidars.push_back(std::make_unique<FlashLidar>(observed_bodies(effects, target, mesh)));
  return set;
}

std::uint32_t crc32_of(const std::vector<TriangleMesh>& meshes) {
  gnc::Crc32 crc;
  for (const TriangleMesh& mesh : meshes) {
    for (const Eigen::Vector3f& v : mesh.vertices_trf_m) crc.add_f32(v.data(), 3);
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) crc.add_u32(index);
    }
  }
  return crc.value();
}

// The thread that trains has the core first: rendering is ahead of it, and other ranks wait for the slowest.
void give_way() {
  constexpr int kNice = 10;
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

// Rotation by a quarter turn about the view axis, counter-clockwise in the image: (x, z) -> (-z, x).
torch::Tensor quarter_turn() {
  return torch::tensor({0.0F, 0.0F, -1.0F, 0.0F, 1.0F, 0.0F, 1.0F, 0.0F, 0.0F}).view({3, 3});
}

torch::Tensor image_tensor(const gnc::DepthImage& image) {
  torch::Tensor tensor = torch::empty({1, kSide, kSide});
  float* to = tensor.data_ptr<float>();
  for (const std::uint16_t depth : image.depth) *to++ = static_cast<float>(depth) / 65536.0F;
  return tensor;
}

torch::Tensor rotation_tensor(const FrameTruth& truth, const Eigen::Matrix3f& r_lrf_view) {
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r =
      r_lrf_view.transpose() * truth.q_lrf_trf.toRotationMatrix().cast<float>();
  return torch::from_blob(const_cast<float*>(r.data()), {3, 3}, torch::kFloat).clone();
}

}  // namespace

TrainingTargets make_training_targets(const std::vector<TriangleMesh>& meshes,
                                      const std::vector<Condition>& conditions,
                                      const Eigen::Matrix3d& inertia_kg_m2,
                                      const std::vector<EffectRanges>& effect_sets, const std::string& target,
                                      const SensorDescription& sensor,
                                      const std::function<RangeLimits(double)>& ranges_of) {
  TrainingTargets targets;
  targets.inertia_kg_m2 = inertia_kg_m2;
  if (!gnc::make_inertia<float>(inertia_kg_m2.cast<float>(), targets.inertia)) {
    throw std::invalid_argument("the target's inertia is not symmetric and positive definite");
  }
  targets.conditions = conditions;
  targets.sensor = sensor;
  for (const TriangleMesh& mesh : meshes) {
    const gnc::DepthProjection of_mesh = projection_of(mesh);
    targets.projection.swath_mm = std::max(targets.projection.swath_mm, of_mesh.swath_mm);
    targets.projection.target_radius_mm =
        std::max(targets.projection.target_radius_mm, of_mesh.target_radius_mm);
  }
  if (ranges_of) targets.ranges = ranges_of(1e-3 * targets.projection.swath_mm);
  targets.meshes_crc32 = crc32_of(meshes);
  for (const EffectRanges& effects : effect_sets)
    targets.effect_sets.push_back(effect_set(effects, target, meshes));
  if (effect_sets.empty()) targets.effect_sets.push_back(effect_set({}, target, meshes));
  const auto work = std::make_unique<Workspace>();
  for (std::size_t set = 0; set < targets.effect_sets.size(); ++set) {
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh)
      require_visible(targets, set, mesh, meshes[mesh].name, *work);
  }
  return targets;
}

// The paper's sensor and ranges add nothing, so that checkpoints from before other ones existed stay valid.
std::uint64_t view_hash(const TrainingTargets& targets) {
  std::vector<EffectRanges> effect_sets;
  for (const EffectSet& set : targets.effect_sets) effect_sets.push_back(set.effects);
  std::uint64_t hash = conditions_hash(targets.conditions, effect_sets);
  if (!targets.sensor.is_the_papers()) hash = mix(hash, crc32_of(targets.sensor));
  if (targets.ranges.are_the_papers()) return hash;
  hash = mix(mix(hash, bits_of(targets.ranges.nearest_m)), bits_of(targets.ranges.farthest_m));
  if (targets.ranges.largest_rate_deg_s == RangeLimits{}.largest_rate_deg_s) return hash;
  return mix(hash, bits_of(targets.ranges.largest_rate_deg_s));
}

ScenarioSettings scenario_of(const TrainingTargets& targets, Condition condition, const EffectRanges& effects,
                             int frames) {
  ScenarioSettings scenario{condition, frames};
  scenario.effects = effects;
  scenario.sensor = targets.sensor.settings;
  scenario.ranges = targets.ranges;
  scenario.disturbances.period_s = targets.sensor.period_s;
  return scenario;
}

FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch,
                         Share rows) {
  thread_local Workspace work;
  FrameBatch result{torch::empty({rows.count, 1, kSide, kSide}), torch::empty({rows.count, 3, 3})};
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const FrameTruth truth = render(targets, seed, group * batch + rows.first + i, work);
    result.images[i].copy_(image_tensor(work.image));
    result.r_view_trf[i].copy_(rotation_tensor(truth, gnc::converted<float>(work.image.r_lrf_view)));
  }
  return result;
}

FrameBatch render_frames(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t group, int batch) {
  return render_frames(targets, seed, group, batch, {0, batch});
}

FrameBatch turned(const FrameBatch& batch, std::int64_t quarter_turns) {
  return {torch::rot90(batch.images, quarter_turns, {2, 3}).contiguous(),
          torch::matmul(torch::matrix_power(quarter_turn(), quarter_turns), batch.r_view_trf)};
}

FrameStream::FrameStream(const TrainingTargets& targets, std::uint64_t seed, int batch,
                         std::uint64_t first_batch, int workers, std::optional<Share> rows)
    : targets_(targets),
      seed_(seed),
      batch_(batch),
      rows_(rows.value_or(Share{0, batch})),
      claimed_(first_batch / kUses),
      wanted_(first_batch) {
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
  give_way();
  for (;;) {
    std::uint64_t group = 0;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || claimed_ * kUses < wanted_ + kAhead; });
      if (stop_) return;
      group = claimed_++;
    }
    const FrameBatch batch = render_frames(targets_, seed_, group, batch_, rows_);
    for (std::uint64_t use = 0; use < kUses; ++use) {
      FrameBatch copy = turned(batch, static_cast<std::int64_t>(use));
      const std::lock_guard<std::mutex> lock(mutex_);
      ready_.emplace(group * kUses + use, std::move(copy));
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
