#include "sim/console/ros2_messages.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "sim/recording/run_step.hpp"
#include "sim/recording/viewed_frame.hpp"

namespace tumblesight::sim {
namespace {

// Strings of samples are not const in C. Nobody writes to them.
char kLrf[] = "lrf";
char kTrue[] = "target_true", kNetwork[] = "target_network", kPose[] = "target_pose";
char kX[] = "x", kY[] = "y", kZ[] = "z", kRange[] = "range";

constexpr std::uint32_t kFloatBytes = 4;

std_msgs_msg_dds__Header_ header(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std_msgs_msg_dds__Header_ header{};
  header.stamp_.sec_ = static_cast<std::int32_t>(time_ns / kSecond_ns);
  header.stamp_.nanosec_ = static_cast<std::uint32_t>(time_ns % kSecond_ns);
  header.frame_id_ = kLrf;
  return header;
}

geometry_msgs_msg_dds__Point_ point(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
geometry_msgs_msg_dds__Vector3_ vector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
geometry_msgs_msg_dds__Quaternion_ quaternion(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

Eigen::Vector3d scaled(const std::array<std::int32_t, 3>& v, double unit) {
  return unit * Eigen::Vector3d(v[0], v[1], v[2]);
}
std::optional<PoseInLrf> pose_of(const hal::dds::TruthSample& truth) {
  const float* const q = truth.q_lrf_trf;
  if (!std::isfinite(truth.range_m)) return std::nullopt;
  return PoseInLrf{Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(),
                   Eigen::Vector3d(0.0, truth.range_m, 0.0)};
}

std::optional<Ros2Pose> stamped(const std::optional<PoseInLrf>& pose, std::int64_t time_ns) {
  if (!pose) return std::nullopt;
  geometry_msgs_msg_dds__PoseStamped_ sample{};
  sample.header_ = header(time_ns);
  sample.pose_.position_ = point(pose->origin_lrf_m);
  sample.pose_.orientation_ = quaternion(pose->q_lrf_trf);
  return Ros2Pose(sample);
}

sensor_msgs_msg_dds__PointField_ field(char* name, std::uint32_t index) {
  return {name, index * kFloatBytes, sensor_msgs_msg_dds__PointField_Constants_FLOAT32_, 1};
}

}  // namespace

Ros2Points::Ros2Points(const gnc::RangeImage& frame, std::int64_t time_ns)
    : fields_{field(kX, 0), field(kY, 1), field(kZ, 2), field(kRange, 3)},
      bytes_(point_bytes(frame, PointFields::kXyzRange)) {
  const auto bytes = static_cast<std::uint32_t>(bytes_.size());
  const auto fields = static_cast<std::uint32_t>(fields_.size());
  sample_.header_ = header(time_ns);
  sample_.height_ = 1;  // not organized
  sample_.width_ = bytes / kPointBytes;
  sample_.fields_ = {fields, fields, fields_.data(), false};
  sample_.is_bigendian_ = false;
  sample_.point_step_ = kPointBytes;
  sample_.row_step_ = bytes;
  sample_.data_ = {bytes, bytes, bytes_.data(), false};
  sample_.is_dense_ = true;
}

std::optional<Ros2Pose> estimated_pose(const hal::AttitudeReport& report, std::int64_t time_ns) {
  const std::optional<PoseInLrf> registered = registered_pose(report);
  return stamped(registered ? registered : network_pose(report), time_ns);
}

std::optional<Ros2Pose> true_pose(const hal::dds::TruthSample& truth, std::int64_t time_ns) {
  return stamped(pose_of(truth), time_ns);
}

std::optional<Ros2Twist> estimated_twist(const hal::AttitudeReport& report, std::int64_t time_ns) {
  if (!gives_attitude(report)) return std::nullopt;
  const bool is_registered = registered_pose(report).has_value();
  geometry_msgs_msg_dds__TwistStamped_ sample{};
  sample.header_ = header(time_ns);
  sample.twist_.angular_ =
      vector(scaled(is_registered ? report.pose_rate_lrf_urad_s : report.rate_lrf_urad_s, 1e-6));
  if (is_registered) sample.twist_.linear_ = vector(scaled(report.pose_velocity_lrf_um_s, 1e-6));
  return Ros2Twist(sample);
}

Ros2Transforms::Ros2Transforms(std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms)
    : transforms_(std::move(transforms)) {
  const auto count = static_cast<std::uint32_t>(transforms_.size());
  sample_.transforms_ = {count, count, transforms_.data(), false};
}

std::optional<Ros2Transforms> transforms(const hal::AttitudeReport& report, std::int64_t report_ns,
                                         const hal::dds::TruthSample* truth, std::int64_t truth_ns) {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> known;
  const auto add = [&known](char* child, const std::optional<PoseInLrf>& pose, std::int64_t time_ns) {
    if (!pose) return;
    known.push_back({header(time_ns), child, {vector(pose->origin_lrf_m), quaternion(pose->q_lrf_trf)}});
  };
  if (truth != nullptr) add(kTrue, pose_of(*truth), truth_ns);
  add(kNetwork, network_pose(report), report_ns);
  add(kPose, registered_pose(report), report_ns);
  if (known.empty()) return std::nullopt;
  return Ros2Transforms(std::move(known));
}

}  // namespace tumblesight::sim
