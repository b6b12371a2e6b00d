#include "sim/training/sequence_features.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "gnc/rcnn/hypotheses.hpp"
#include "gnc/rcnn/network_shape.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kFrames = kTrainingFrames;

// Buffers of one worker.
struct FeatureWorkspace {
  explicit FeatureWorkspace(const gnc::NetworkWeights<gnc::Float32>& weights) { network.weights() = weights; }
  gnc::RangeImage frame;
  gnc::DepthImage image;
  gnc::DepthImageScratch scratch;
  gnc::Network<gnc::Float32> network;
  gnc::Activations<gnc::Float32> activations;
  gnc::OutputVector<float> output;
};

// The inertia of some rigid body: principal moments from the spread of its mass along three axes, axes turned
// at random.
Eigen::Matrix3d random_inertia(Random random) {
  Eigen::Vector3d spread;
  for (int i = 0; i < 3; ++i) spread[i] = random.uniform(0.3, 1.0);
  Eigen::Vector4d q;
  for (int i = 0; i < 4; ++i) q[i] = random.normal();
  const Eigen::Matrix3d axes = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  const Eigen::Matrix3d inertia =
      axes * (Eigen::Vector3d::Constant(spread.sum()) - spread).asDiagonal() * axes.transpose();
  return 0.5 * (inertia + inertia.transpose());
}

// Meshes, conditions, distributions of the rate and sets of effects take turns, the meshes fastest.
std::uint64_t meshes_of(const TrainingTargets& targets) {
  return targets.effect_sets.front().lidars.size();
}

const EffectSet& effect_set_of(const TrainingTargets& targets, std::uint64_t number) {
  const std::uint64_t turn = number / (meshes_of(targets) * targets.conditions.size() * 2);
  return targets.effect_sets[turn % targets.effect_sets.size()];
}

// When the frames of a sequence come: every second sequence in the sensor's own period; of the others a third
// with another period, a third with times that vary, and a third with single frames that are lost. The last
// two are left out if a time between frames would then be shorter than kShortest_s or longer than kLongest_s:
// such frames do not tell the rate of the target.
struct Timing {
  Disturbances disturbances;
  std::vector<std::uint32_t> frames;  // that arrive
};
Timing timing_of(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t number) {
  constexpr double kShortest_s = 0.4, kLongest_s = 7.0, kJitter = 0.5, kLostShare = 0.3;
  Random random(mix(mix(seed, number), 5));
  Timing timing;
  const double period_s = targets.sensor.period_s;
  timing.disturbances.period_s = period_s;
  const bool may_vary = (1.0 - kJitter) * period_s >= kShortest_s && (1.0 + kJitter) * period_s <= kLongest_s;
  const bool may_lose = 2.0 * period_s <= kLongest_s;
  std::uint32_t frame = 0;
  const double kind = random.uniform(0.0, 6.0);
  if (kind >= 5.0) {
    timing.disturbances.period_s = kShortest_s * std::pow(kLongest_s / kShortest_s, random.uniform());
  } else if (kind >= 4.0 && may_vary) {
    timing.disturbances.period_jitter = kJitter;
  }
  for (int k = 0; k < kFrames; ++k) {
    timing.frames.push_back(frame);
    frame += may_lose && kind >= 3.0 && kind < 4.0 && random.uniform() < kLostShare ? 2 : 1;
  }
  return timing;
}

ScenarioSettings scenario_of(const TrainingTargets& targets, std::uint64_t seed, std::uint64_t number,
                             const Timing& timing) {
  const std::uint64_t turn = number / meshes_of(targets);
  ScenarioSettings settings =
      scenario_of(targets, targets.conditions[turn % targets.conditions.size()],
                  effect_set_of(targets, number).effects, static_cast<int>(timing.frames.back()) + 1);
  settings.disturbances = timing.disturbances;
  settings.rate_distribution =
      (turn / targets.conditions.size()) % 2 == 0 ? RateDistribution::kComponents : RateDistribution::kNorm;
  Random random(mix(mix(seed, number), 4));
  settings.inertia_kg_m2 = random.uniform() < 0.5 ? targets.inertia_kg_m2 : random_inertia(random);
  return settings;
}

void put_rotation(const Eigen::Matrix3f& rotation, float* at) {
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{at} = rotation;
}

// Frame `row` (counted over all sequences) of `all`.
void put_frame(const gnc::Network<gnc::Float32>& network, const gnc::Hypotheses<float>& hypotheses,
               const Eigen::Matrix3f& truth, float periods, std::int64_t row, FeatureSet& all) {
  const SequenceHypotheses& to = all.hypotheses;
  std::copy(network.features().begin(), network.features().end(),
            to.features.data_ptr<float>() + row * shape::kDense2);
  std::copy(hypotheses.logit.begin(), hypotheses.logit.end(),
            to.logits.data_ptr<float>() + row * shape::kHypotheses);
  for (int i = 0; i < shape::kHypotheses; ++i) {
    put_rotation(hypotheses.r_lrf_trf[i],
                 to.r_lrf_trf.data_ptr<float>() + 9 * (row * shape::kHypotheses + i));
  }
  to.periods.data_ptr<float>()[row] = periods;
  put_rotation(truth, all.r_lrf_trf.data_ptr<float>() + 9 * row);
}

