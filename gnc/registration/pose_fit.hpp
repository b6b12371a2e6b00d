// Pose fit: the motion of the target that the last registered poses agree on.
//
// Least squares over up to ten poses, each with the information that its frame gave: turn and rate by a
// motion model of torque-free motion, position and velocity on a straight line. A pose that does not agree
// counts less, so that a frame that was registered wrong does not spoil the motion. Fitting all of them anew
// makes the result independent of what was believed before.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/registration/pose_history.hpp"
#include "gnc/registration/work_budget.hpp"

namespace tumblesight::gnc {

inline constexpr int kMotionUnknowns = 12;  // turn, rate [rad per period], move, velocity [radii per period]
inline constexpr int kMotionElements = kMotionUnknowns * (kMotionUnknowns + 1) / 2;

struct PoseMotion {
  Motion<Fixed> turning;                             // at the last pose
  std::array<std::int32_t, 3> origin_lrf_um{};       // of the TRF, at the last pose
  std::array<std::int32_t, 3> velocity_um_period{};  // per nominal period
};

// The motion `elapsed_ns` later (limited to 0 ... kLongestPropagation_ns) in an LRF that has turned:
// `r_now_last` takes the LRF before to the LRF after.
PoseMotion later_motion(const PoseMotion& motion, const Inertia<Fixed>& inertia, std::int64_t elapsed_ns,
                        const Matrix3<Fixed>& r_now_last);

struct PoseFitResult {
  PoseMotion motion;
  std::array<std::int64_t, kMotionElements> information{};  // lower triangle, 4 fraction bits
  // Mean square of what is left, by the information that is used: about 0.2 if the poses agree as well as
  // they say, and 65536 for a pose that is more than 60 degrees off. Q8.
  std::int64_t disagreement_q8 = 0;
  std::uint32_t against = 0;  // bit n: pose n does not agree at all, by a mean square above 16
};

inline constexpr int kMostIterations = 3;  // enough for a start that is a degree off

// Requires history.count >= 1 and ages in descending order. The newest pose may be of an earlier time than
// now; the motion is that of its exposure. `start`: approximate motion at the last pose; its rate decides
// among rates that lead to the same attitudes, and has to lead back to each of them within 60 degrees.
// `iterations`: 1 ... kMostIterations. False: the budget was exhausted, and the result means nothing.
bool fit_motion(const PoseHistory& history, const Inertia<Fixed>& inertia, std::int32_t target_radius_um,
                const PoseMotion& start, int iterations, WorkBudget& budget, PoseFitResult& result);
// The most that a fit of these poses takes, and of another one of now (work_budget.hpp).
std::int32_t work_of_fit(const PoseHistory& history, int iterations);

}  // namespace tumblesight::gnc
