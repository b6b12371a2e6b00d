// RangeGrid: the exact ranges of one flash, before the sensor measures them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tumblesight::sim {

// What a ray meets of the target.
struct SurfaceHit {
  double range_m = 0.0;
  double cos_incidence = 1.0;  // cosine of the angle between the ray and the normal, 0..1
  bool is_panel = false;       // of the target's solar panels
  std::uint32_t triangle = 0;  // of the mesh; of no meaning if the ray hits nothing
};

// How the rays of a sensor divide its field of view, in each axis.
enum class RaySpacing {
  kTangent,  // equal steps of the tangent, as in gnc::RangeImage
  kAngle,    // equal steps of the angle
};

// Square, row by row from the top left, as in gnc::RangeImage.
struct RangeGrid {
  int rays = 0;                 // per side
  double tan_half_fov = 0.0;    // tangent of half the field of view
  std::vector<double> range_m;  // rays * rays values along the rays; infinity: the ray hits nothing
  // One per ray, or empty if it is not asked for. Holds for a ray only while the target is what it sees: if
  // the surface's range is the ray's.
  std::vector<SurfaceHit> surfaces{};
  RaySpacing spacing = RaySpacing::kTangent;
  // Range of the nearest surface whose return a ray has lost, infinity without one: it still hides what is
  // behind it. Empty: no ray has lost a return.
  std::vector<double> lost_m{};

  // Slope of the rays of a column (to the right) or of a row (downwards): offset from the boresight per unit
  // of distance along it. `shift`: of the rays, in rays.
  double slope(int index, double shift = 0.0) const {
    const double share = (2.0 * index + 1.0) / rays - 1.0;
    if (spacing == RaySpacing::kAngle) return slope_at(share + 2.0 / rays * shift);
    return tan_half_fov * share + 2.0 * tan_half_fov / rays * shift;
  }
  // Slope at a share of half the field of view, -1 to 1.
  double slope_at(double share) const {
    return spacing == RaySpacing::kAngle ? std::tan(std::atan(tan_half_fov) * share) : tan_half_fov * share;
  }
  // The column or row of a slope, between two rays as a fraction.
  double index_of(double slope) const {
    const double share =
        spacing == RaySpacing::kAngle ? std::atan(slope) / std::atan(tan_half_fov) : slope / tan_half_fov;
    return 0.5 * rays * (1.0 + share) - 0.5;
  }
};

// What the ray `index` sees: the target's surface, or one that faces the sensor where something else is in
// front of it or surfaces are not known.
inline SurfaceHit surface_of(const RangeGrid& grid, std::size_t index) {
  const bool target = !grid.surfaces.empty() && grid.surfaces[index].range_m == grid.range_m[index];
  return target ? grid.surfaces[index] : SurfaceHit{grid.range_m[index]};
}

// The ray `index` gets no light back from the surface at `range_m` that it meets.
inline void lose_return(RangeGrid& grid, std::size_t index, double range_m) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (grid.lost_m.empty()) grid.lost_m.assign(grid.range_m.size(), kNone);
  grid.lost_m[index] = std::min(grid.lost_m[index], range_m);
  grid.range_m[index] = kNone;
}

// What is farther away along the ray `index` is hidden.
inline double sight_m(const RangeGrid& grid, std::size_t index) {
  return grid.lost_m.empty() ? grid.range_m[index] : std::min(grid.range_m[index], grid.lost_m[index]);
}

}  // namespace tumblesight::sim
