// Occluder: a part of the chaser itself that stands in the sensor's view.
#pragma once

namespace tumblesight::sim {

enum class OccluderShape {
  kNone,
  kArm,        // reaches in from one side, ends over the target
  kMast,       // crosses the whole frame
  kPanelEdge,  // covers everything beyond a straight edge
};

// In one frame. The shape is made as large as it must be to hide `hidden_share` of the target's returns, so
// that a test of "20 % hidden" hides 20 % in every frame, whatever the target's attitude.
struct Occluder {
  OccluderShape shape = OccluderShape::kNone;
  double side_rad =
      0.0;  // the side it comes from, counter-clockwise from the frame's right as the image is seen
  double across = 0.5;  // arm, mast: the share of the target's returns to the left of its axis
  double hidden_share = 0.0;
  double distance_m = 3.0;  // from the sensor, along the boresight
};

}  // namespace tumblesight::sim
