// Pose choice: which attitudes a frame is registered at, and which of them the track takes.
#pragma once

#include "gnc/registration/pose_track.hpp"

namespace tumblesight::gnc {

// From so many poses on the predicted motion is a good start of a registration and of a fit.
inline constexpr int kPosesOfARate = 4;

// Whether two attitudes are 20 degrees apart or more.
bool is_another_attitude(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b);

// A log-likelihood ratio, or the sum of two, within the limits of a track: 32 nats.
std::int32_t limited_llr_q8(std::int32_t llr_q8);

// The first frames of a track: `scratch.best` becomes the registered attitude of the network or its second
// one. These two are functions of their own, so that their variables do not lie on the stack while the motion
// is fitted.
void start_track(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                 PoseTrackerState& state);

// A frame of a track; `state.motion` predicts its pose. `scratch.best` becomes the registered pose. False:
// the track was given up for another attitude.
bool follow_track(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                  PoseTrackerState& state);

}  // namespace tumblesight::gnc
