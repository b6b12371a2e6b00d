// What the messages for ROS 2 hold. That nodes get them: tests/sil/ros2_bridge_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sim/console/ros2_messages.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kTime_ns = 5'400'000'007;
constexpr std::int32_t kOneQ30 = 1 << 30;

gnc::RangeImage frame_of(std::uint16_t rays, const std::vector<std::uint16_t>& ranges) {
  gnc::RangeImage frame{};
  frame.rays = rays;
  frame.fov_urad = 1'570'796;  // 90 degrees: the tangent of half of it is 1
  std::copy(ranges.begin(), ranges.end(), frame.ranges.begin());
  return frame;
}

float float_at(const sensor_msgs_msg_dds__PointCloud2_& cloud, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{cloud.data_._buffer[at + i]} << (8 * i);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void expect_point(const sensor_msgs_msg_dds__PointCloud2_& cloud, std::size_t index,
                  const std::vector<double>& expected) {
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(float_at(cloud, 16 * index + 4 * i), expected[i], 1e-5) << index << ' ' << i;
}

hal::AttitudeReport report_of(hal::Validity validity) {
  hal::AttitudeReport report;
  report.validity = validity;
  report.q_lrf_trf = {0, kOneQ30, 0, 0};  // w, x, y, z
  report.centroid_lrf_mm = {100, 30'000, -200};
  report.rate_lrf_urad_s = {1000, -2000, 3000};
  // w = 0.5, x = 0.5, y = -0.5, z = 0.5
  report.pose_q_lrf_trf = {kOneQ30 / 2, kOneQ30 / 2, -kOneQ30 / 2, kOneQ30 / 2};
  report.pose_origin_lrf_um = {250'000, 31'000'000, -125'000};
  report.pose_rate_lrf_urad_s = {4000, 5000, -6000};
  report.pose_velocity_lrf_um_s = {-10'000, 20'000, 30'000};
  report.pose_doubts = 0;
  return report;
}
hal::AttitudeReport report_without_pose() {
  hal::AttitudeReport report = report_of(hal::Validity::kDoubtful);
  report.pose_doubts = hal::kPoseDoubtUnknown;
  return report;
}
hal::dds::TruthSample truth_of(float range_m) {
  hal::dds::TruthSample truth{};
  truth.q_lrf_trf[3] = 1.0F;  // z
  truth.range_m = range_m;
  return truth;
}

void expect_vector(const geometry_msgs_msg_dds__Vector3_& v, double x, double y, double z) {
  EXPECT_NEAR(v.x_, x, 1e-12);
  EXPECT_NEAR(v.y_, y, 1e-12);
  EXPECT_NEAR(v.z_, z, 1e-12);
}
void expect_point(const geometry_msgs_msg_dds__Point_& p, double x, double y, double z) {
  expect_vector({p.x_, p.y_, p.z_}, x, y, z);
}
void expect_quaternion(const geometry_msgs_msg_dds__Quaternion_& q, double x, double y, double z, double w) {
  EXPECT_NEAR(q.x_, x, 1e-9);
  EXPECT_NEAR(q.y_, y, 1e-9);
  EXPECT_NEAR(q.z_, z, 1e-9);
  EXPECT_NEAR(q.w_, w, 1e-9);
}
void expect_header(const std_msgs_msg_dds__Header_& header) {
  EXPECT_EQ(header.stamp_.sec_, 5);
  EXPECT_EQ(header.stamp_.nanosec_, 400'000'007U);
  EXPECT_STREQ(header.frame_id_, "lrf");
}

TEST(Ros2Messages, PointsLieOnTheirRays) {
  // Rays at u, v = -0.5 and 0.5. 1280 counts are 10 m. The upper right one has no return.
  const Ros2Points points(frame_of(2, {1280, 0, 2560, 128}), kTime_ns);
  const sensor_msgs_msg_dds__PointCloud2_& cloud = points.sample();
  expect_header(cloud.header_);
  EXPECT_EQ(cloud.height_, 1U);
  ASSERT_EQ(cloud.width_, 3U);
  EXPECT_EQ(cloud.point_step_, 16U);
  EXPECT_EQ(cloud.row_step_, 48U);
  ASSERT_EQ(cloud.data_._length, 48U);
  EXPECT_FALSE(cloud.is_bigendian_);
  EXPECT_TRUE(cloud.is_dense_);
  const double s = 1.0 / std::sqrt(1.5);
  expect_point(cloud, 0, {-5.0 * s, 10.0 * s, 5.0 * s, 10.0});     // upper left
  expect_point(cloud, 1, {-10.0 * s, 20.0 * s, -10.0 * s, 20.0});  // lower left
  expect_point(cloud, 2, {0.5 * s, 1.0 * s, -0.5 * s, 1.0});       // lower right
}

TEST(Ros2Messages, FieldsOfAPointAreFloatsInOrder) {
  const Ros2Points points(frame_of(1, {1280}), kTime_ns);
  const auto& fields = points.sample().fields_;
  ASSERT_EQ(fields._length, 4U);
  const char* const names[] = {"x", "y", "z", "range"};
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_STREQ(fields._buffer[i].name_, names[i]);
    EXPECT_EQ(fields._buffer[i].offset_, 4 * i);
    EXPECT_EQ(fields._buffer[i].datatype_, 7);  // sensor_msgs/PointField FLOAT32
    EXPECT_EQ(fields._buffer[i].count_, 1U);
  }
  expect_point(points.sample(), 0, {0.0, 10.0, 0.0, 10.0});
}

TEST(Ros2Messages, AFrameWithoutReturnsHasNoPoints) {
  const Ros2Points points(frame_of(2, {0, 0, 0, 0}), kTime_ns);
  EXPECT_EQ(points.sample().width_, 0U);
  EXPECT_EQ(points.sample().data_._length, 0U);
}

TEST(Ros2Messages, AMovedMessageHasItsPoints) {
  Ros2Points first(frame_of(1, {1280}), kTime_ns);
  Ros2Points second(std::move(first));
  Ros2Points third(frame_of(1, {0}), 0);
  third = std::move(second);
  expect_point(third.sample(), 0, {0.0, 10.0, 0.0, 10.0});
  EXPECT_STREQ(third.sample().fields_._buffer[3].name_, "range");
}

TEST(Ros2Messages, TheRegisteredPoseIsPublished) {
  const auto pose = estimated_pose(report_of(hal::Validity::kValid), kTime_ns);
  ASSERT_TRUE(pose);
  expect_header(pose->sample().header_);
  expect_point(pose->sample().pose_.position_, 0.25, 31.0, -0.125);
  expect_quaternion(pose->sample().pose_.orientation_, 0.5, -0.5, 0.5, 0.5);
}

TEST(Ros2Messages, WithoutAPoseTheNetworksAttitudeIsPublished) {
  const auto pose = estimated_pose(report_without_pose(), kTime_ns);
  ASSERT_TRUE(pose);
  expect_point(pose->sample().pose_.position_, 0.1, 30.0, -0.2);
  expect_quaternion(pose->sample().pose_.orientation_, 1.0, 0.0, 0.0, 0.0);
}

TEST(Ros2Messages, WithoutAnAttitudeThereIsNeitherPoseNorTwist) {
  for (const hal::Validity validity : {hal::Validity::kStandby, hal::Validity::kNoFrame,
                                       hal::Validity::kFrameRefused, hal::Validity::kPassedOver}) {
    EXPECT_FALSE(estimated_pose(report_of(validity), kTime_ns));
    EXPECT_FALSE(estimated_twist(report_of(validity), kTime_ns));
    EXPECT_FALSE(transforms(report_of(validity), kTime_ns, nullptr, kTime_ns));
  }
}

TEST(Ros2Messages, ATwistHasRateAndVelocity) {
  const auto twist = estimated_twist(report_of(hal::Validity::kValid), kTime_ns);
  ASSERT_TRUE(twist);
  expect_header(twist->sample().header_);
  expect_vector(twist->sample().twist_.angular_, 4e-3, 5e-3, -6e-3);
  expect_vector(twist->sample().twist_.linear_, -0.01, 0.02, 0.03);
  const auto of_network = estimated_twist(report_without_pose(), kTime_ns);
  ASSERT_TRUE(of_network);
  expect_vector(of_network->sample().twist_.angular_, 1e-3, -2e-3, 3e-3);
  expect_vector(of_network->sample().twist_.linear_, 0.0, 0.0, 0.0);
}

TEST(Ros2Messages, TheTruthIsOnTheBoresight) {
  const auto pose = true_pose(truth_of(31.0F), kTime_ns);
  ASSERT_TRUE(pose);
  expect_header(pose->sample().header_);
  expect_point(pose->sample().pose_.position_, 0.0, 31.0, 0.0);
  expect_quaternion(pose->sample().pose_.orientation_, 0.0, 0.0, 1.0, 0.0);
  EXPECT_FALSE(true_pose(truth_of(std::numeric_limits<float>::quiet_NaN()), kTime_ns));
}

TEST(Ros2Messages, TransformsLeadToEachTarget) {
  const hal::dds::TruthSample truth = truth_of(31.0F);
  const auto all = transforms(report_of(hal::Validity::kValid), kTime_ns, &truth, 0);
  ASSERT_TRUE(all);
  const auto& sequence = all->sample().transforms_;
  ASSERT_EQ(sequence._length, 3U);
  EXPECT_EQ(sequence._buffer[0].header_.stamp_.sec_, 0);
  const char* const names[] = {"target_true", "target_network", "target_pose"};
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_STREQ(sequence._buffer[i].child_frame_id_, names[i]);
    EXPECT_STREQ(sequence._buffer[i].header_.frame_id_, "lrf");
    if (i > 0) expect_header(sequence._buffer[i].header_);
  }
  expect_vector(sequence._buffer[0].transform_.translation_, 0.0, 31.0, 0.0);
  expect_vector(sequence._buffer[1].transform_.translation_, 0.1, 30.0, -0.2);
  expect_quaternion(sequence._buffer[2].transform_.rotation_, 0.5, -0.5, 0.5, 0.5);
}

TEST(Ros2Messages, WhatIsNotKnownIsNoTransform) {
  const hal::dds::TruthSample truth = truth_of(std::numeric_limits<float>::quiet_NaN());
  const auto network = transforms(report_without_pose(), kTime_ns, &truth, kTime_ns);
  ASSERT_TRUE(network);
  ASSERT_EQ(network->sample().transforms_._length, 1U);
  EXPECT_STREQ(network->sample().transforms_._buffer[0].child_frame_id_, "target_network");
}

TEST(Ros2Messages, TypesHaveTheNamesOfRos2) {
  EXPECT_STREQ(sensor_msgs_msg_dds__PointCloud2__desc.m_typename, "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_STREQ(geometry_msgs_msg_dds__PoseStamped__desc.m_typename, "geometry_msgs::msg::dds_::PoseStamped_");
  EXPECT_STREQ(geometry_msgs_msg_dds__TwistStamped__desc.m_typename,
               "geometry_msgs::msg::dds_::TwistStamped_");
  EXPECT_STREQ(tf2_msgs_msg_dds__TFMessage__desc.m_typename, "tf2_msgs::msg::dds_::TFMessage_");
}

}  // namespace
}  // namespace tumblesight::sim
