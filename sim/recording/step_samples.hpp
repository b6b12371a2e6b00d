// The samples of the bus in which the simulator sends a step.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/tracking/chaser_attitude.hpp"
#include "hal/dds/idl/topics.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

struct StepOfRun {
  std::uint32_t run_id = 0;
  std::uint32_t k = 0;
};

// In place, since a frame is large.
void fill(hal::dds::LidarFrameSample& sample, const StepOfRun& step, const gnc::RangeImage& frame);
hal::dds::NavigationSample navigation_sample(const StepOfRun& step, const gnc::ChaserAttitude& attitude);
// `sequence`, `frame`: indices. `time_ns`: of the step.
hal::dds::TruthSample truth_sample(const StepOfRun& step, std::uint32_t sequence, std::uint32_t frame,
                                   const FrameTruth& truth, std::int64_t time_ns);

}  // namespace tumblesight::sim
