#include "sim/recording/viewed_frame.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "sim/recording/run_step.hpp"

namespace tumblesight::sim {
namespace {

void add_float32(std::vector<std::uint8_t>& bytes, double value) {
  const auto number = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
}

Eigen::Quaterniond attitude_of(const std::array<std::int32_t, 4>& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

Eigen::Vector3d scaled(const std::array<std::int32_t, 3>& v, double unit) {
  return unit * Eigen::Vector3d(v[0], v[1], v[2]);
}

}  // namespace

std::vector<std::uint8_t> point_bytes(const gnc::RangeImage& frame, PointFields fields) {
  std::vector<std::uint8_t> bytes;
  const double slope = std::tan(0.5e-6 * frame.fov_urad);
  const int rays = frame.rays;
  for (int row = 0; row < rays; ++row) {
    for (int column = 0; column < rays; ++column) {
      const std::uint16_t count = frame.ranges[static_cast<std::size_t>(row * rays + column)];
      if (count == 0) continue;
      const double range_m = count * double{gnc::RangeImage::kMetresPerCount};
      const Eigen::Vector3d direction(slope * ((2.0 * column + 1.0) / rays - 1.0), 1.0,
                                      slope * (1.0 - (2.0 * row + 1.0) / rays));
      const Eigen::Vector3d point_m = range_m * direction.normalized();
      for (int i = 0; i < 3; ++i) add_float32(bytes, point_m[i]);
      if (fields == PointFields::kXyzRange) add_float32(bytes, range_m);
    }
  }
  return bytes;
}

std::optional<PoseInLrf> network_pose(const hal::AttitudeReport& report) {
  if (!gives_attitude(report)) return std::nullopt;
  return PoseInLrf{attitude_of(report.q_lrf_trf), scaled(report.centroid_lrf_mm, 1e-3)};
}

std::optional<PoseInLrf> registered_pose(const hal::AttitudeReport& report) {
  if (!gives_attitude(report) || (report.pose_doubts & hal::kPoseDoubtUnknown) != 0) return std::nullopt;
  return PoseInLrf{attitude_of(report.pose_q_lrf_trf), scaled(report.pose_origin_lrf_um, 1e-6)};
}

}  // namespace tumblesight::sim
