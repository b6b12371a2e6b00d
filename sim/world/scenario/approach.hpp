// Approach: the chaser closes in on the target along the boresight, with the small motions of a real one.
//
//   path       a straight line at constant velocity: 0.05 to 0.5 m/s along the boresight, slower if the
//              sequence is too long for its ranges, and up to 0.05 m/s across it in each axis. The target
//              stays within about a quarter of the swath of the boresight.
//   attitude   the chaser turns at a constant rate of up to 0.2 deg/s, of which the part across the boresight
//              is limited by the view, and each exposure is off by a jitter of 0.02 deg per axis (1 sigma)
//   mounting   the navigation's LRF is off by a constant turn of 0.12 deg per axis (1 sigma)
//   losses     a frame is lost with a probability of 5 %: never the first, the last, or two in succession
//
// The target's motion in inertial space and its first attitude in the LRF stay what they are.
#pragma once

#include <optional>
#include <vector>

#include "sim/world/math/random.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

inline constexpr double kNearestApproach_m = 12.0;
inline constexpr double kFarthestApproach_m = 100.0;

struct ApproachLimits {
  double nearest_m = kNearestApproach_m;  // range_m of no frame is outside
  double farthest_m = kFarthestApproach_m;
  double swath_m = 0.0;                // of the renderer
  std::optional<double> start_m = {};  // in place of a drawn range; moved to where the path fits
};

// Requires exposure times, attitudes and rates in `frames`, and at least one frame.
void close_in(const ApproachLimits& limits, Random random, const std::vector<double>& times_s,
              std::vector<FrameTruth>& frames);

}  // namespace tumblesight::sim
