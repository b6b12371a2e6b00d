// Occlusion: the rays of a flash that a part of the chaser blocks (its arm, mast or panel).
//
// Model: one opaque flat shape at one distance, in front of everything else. It is sized in every frame so
// that it hides a given share of the target's returns. Limits: no depth of its own, one occluder per frame.
#pragma once

#include "sim/world/sensor/range_grid.hpp"

namespace tumblesight::sim {

enum class OccluderShape {
  kNone,
  kArm,        // reaches in from one side and ends over the target
  kMast,       // crosses the whole frame
  kPanelEdge,  // covers everything beyond a straight edge
};

// In one frame. The share is given instead of a size, so that a test of "20 % hidden" hides 20 % in every
// frame, whatever the target's attitude.
struct Occluder {
  OccluderShape shape = OccluderShape::kNone;
  // Side from which it comes, counter-clockwise from the right edge of the image.
  double side_rad = 0.0;
  double across = 0.5;        // arm, mast: share 0..1 of the target's returns to the left of its axis
  double hidden_share = 0.0;  // 0..1 of the target's returns
  double distance_m = 3.0;    // from the sensor, along the boresight
};

// Puts the occluder in front of the target: blocked rays get its range. It hides `hidden_share` of the rays
// that hit the target to within one or two returns, and at least one. A frame without returns is not changed.
void occlude(const Occluder& occluder, RangeGrid& grid);

}  // namespace tumblesight::sim
