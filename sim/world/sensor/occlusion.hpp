// Occlusion: which rays of a flash a part of the chaser blocks.
#pragma once

#include <vector>

#include "sim/world/scenario/occluder.hpp"

namespace tumblesight::sim {

// A square grid of true ranges, row by row from the top left, as in gnc::RangeImage; infinity: nothing is
// hit.
struct RangeGrid {
  int rays = 0;  // to a side
  double tan_half_fov = 0.0;
  std::vector<double> range_m;

  double slope(int index) const { return tan_half_fov * ((2.0 * index + 1.0) / rays - 1.0); }
};

// Puts the occluder before the target: blocked rays get its range. It is made just large enough to hide
// `hidden_share` of the rays that hit the target (to within one or two returns, of which it always hides
// one). No effect on a frame without returns.
void occlude(const Occluder& occluder, RangeGrid& grid);

}  // namespace tumblesight::sim