// Computes one sequence into row `index` of `all`. False if the sensor sees too little in one of its frames.
bool compute(const TrainingTargets& targets, std::uint64_t seed, std::int64_t index, FeatureWorkspace& work,
             FeatureSet& all) {
  const auto number = static_cast<std::uint64_t>(index);
  const FrameRenderer renderer(*effect_set_of(targets, number).lidars[number % meshes_of(targets)],
                               1e-3 * targets.projection.swath_mm);
  const Timing timing = timing_of(targets, seed, number);
  const Sequence sequence = make_sequence(scenario_of(targets, seed, number, timing), seed, number);
  std::int64_t last_ns = sequence.frames.front().time_ns - gnc::kNominalPeriod_ns;
  for (int k = 0; k < kFrames; ++k) {
    const std::uint32_t frame = timing.frames[static_cast<std::size_t>(k)];
    const FrameTruth& truth = sequence.frames[frame];
    const auto periods =
        static_cast<float>(truth.time_ns - last_ns) / static_cast<float>(gnc::kNominalPeriod_ns);
    last_ns = truth.time_ns;
    renderer.render(sequence, frame, work.frame);
    if (make_depth_image(work.frame, targets.projection, work.scratch, work.image) != gnc::FrameStatus::kOk)
      return false;
    work.network.infer_frame(work.image, work.activations, work.output);
    put_frame(work.network,
              gnc::decode_hypotheses<float>(work.output, gnc::converted<float>(work.image.r_lrf_view)),
              truth.q_lrf_trf.toRotationMatrix().cast<float>(), periods, index * kFrames + k, all);
  }
  return true;
}

}  // namespace

SequenceFeatures::SequenceFeatures(const TrainingTargets& targets,
                                   const gnc::NetworkWeights<gnc::Float32>& weights, std::uint64_t seed,
                                   std::int64_t count, int workers, std::shared_ptr<Ranks> ranks)
    : targets_(targets),
      weights_(weights),
      seed_(seed),
      count_(count),
      ranks_(std::move(ranks)),
      all_{{torch::zeros({count, kFrames, shape::kDense2}),
            torch::zeros({count, kFrames, shape::kHypotheses, 3, 3}),
            torch::zeros({count, kFrames, shape::kHypotheses}), torch::zeros({count, kFrames})},
           torch::zeros({count, kFrames, 3, 3})},
      done_(static_cast<std::size_t>(count), true),
      claimed_(ranks_->rank()) {
  for (std::int64_t i = claimed_; i < count; i += ranks_->count()) done_[static_cast<std::size_t>(i)] = false;
  pass_over_done();
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
  const auto work = std::make_unique<FeatureWorkspace>(weights_);
  for (;;) {
    std::int64_t index = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stop_ || claimed_ >= count_) return;
      index = claimed_;
      claimed_ += ranks_->count();
    }
    for (std::uint64_t attempt = 0; !compute(targets_, mix(seed_, attempt), index, *work, all_); ++attempt) {
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_[static_cast<std::size_t>(index)] = true;
      pass_over_done();
    }
    changed_.notify_all();
  }
}

void SequenceFeatures::pass_over_done() {
  while (prefix_ < count_ && done_[static_cast<std::size_t>(prefix_)]) ++prefix_;
}

std::int64_t SequenceFeatures::ready() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return prefix_;
}

FeatureSet SequenceFeatures::first(std::int64_t count) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return prefix_ >= count; });
  }
  exchange_until(count);
  return first_of(all_, count);
}

// The rows of the other ranks are zero before. The workers write further rows meanwhile.
void SequenceFeatures::exchange_until(std::int64_t count) {
  if (count <= exchanged_) return;
  const auto rows = [&](const torch::Tensor& t) { return t.narrow(0, exchanged_, count - exchanged_); };
  const SequenceHypotheses& own = all_.hypotheses;
  ranks_->sum(
      {rows(own.features), rows(own.r_lrf_trf), rows(own.logits), rows(own.periods), rows(all_.r_lrf_trf)});
  exchanged_ = count;
}

FeatureSet first_of(const FeatureSet& data, std::int64_t count) {
  const auto first = [count](const torch::Tensor& t) { return t.narrow(0, 0, count); };
  const SequenceHypotheses& from = data.hypotheses;
  return {{first(from.features), first(from.r_lrf_trf), first(from.logits), first(from.periods)},
          first(data.r_lrf_trf)};
}

FeatureSet rows_of(const FeatureSet& data, const torch::Tensor& rows, const torch::Device& device) {
  const auto pick = [&](const torch::Tensor& t) { return t.index_select(0, rows).to(device); };
  const SequenceHypotheses& from = data.hypotheses;
  return {{pick(from.features), pick(from.r_lrf_trf), pick(from.logits), pick(from.periods)},
          pick(data.r_lrf_trf)};
}

}  // namespace tumblesight::sim
