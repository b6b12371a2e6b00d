// Sequence: what happens in one run of frames, before any sensor looks at it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

inline constexpr double kFramePeriod_s = 2.7;  // paper, sampling
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;
inline constexpr int kFramesPerSequence = 10;

enum class Condition { kNominal, kDegraded };  // FOV/128; FOV/100 and 10 % of the returns removed

std::string to_string(Condition condition);
// Throws std::invalid_argument that names the conditions there are.
Condition condition_from(const std::string& name);

struct FrameTruth {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d rate_lrf_rad_s;
  double range_m;  // to the TRF's origin, on the boresight
};

struct Sequence {
  Condition condition = Condition::kNominal;
  std::uint64_t noise_seed = 0;  // of the sensor noise of this sequence
  std::vector<FrameTruth> frames;
};

// The paper's sampling: attitude uniform on SO(3), range uniform 20..100 m and constant, rate components
// uniform with the norm at most 20 deg/s, constant in the LRF. The same (seed, index) gives the same sequence
// on every machine.
Sequence make_sequence(Condition condition, std::uint64_t seed, std::uint64_t index,
                       int frames = kFramesPerSequence);

}  // namespace tumblesight::sim
