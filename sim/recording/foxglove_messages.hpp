// What a run shows in Foxglove, Lichtblick and PlotJuggler without set-up: messages of Foxglove's well-known
// schemas, and the figures of a step for plots, as JSON.
#pragma once

#include <array>
#include <string>

#include "gnc/lidar/range_image.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

struct FoxgloveSchema {
  const char* name;
  const char* text;  // JSON schema
};
inline constexpr const char* kPointCloudTopic = "/lidar/points";
inline constexpr const char* kTransformsTopic = "/tf";
inline constexpr const char* kLogTopic = "/events";
inline constexpr const char* kFiguresTopic = "/figures";
const FoxgloveSchema& point_cloud_schema();
const FoxgloveSchema& transforms_schema();
const FoxgloveSchema& log_schema();
const FoxgloveSchema& figures_schema();

// The frame "lrf" is the LiDAR frame: +x right, +y boresight, +z up. `time_ns`: of the step.
std::string point_cloud_json(const gnc::RangeImage& frame, std::int64_t time_ns);
// "lrf" to the target at its true attitude ("target_true"), and to where the flight program has it: at the
// attitude of the network ("target_network") and at the registered pose ("target_pose"), if there is one.
// `truth` may be null, and its rate and range NaN; `swath_m`: of its displacement from the boresight.
// `time_ns`: at which the target was there.
std::string transforms_json(const hal::AttitudeReport& report, const FrameTruth* truth, double swath_m,
                            std::int64_t time_ns);
std::string log_json(const hal::Event& event, std::int64_t time_ns);
// Errors in degrees, of the network and of the pose, with what the flight program expects of them; range
// along the boresight and rate; whether the attitude is valid and the pose verified. What is not known is
// left out.
std::string figures_json(const hal::AttitudeReport& report, const FrameTruth* truth);

}  // namespace tumblesight::sim
