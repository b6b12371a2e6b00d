// What the chaser's navigation tells the estimator at an exposure.
#pragma once

#include <cstdint>

#include "gnc/attitude/chaser_attitude.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

// The chaser's attitude in `truth`, with the error of the sensor's mounting and rounded to Q1.30. `time_ns`:
// of the exposure, in the time of the frame's stamp. `known` false: the navigation gives none
// (--no-ego-motion).
gnc::ChaserAttitude chaser_attitude(const FrameTruth& truth, std::int64_t time_ns, bool known);

}  // namespace tumblesight::sim
