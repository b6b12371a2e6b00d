// PoseErrors: what registered poses are off by, and their summary over the sequences of a cell.
#pragma once

#include <cstddef>
#include <vector>

#include "gnc/registration/pose_tracker.hpp"
#include "sim/evaluation/target_symmetry.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

// One registered pose against the truth of its frame.
struct PoseErrors {
  bool known = false;     // there is a pose; otherwise the turn counts as 180 degrees
  bool verified = false;  // and nothing speaks against it
  double turn_deg = 180.0;
  double across_m = 0.0;  // of the TRF's origin, across and along the boresight
  double along_m = 0.0;
  double rate_deg_s = 0.0;
  double velocity_m_s = 0.0;
  bool inside_95 = false;  // turn and position lie in the 95 % ellipsoid of the stated covariance
};

// A pose as the estimator and the report of the flight program both state it.
struct StatedPose {
  gnc::PoseDoubts doubts = gnc::kPoseUnknown;
  gnc::PoseState state;
  gnc::PoseCovariance covariance;
};
StatedPose stated_pose(const gnc::PoseEstimate& estimate);

// `swath_m`: of the renderer that made the frame. The turn is that of the nearest attitude that looks the
// same.
PoseErrors pose_errors(const StatedPose& pose, const FrameTruth& truth, double swath_m,
                       const TargetSymmetry& symmetry = {});

// Over the same frame of all sequences. Shares are 0..1. Means of lengths and rates are over the poses within
// 20 degrees; NaN without any.
struct PoseSummary {
  std::size_t count = 0;
  double known = 0.0;  // 0: the model image has no surface mesh, and the other figures say nothing
  double mean_deg = 0.0;
  double mean_within_20_deg = 0.0;
  double median_deg = 0.0;
  double within_20deg = 0.0;
  double across_m = 0.0;
  double along_m = 0.0;
  double rate_deg_s = 0.0;
  double velocity_m_s = 0.0;
  double verified = 0.0;
  double verified_wrong = 0.0;  // verified and more than 5 degrees off
  double inside_95 = 0.0;       // of the verified ones; NaN without any
};
PoseSummary summarise_poses(const std::vector<PoseErrors>& poses);

}  // namespace tumblesight::sim
