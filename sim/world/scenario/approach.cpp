#include "sim/world/scenario/approach.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/dynamics/motion.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/draws.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSlowest_m_s = 0.05;
constexpr double kFastest_m_s = 0.5;
constexpr double kFastestDrift_m_s = 0.05;
constexpr double kMaxDrift_swaths = 0.15;  // off the boresight of a chaser that does not turn
constexpr double kMaxSway_swaths = 0.1;    // more, by the turn of the chaser
constexpr double kFastestTurn_rad_s = 0.2 * kRadPerDeg;
constexpr double kJitter_rad = 0.02 * kRadPerDeg;
constexpr double kMounting_rad = 0.12 * kRadPerDeg;
constexpr double kLossShare = 0.05;

// In axes that do not turn: those of the LRF without jitter in the middle of the sequence.
struct Path {
  Eigen::Vector3d start_m;
  Eigen::Vector3d velocity_m_s;
};

// Uniform on the disk in which the target may be.
Eigen::Vector2d uniform_place(double swath_m, Random& random) {
  const double angle_rad = random.uniform(0.0, 2.0 * kPi);
  const double radius_m = kMaxDrift_swaths * swath_m * std::sqrt(random.uniform());
  return radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

Path drawn_path(const ApproachLimits& limits, double duration_s, Random& random) {
  // The most that the turn adds to a range or takes from it.
  const double turned_m = (kMaxDrift_swaths + 0.5 * kMaxSway_swaths) * kMaxSway_swaths * limits.swath_m *
                              limits.swath_m / limits.nearest_m +
                          0.01;
  const double middle_m = 0.5 * (limits.nearest_m + limits.farthest_m);
  const double lowest_m = std::min(limits.nearest_m + turned_m, middle_m);
  const double highest_m = std::max(limits.farthest_m - turned_m, middle_m);
  double speed_m_s = random.uniform(kSlowest_m_s, kFastest_m_s);
  const double longest_m = highest_m - lowest_m;
  if (speed_m_s * duration_s > longest_m) speed_m_s = longest_m / duration_s;
  const double nearest_start_m = std::min(lowest_m + speed_m_s * duration_s, highest_m);
  const double drawn_m = nearest_start_m + (highest_m - nearest_start_m) * random.uniform();
  const double start_m = std::clamp(limits.start_m.value_or(drawn_m), nearest_start_m, highest_m);

  const Eigen::Vector2d first_m = uniform_place(limits.swath_m, random);
  const Eigen::Vector2d last_m = uniform_place(limits.swath_m, random);
  Eigen::Vector2d drift_m_s = Eigen::Vector2d::Zero();
  if (duration_s > 0.0) drift_m_s = (last_m - first_m) / duration_s;
  const double fastest_m_s = drift_m_s.lpNorm<Eigen::Infinity>();
  if (fastest_m_s > kFastestDrift_m_s) drift_m_s *= kFastestDrift_m_s / fastest_m_s;
  return {{first_m.x(), start_m, first_m.y()}, {drift_m_s.x(), -speed_m_s, drift_m_s.y()}};
}

Eigen::Vector3d normal_vector(double sigma, Random& random) {
  Eigen::Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = sigma * random.normal();
  return vector;
}

// Constant rate of the chaser, in the axes of the path.
Eigen::Vector3d drawn_turn(const ApproachLimits& limits, double start_m, double duration_s, Random& random) {
  const double rate_rad_s = random.uniform(0.0, kFastestTurn_rad_s);
  Eigen::Vector3d turn_rad_s = rate_rad_s * (uniform_attitude(random) * Eigen::Vector3d::UnitX());
  // Half of it before the middle of the sequence, half of it after.
  const double across_rad_s = std::hypot(turn_rad_s.x(), turn_rad_s.z());
  const double most_rad = 2.0 * kMaxSway_swaths * limits.swath_m / start_m;
  if (across_rad_s * duration_s > most_rad) {
    turn_rad_s.x() *= most_rad / (across_rad_s * duration_s);
    turn_rad_s.z() *= most_rad / (across_rad_s * duration_s);
  }
  return turn_rad_s;
}

// Single frames. `random`: of its own, so that losses change no other draw.
void lose_frames(Random random, std::vector<FrameTruth>& frames) {
  for (std::size_t k = 1; k + 1 < frames.size(); ++k) {
    const bool lost = random.uniform() < kLossShare;
    if (lost && !frames[k - 1].lost) frames[k].lost = true;
  }
}

}  // namespace

void close_in(const ApproachLimits& limits, Random random, const std::vector<double>& times_s,
              std::vector<FrameTruth>& frames) {
  const double duration_s = times_s.back();
  const Path path = drawn_path(limits, duration_s, random);
  const Eigen::Vector3d turn_rad_s = drawn_turn(limits, path.start_m.y(), duration_s, random);
  const Eigen::Quaterniond q_inertial_path = uniform_attitude(random);
  const Eigen::Vector3d mounting_rad = normal_vector(kMounting_rad, random);
  const Eigen::Quaterniond q_lrf_stated = spin(Eigen::Quaterniond::Identity(), mounting_rad, 1.0);
  lose_frames(Random(random.next()), frames);
  Eigen::Quaterniond q_path_first;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    FrameTruth& frame = frames[k];
    const Eigen::Quaterniond steady =
        spin(Eigen::Quaterniond::Identity(), turn_rad_s, times_s[k] - 0.5 * duration_s);
    const Eigen::Quaterniond q_path_lrf = spin(steady, normal_vector(kJitter_rad, random), 1.0);
    if (k == 0) q_path_first = q_path_lrf;
    const Eigen::Vector3d origin_lrf_m =
        q_path_lrf.conjugate() * (path.start_m + times_s[k] * path.velocity_m_s);
    frame.range_m = origin_lrf_m.y();
    frame.offset_swaths = Eigen::Vector2d(origin_lrf_m.x(), origin_lrf_m.z()) / limits.swath_m;
    frame.velocity_lrf_m_s = q_path_lrf.conjugate() * path.velocity_m_s;
    frame.q_inertial_lrf = q_inertial_path * q_path_lrf;
    frame.q_lrf_stated = q_lrf_stated;
    if (k == 0) continue;  // the first attitude is the drawn one, without rounding
    const Eigen::Quaterniond q_lrf_first = q_path_lrf.conjugate() * q_path_first;
    frame.q_lrf_trf = (q_lrf_first * frame.q_lrf_trf).normalized();
    frame.rate_lrf_rad_s = q_lrf_first * frame.rate_lrf_rad_s;
  }
}

}  // namespace tumblesight::sim
