// What a registered pose says of the network's attitude: evidence for its expected error.
#pragma once

#include "gnc/attitude/quaternion.hpp"
#include "gnc/estimation/expected_error.hpp"
#include "gnc/registration/pose_tracker.hpp"

namespace tumblesight::gnc {

// `q_lrf_trf`: the network's attitude. Adds nothing if the pose is not known or only predicted.
void add_pose(const PoseEstimate& pose, const QuaternionQ30& q_lrf_trf, ErrorEvidence& evidence);

}  // namespace tumblesight::gnc
