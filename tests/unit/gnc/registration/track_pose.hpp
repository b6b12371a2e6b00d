// TrackPose: a track of poses, frame by frame, of a body that spins before the sensor.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "gnc/registration/pose_tracker.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {

inline constexpr Sensor kSensor{128, 16.0};
inline constexpr double kDepth_m = 20.0;
inline constexpr double kLargestError_deg = 0.6;
inline constexpr double kDegree = M_PI / 180.0;

inline Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  return angle == 0.0 ? Eigen::Matrix3d::Identity()
                      : Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
}
inline Matrix3<Fixed> fixed_rotation(const Eigen::Matrix3d& r) {
  return fixed({r, {0.0, 0.0, 0.0}}).r_lrf_trf;
}
inline double angle_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(Eigen::Quaterniond(a.transpose() * b).normalized()).angle() / kDegree;
}
inline Eigen::Matrix3d attitude_of(const PoseEstimate& estimate) {
  return to_double(estimate.state.q_lrf_trf).normalized().toRotationMatrix();
}

// A body that spins before the sensor, and a network that sees it a degree or two off.
class TrackPose : public testing::Test {
 protected:
  // The next frame, a nominal period later.
  void see() {
    if (frames_++ > 0) pass_a_period();
    const auto depths_m = cast(shown_, truth_, sensor_);
    frame_.emplace(sensor_);
    Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
    int returns = 0;
    for (int i = 0; i < sensor_.rays * sensor_.rays; ++i) {
      const double depth_m = depths_m[static_cast<std::size_t>(i)];
      if (depth_m == kNothing) continue;
      const int row = i / sensor_.rays, column = i % sensor_.rays;
      const Eigen::Vector3d direction = ray(sensor_, row, column);
      const double range_m = depth_m * direction.norm();
      if (lost_ > 0.0 && random_.happens(lost_)) continue;
      frame_->add(row, column, range_m + noise_ * (0.1 + 0.01 * range_m) * random_.normal());
      sum_m += depth_m * direction;
      ++returns;
    }
    centroid_m_ = sum_m / std::max(returns, 1);
  }
  // Returns of the target in the upper left corner, where it is not: a share of those that it has.
  void add_patch(double share) {
    int returns = 0;
    for (const RayMask::Row& row : frame_->mask->rows)
      for (const std::uint32_t word : row) returns += count_ones(word);
    const int side = static_cast<int>(std::lround(std::sqrt(share * returns)));
    for (int row = 2; row < 2 + side; ++row)
      for (int column = 2; column < 2 + side; ++column) frame_->add(row, column, kDepth_m);
  }
  // Loses a share of the outermost rays of the target in every row and column, so that its silhouette is too
  // small.
  void lose_rim(double share = 1.0) {
    const RayMask all = *frame_->mask;
    const auto is_inside = [&](int row, int column) {
      return all.has(row - 1, column) && all.has(row + 1, column) && all.has(row, column - 1) &&
             all.has(row, column + 1);
    };
    for (int row = 1; row + 1 < sensor_.rays; ++row) {
      for (int column = 1; column + 1 < sensor_.rays; ++column) {
        if (!all.has(row, column) || is_inside(row, column) || !random_.happens(share)) continue;
        frame_->mask->rows[static_cast<std::size_t>(row)]
                          [static_cast<std::size_t>(column / RayMask::kColumnsPerWord)] &=
            ~(0x8000'0000U >> (column % RayMask::kColumnsPerWord));
        frame_->image->ranges[static_cast<std::size_t>(row * sensor_.rays + column)] = 0;
      }
    }
  }
  // The next frame, which the target does not explain: by noisy ranges (0), missing returns (1), returns
  // beside it (2) or a silhouette that is too small (3).
  void see_unexplained(int kind) {
    noise_ = kind == 0 ? 1.5 : 1.0;
    lost_ = kind == 1 ? 0.75 : 0.0;
    see();
    if (kind == 2) add_patch(0.05);
    if (kind == 3) lose_rim();
  }
  // From now on the body tumbles, and the tracker knows its inertia.
  void tumble() {
    inertia_trf_ = Eigen::Vector3d(1.3, 0.6, 1.1).asDiagonal();
    Matrix3<Fixed> tensor = Matrix3<Fixed>::Zero();
    for (int i = 0; i < 3; ++i) tensor(i, i) = Fixed(inertia_trf_(i, i));
    Inertia<Fixed> inertia;
    ASSERT_TRUE(make_inertia<Fixed>(tensor, inertia));
    motion_models_ = motion_models<Fixed>(inertia);
    rate_ = {0.4, 0.3, -0.3};
  }
  // What is left of the time between two frames, of which see() passes a nominal period.
  void pass_until(std::int64_t period_ns) {
    const double periods = static_cast<double>(period_ns) / kNominalPeriod_ns - 1.0;
    truth_.r_lrf_trf = rotation_of(periods * rate_) * truth_.r_lrf_trf;
  }
  // Without torque; Euler's method in a thousand steps.
  void pass_a_period() {
    constexpr int kSteps = 1000;
    const Eigen::Matrix3d r = truth_.r_lrf_trf;
    const Eigen::Vector3d momentum = r * inertia_trf_ * r.transpose() * rate_;
    for (int i = 0; i < kSteps; ++i) {
      truth_.r_lrf_trf = rotation_of(rate_ / kSteps) * truth_.r_lrf_trf;
      rate_ = truth_.r_lrf_trf * inertia_trf_.inverse() * truth_.r_lrf_trf.transpose() * momentum;
    }
  }
  // The network's attitude is `turn_rad` away from the true one.
  PoseEstimate track(const Eigen::Vector3d& turn_rad, const Eigen::Matrix3d& second, std::uint32_t odds_ppm) {
    const Eigen::Vector3d network_rate = rate_ + rate_error_;
    const PoseFrame frame{
        *frame_->image,
        *frame_->mask,
        period_ns_,
        fixed_rotation(turn_of_sensor_),
        {fixed_rotation(rotation_of(turn_rad) * truth_.r_lrf_trf),
         {Fixed(network_rate.x()), Fixed(network_rate.y()), Fixed(network_rate.z())}},
        fixed_rotation(second),
        odds_ppm,
        {static_cast<std::int32_t>(1e3 * centroid_m_.x()), static_cast<std::int32_t>(1e3 * centroid_m_.y()),
         static_cast<std::int32_t>(1e3 * centroid_m_.z())},
        motion_models_,
        network_motion_model_};
    // In flight other stages use this memory between the frames.
    std::memset(static_cast<void*>(scratch_.get()), left_in_scratch_, sizeof *scratch_);
    PoseEstimate estimate;
    track_pose({has_mesh_ ? section_.mesh() : SurfaceMesh(), radius_mm_, stated_noise_}, frame, *scratch_,
               *vertices_, *state_, estimate, budget_, deadline_);
    return estimate;
  }
  // Another target than the lopsided body; before the first frame.
  void take(const Body& body) {
    body_ = shown_ = rounded(body);
    section_ = MeshSection(body_);
    radius_mm_ = static_cast<std::uint32_t>(1e3 * body_.radius_m);
  }
  // As the network usually sees it.
  PoseEstimate track_seen() {
    const Eigen::Vector3d usual = random_.vector(kDegree);
    return track(network_turn_.value_or(usual), truth_.r_lrf_trf, 0);
  }
  PoseEstimate track_next() {
    see();
    return track_seen();
  }
  PoseEstimate track_frames(int count) {
    PoseEstimate estimate;
    for (int k = 0; k < count; ++k) estimate = track_next();
    return estimate;
  }

  Random random_{11};
  Body body_ = rounded(lopsided_body());
  Body shown_ = body_;
  // Share of the returns that are lost, and noise of the ranges over that of the paper's sensor.
  double lost_ = 0.0, noise_ = 1.0;
  RangeNoise stated_noise_;
  MeshSection section_{body_};
  bool has_mesh_ = true;
  std::uint32_t radius_mm_ = 2500;
  ExactPose truth_{random_.rotation(), {0.1, kDepth_m, -0.05}};
  Eigen::Vector3d rate_{0.2, -0.1, 0.15};                 // [rad per period]
  Eigen::Vector3d rate_error_ = Eigen::Vector3d::Zero();  // of the network
  std::optional<Eigen::Vector3d> network_turn_;           // by which its attitude is wrong; a degree or two
  Eigen::Matrix3d turn_of_sensor_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inertia_trf_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centroid_m_;
  Sensor sensor_ = kSensor;
  std::optional<Frame> frame_;
  int frames_ = 0;
  std::int64_t period_ns_ = kNominalPeriod_ns;
  std::int32_t budget_ = WorkBudget::kOfAFrame;
  Deadline* deadline_ = nullptr;
  int left_in_scratch_ = 0xA5;
  int network_motion_model_ = kSpinModel;
  MotionModels<Fixed> motion_models_ = motion_models<Fixed>(Inertia<Fixed>());
  std::unique_ptr<PoseScratch> scratch_ = std::make_unique<PoseScratch>();
  std::unique_ptr<ScreenVertices> vertices_ = std::make_unique<ScreenVertices>();
  std::unique_ptr<PoseTrackerState> state_ = std::make_unique<PoseTrackerState>();
};

}  // namespace tumblesight::gnc
