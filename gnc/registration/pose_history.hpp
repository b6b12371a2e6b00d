// PoseHistory: the last registered poses of a track, all in the axes of the LRF now.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/registration/normal_equations.hpp"
#include "gnc/registration/pose.hpp"

namespace tumblesight::gnc {

// A vector in another frame: r vector [um].
std::array<std::int32_t, 3> turned_um(const Matrix3<Fixed>& r, const std::array<std::int32_t, 3>& vector_um);

// One registered frame.
struct PoseMeasurement {
  Pose pose;
  // As it is used: turn [rad^-2] and move [radii^-2], lower triangle, 4 fraction bits.
  std::array<std::int32_t, kElements> information{};
  std::int64_t age_ns = 0;  // since its exposure
};
// `equations`: of Refinement, 12 fraction bits; the gradient is not used. A quarter of the information is
// used, and no more than (0.05 degrees)^-2 about any axis: neighbouring places of a silhouette see the same
// rays, and the mesh is not exact.
PoseMeasurement measured_pose(const Pose& pose, const NormalEquations& equations);

struct PoseHistory {
  static constexpr int kMost = 10;
  int count = 0;
  std::array<PoseMeasurement, kMost> poses;  // the oldest first

  // Forgets the oldest if there are kMost.
  void add(const PoseMeasurement& measurement);
  // Bit n: forget pose n.
  void remove(std::uint32_t poses_to_forget);
  // To a time `elapsed_ns` later, in an LRF that has turned: `r_now_last` takes the LRF before to the LRF
  // after. Forgets poses that are older than kOldest_ns.
  void advance(std::int64_t elapsed_ns, const Matrix3<Fixed>& r_now_last);
  static constexpr std::int64_t kOldest_ns = kLongestPropagation_ns;
};

}  // namespace tumblesight::gnc
