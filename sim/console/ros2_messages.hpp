// What ROS 2 gets of a step, as samples of ros2.idl. The frame "lrf" is the LiDAR frame: +x right,
// +y boresight, +z up. `time_ns` is the message's stamp, at least 0.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/topics.hpp"
#include "hal/messages/attitude_report.hpp"
#include "sim/console/ros2.h"

namespace tumblesight::sim {

// The returns of a frame, one behind the other: x, y, z and range as float32 in m, little-endian.
class Ros2Points {
 public:
  static constexpr std::uint32_t kPointBytes = 16;

  Ros2Points(const gnc::RangeImage& frame, std::int64_t time_ns);
  Ros2Points(Ros2Points&&) = default;
  Ros2Points& operator=(Ros2Points&&) = default;
  const sensor_msgs_msg_dds__PointCloud2_& sample() const { return sample_; }

 private:
  std::vector<sensor_msgs_msg_dds__PointField_> fields_;
  std::vector<std::uint8_t> bytes_;
  sensor_msgs_msg_dds__PointCloud2_ sample_{};  // points into both, which moving keeps in place
};

class Ros2Pose {
 public:
  explicit Ros2Pose(const geometry_msgs_msg_dds__PoseStamped_& sample) : sample_(sample) {}
  const geometry_msgs_msg_dds__PoseStamped_& sample() const { return sample_; }

 private:
  geometry_msgs_msg_dds__PoseStamped_ sample_;
};
// The registered pose; without one, the network's attitude at the centroid of the returns. Nothing: the
// report gives no attitude.
std::optional<Ros2Pose> estimated_pose(const hal::AttitudeReport& report, std::int64_t time_ns);
// On the boresight: the truth on the bus has no displacement from it. Nothing: its range is not known.
std::optional<Ros2Pose> true_pose(const hal::dds::TruthSample& truth, std::int64_t time_ns);

class Ros2Twist {
 public:
  explicit Ros2Twist(const geometry_msgs_msg_dds__TwistStamped_& sample) : sample_(sample) {}
  const geometry_msgs_msg_dds__TwistStamped_& sample() const { return sample_; }

 private:
  geometry_msgs_msg_dds__TwistStamped_ sample_;
};
// Angular rate of the target relative to inertial space [rad/s] and velocity of its origin relative to the
// sensor [m/s] in axes that do not turn, as the registered pose has them; without one, the rate from the
// network's attitudes, and a velocity of zero. Nothing: the report gives no attitude.
std::optional<Ros2Twist> estimated_twist(const hal::AttitudeReport& report, std::int64_t time_ns);

class Ros2Transforms {
 public:
  explicit Ros2Transforms(std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms);
  Ros2Transforms(Ros2Transforms&&) = default;
  Ros2Transforms& operator=(Ros2Transforms&&) = default;
  const tf2_msgs_msg_dds__TFMessage_& sample() const { return sample_; }

 private:
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms_;
  tf2_msgs_msg_dds__TFMessage_ sample_{};  // points into transforms_, which moving keeps in place
};
// "lrf" to "target_network" and "target_pose" at `report_ns`, and to "target_true" at `truth_ns`: those that
// are known, as in a recording. `truth` may be null. Nothing: none is known.
std::optional<Ros2Transforms> transforms(const hal::AttitudeReport& report, std::int64_t report_ns,
                                         const hal::dds::TruthSample* truth, std::int64_t truth_ns);

}  // namespace tumblesight::sim
