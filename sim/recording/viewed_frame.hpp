// What viewers show of a frame and of a report: points and poses in the LiDAR frame (LRF): +x right, +y
// boresight, +z up. Messages for Foxglove and for ROS 2 are made from them.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/messages/attitude_report.hpp"

namespace tumblesight::sim {

enum class PointFields { kXyz, kXyzRange };
// The returns of a frame, row after row: their fields [m] as float32, little-endian.
std::vector<std::uint8_t> point_bytes(const gnc::RangeImage& frame, PointFields fields);

struct PoseInLrf {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d origin_lrf_m;
};
// The network's attitude at the centroid of the returns. Nothing: the report gives no attitude.
std::optional<PoseInLrf> network_pose(const hal::AttitudeReport& report);
// Nothing: the report gives no attitude, or no registered pose.
std::optional<PoseInLrf> registered_pose(const hal::AttitudeReport& report);

}  // namespace tumblesight::sim
