// RangeGrid: the exact ranges of one flash, before the sensor measures them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tumblesight::sim {

// What a ray meets of the target.
struct SurfaceHit {
  double range_m = 0.0;
  double cos_incidence = 1.0;  // cosine of the angle between the ray and the normal, 0..1
  bool is_panel = false;       // of the target's solar panels
};

// Square, row by row from the top left, as in gnc::RangeImage.
struct RangeGrid {
  int rays = 0;                 // per side
  double tan_half_fov = 0.0;    // tangent of half the field of view
  std::vector<double> range_m;  // rays * rays values along the rays; infinity: the ray hits nothing
  // One per ray, or empty if it is not asked for. Holds for a ray only while the target is what it sees: if
  // the surface's range is the ray's.
  std::vector<SurfaceHit> surfaces{};
  // Range of the nearest surface whose return a ray has lost, infinity without one: it still hides what is
  // behind it. Empty: no ray has lost a return.
  std::vector<double> lost_m{};

  // Slope of the rays of a column (to the right) or of a row (downwards): offset from the boresight per unit
  // of distance along it.
  double slope(int index) const { return tan_half_fov * ((2.0 * index + 1.0) / rays - 1.0); }
};

// What the ray `index` sees: the target's surface, or one that faces the sensor where something else is in
// front of it or surfaces are not known.
inline SurfaceHit surface_of(const RangeGrid& grid, std::size_t index) {
  const bool target = !grid.surfaces.empty() && grid.surfaces[index].range_m == grid.range_m[index];
  return target ? grid.surfaces[index] : SurfaceHit{grid.range_m[index], 1.0, false};
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
