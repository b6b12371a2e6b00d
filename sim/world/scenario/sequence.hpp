// Sequence: what happens in one run of frames, before any sensor looks at it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/scenario/occluder.hpp"

namespace tumblesight::sim {

inline constexpr double kFramePeriod_s = 2.7;  // paper, sampling
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;
inline constexpr int kFramesPerSequence = 10;
inline constexpr double kMaxOffset_swaths = 0.2;

enum class Condition {
  kNominal,   // FOV/128
  kDegraded,  // FOV/100, and 10 % of the returns removed
  kOccluded,  // a part of the chaser moves through the view and hides 5..30 % of the target's returns
  kTumbling,  // torque-free rotation of a rigid body with the target's inertia
  kStress,    // the same with the inertia about z halved
  kOffset,    // target off the boresight by up to 20 % of the swath
  kOutliers,  // 1 % of the returns wrong by 5 sigma to 20 m
};

std::vector<std::string> condition_names();
std::string to_string(Condition condition);
// Throws std::invalid_argument that names the conditions there are.
Condition condition_from(const std::string& name);

// How the rate is drawn (paper, both strategies): components uniform with the norm at most 20 deg/s, or the
// norm uniform on 0..20 deg/s and the direction uniform.
enum class RateLaw { kComponents, kNorm };

struct ScenarioSettings {
  Condition condition = Condition::kNominal;
  int frames = kFramesPerSequence;
  RateLaw rate_law = RateLaw::kComponents;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // in the TRF; tumbling and stress only
  // Fixed instead of drawn, for curves over them.
  std::optional<double> range_m{};
  std::optional<double> rate_rad_s{};
  std::optional<double> hidden_share{};
};

struct FrameTruth {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d rate_lrf_rad_s;
  double range_m;  // to the TRF's origin, along the boresight
  Eigen::Vector2d offset_swaths =
      Eigen::Vector2d::Zero();  // the origin off the boresight: right (+x), up (+z)
  Occluder occluder{};
};

struct Sequence {
  Condition condition = Condition::kNominal;
  std::uint64_t noise_seed = 0;  // of the sensor noise of this sequence
  std::vector<FrameTruth> frames;
};

// The paper's sampling: attitude uniform on SO(3), range uniform 20..100 m and constant, spin at most 20
// deg/s and constant in the LRF, or free of torque when tumbling. The same (seed, index) gives the same
// sequence on every machine, and the same attitude, range and rate under every condition.
Sequence make_sequence(const ScenarioSettings& settings, std::uint64_t seed, std::uint64_t index);

}  // namespace tumblesight::sim
