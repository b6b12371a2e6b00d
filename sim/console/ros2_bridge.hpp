// Ros2Bridge: publishes a run to the ROS 2 nodes of this machine, over DDS as they have it and without any
// package of ROS 2. It has a DDS domain of its own on loopback, apart from that of the run, and only writes.
//
//   /lidar/points      sensor_msgs/PointCloud2      the returns of a frame
//   /target/pose       geometry_msgs/PoseStamped    the registered pose, else the network's attitude
//   /target/pose_true  geometry_msgs/PoseStamped    the truth
//   /target/twist      geometry_msgs/TwistStamped   angular rate and velocity
//   /tf                tf2_msgs/TFMessage           lrf to target_true, target_network and target_pose
//
// Stamps are mission time: of the exposure, or of the step if its report has none; from 0 on, as in a
// recording.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sim/console/ros2_writer.hpp"
#include "sim/console/run_source.hpp"

namespace tumblesight::sim {

class Ros2Bridge {
 public:
  static constexpr std::uint32_t kMostDomain = 232;  // of ROS_DOMAIN_ID
  static constexpr std::uint64_t kStepsPerPoll = 8;  // fewer than a reader keeps

  // `run` must outlive the object. `domain`: the ROS_DOMAIN_ID of the nodes; it may be the DDS domain of the
  // run. Throws std::runtime_error if DDS cannot be set up.
  Ros2Bridge(const RunSource& run, std::uint32_t domain);

  // Publishes what is new since the last call. It begins with the newest step: of a recording, that is the
  // last one. A node that comes late gets the newest message of each topic. Calls must not overlap.
  void poll();
  // Why something could not be published, last; empty: all could.
  const std::string& failure() const { return failure_; }

 private:
  void begin_run();
  void publish_step(const LoggedStep& step);
  void publish_points();
  std::int64_t shown_time_ns(std::int64_t time_ns) const;

  const RunSource& run_;
  Ros2Domain domain_;
  Ros2Writer<Ros2Points> points_;
  Ros2Writer<Ros2Pose> pose_, true_pose_;
  Ros2Writer<Ros2Twist> twist_;
  Ros2Writer<Ros2Transforms> transforms_;
  std::uint32_t run_id_ = 0;
  std::uint64_t next_ = 0, next_frame_ = 0;  // steps to publish
  std::optional<std::int64_t> first_ns_;    // of the first step of the run, or of the first that is published
  std::unique_ptr<gnc::RangeImage> frame_;  // large
  std::string failure_;
};

}  // namespace tumblesight::sim
