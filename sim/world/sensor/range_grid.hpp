// RangeGrid: the exact ranges of one flash, before the sensor measures them.
#pragma once

#include <vector>

namespace tumblesight::sim {

// Square, row by row from the top left, as in gnc::RangeImage.
struct RangeGrid {
  int rays = 0;                 // per side
  double tan_half_fov = 0.0;    // tangent of half the field of view
  std::vector<double> range_m;  // rays * rays values along the rays; infinity: the ray hits nothing

  // Slope of the rays of a column (to the right) or of a row (downwards): offset from the boresight per unit
  // of distance along it.
  double slope(int index) const { return tan_half_fov * ((2.0 * index + 1.0) / rays - 1.0); }
};

}  // namespace tumblesight::sim
