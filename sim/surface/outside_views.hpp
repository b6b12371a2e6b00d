// Outside views: the target from all around. What a ray meets in one of the views is its outer surface: a
// mesh need not be watertight, and nothing inside it counts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/world/sensor/frame_truth.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

inline constexpr int kOutsideViews = 150;
// From this many radii a view is nearly parallel.
inline constexpr double kOutsideDistance_radii = 20.0;

// The views' directions are spread evenly over the sphere. `index`: 0 to kOutsideViews - 1.
FrameTruth outside_view(const TriangleMesh& mesh, int index);

struct OuterSurface {
  std::vector<std::uint8_t> is_seen;  // per triangle: 1 if a ray of a view meets it
  // Per triangle: the rays that meet its front, where its corners run counterclockwise, and its back.
  std::vector<std::array<std::uint32_t, 2>> hits;
  std::vector<Eigen::Vector3f> points_trf_m;  // where one ray in 31 meets it
};
// In each view a ray meets the target every 0.008 radii, in all views together every 0.001 radii.
OuterSurface outer_surface(const TriangleMesh& mesh);

}  // namespace tumblesight::sim
