// Expected error: by how much an attitude of the network is wrong, from all that the frame says about it. A
// logistic regression gives the probability that it is wrong, by more than 20 degrees. Specification:
// docs/numerics.md.
#pragma once

#include <cstdint>

#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

struct ErrorEvidence {
  Fixed network_error_rad;   // that the network expects, 0..pi
  Fixed network_logit;       // of that error over pi
  std::uint32_t misfit = 0;  // misfit_of()
  Fixed innovation_squared;  // 2 - 2 cos of the angle to the predicted attitude; 0 without a prediction
  Fixed second_share;        // of the second attitude in the probability of both, 0..1
  // Of a pose that was registered with the frame.
  bool has_pose = false;
  bool ranges_disagree = false;       // the frame's ranges with it
  bool silhouette_disagrees = false;  // the frame's silhouette with it
  bool lacks_motion = false;          // too few poses, or they contradict one motion
  bool is_far = false;                // the network's attitude is another one
  // Of the attitude if the pose is right: root of the squared angle between them and of the pose's variance.
  // Used unless the pose is far.
  Fixed pose_error_rad;
};

// 0..pi [rad].
Fixed expected_error_rad(const ErrorEvidence& evidence);

}  // namespace tumblesight::gnc
