// Sequence: the true motion of the target over consecutive frames, before any sensor measures it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/scenario/condition.hpp"
#include "sim/world/scenario/disturbance.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

inline constexpr int kFramesPerSequence = 10;

// How the rate is drawn (paper, both strategies).
enum class RateDistribution {
  kComponents,  // components uniform, norm at most 20 deg/s
  kNorm,        // norm uniform on 0..20 deg/s, direction uniform
};

// The limits within which range and rate of a sequence are drawn (paper, sampling).
struct RangeLimits {
  double nearest_m = 20.0;
  double farthest_m = 100.0;
  double largest_rate_deg_s = 20.0;  // above 0
  bool are_the_papers() const {
    return nearest_m == 20.0 && farthest_m == 100.0 && largest_rate_deg_s == 20.0;
  }
};
// "20 to 100 m", with all digits that were given; "20 to 100 m, at most 5 deg/s" for a rate that is not the
// paper's.
std::string to_string(const RangeLimits& ranges);

struct ScenarioSettings {
  Condition condition = Condition::kNominal;
  int frames = kFramesPerSequence;
  RateDistribution rate_distribution = RateDistribution::kComponents;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // in the TRF; torque-free rotation only
  // Values that are fixed instead of drawn, for curves over them.
  std::optional<double> range_m{};
  std::optional<double> rate_rad_s{};
  std::optional<double> hidden_share{};
  Disturbances disturbances{};
  EffectRanges effects{};
  SensorSettings sensor{};  // on which condition and effects act
  RangeLimits ranges{};
  // Of the renderer, for conditions under which the target moves: it relates lengths across the boresight to
  // the offset. The default is that of a target with a radius of about 4 m.
  double swath_m = 8.0;
};

// Settings for `target` under a condition. Throws std::invalid_argument that says what to do if the condition
// needs an inertia and none is given.
ScenarioSettings scenario_settings(Condition condition, std::uint32_t frames, const std::string& target,
                                   const std::optional<Eigen::Matrix3d>& inertia_kg_m2);

struct Sequence {
  Condition condition = Condition::kNominal;
  std::uint64_t noise_seed = 0;  // of the sensor noise, see NoiseSeedRule
  std::vector<FrameTruth> frames;
  Effects effects{};        // with which the sensor sees it
  SensorSettings sensor{};  // on which condition and effects act
};

// Draws sequence `index` of `seed` (paper, sampling): attitude uniform on SO(3); range uniform on the
// settings' limits, constant within the sequence; rate at most 20 deg/s, constant in the LRF or torque-free
// as the condition says. The same (seed, index) gives the same sequence on every machine, and the same
// initial attitude, range, rate and noise under every condition, disturbance and effect, but for the range of
// an approach, which is within kNearestApproach_m to kFarthestApproach_m in place of the paper's. Strengths
// of effects are drawn once for the sequence; those on the body are the body's own (observed_bodies()).
// Throws std::invalid_argument as require_possible() does, and if both condition and disturbances turn the
// chaser.
Sequence make_sequence(const ScenarioSettings& settings, std::uint64_t seed, std::uint64_t index);

}  // namespace tumblesight::sim
