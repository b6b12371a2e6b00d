#include "sim/evaluation/pose_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kVerifiedWrong_deg = 5.0;
constexpr double kChiSquare6_95 = 12.5916;  // 95 % quantile with six degrees of freedom
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Matrix12 = Eigen::Matrix<double, gnc::kMotionUnknowns, gnc::kMotionUnknowns>;

// In SI units.
Matrix12 matrix_of(const gnc::PoseCovariance& covariance) {
  Matrix12 matrix;
  std::size_t place = 0;
  for (int i = 0; i < gnc::kMotionUnknowns; ++i) {
    const double sigma = 1e-6 * covariance.sigma[static_cast<std::size_t>(i)];
    matrix(i, i) = sigma * sigma;
    for (int k = 0; k < i; ++k) {
      const double correlation = std::ldexp(covariance.correlation_q15[place++], -15);
      matrix(i, k) = matrix(k, i) =
          correlation * sigma * 1e-6 * covariance.sigma[static_cast<std::size_t>(k)];
    }
  }
  return matrix;
}

Eigen::Vector3d scaled(const std::array<std::int32_t, 3>& micro) {
  return 1e-6 * Eigen::Vector3d(micro[0], micro[1], micro[2]);
}

double mean_or_none(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kNone : sum / static_cast<double>(values.size());
}

}  // namespace

StatedPose stated_pose(const gnc::PoseEstimate& estimate) {
  return {estimate.doubts, estimate.state, estimate.covariance};
}

PoseErrors pose_errors(const StatedPose& pose, const FrameTruth& truth, double swath_m,
                       const TargetSymmetry& symmetry) {
  PoseErrors errors;
  errors.known = (pose.doubts & gnc::kPoseUnknown) == 0;
  if (!errors.known) return errors;
  errors.verified = pose.doubts == 0;
  const Eigen::Quaterniond found =
      nearest_equivalent(gnc::to_double(pose.state.q_lrf_trf), truth.q_lrf_trf, symmetry);
  errors.turn_deg = kDegPerRad * angular_error_rad(truth.q_lrf_trf, found);
  const Eigen::Vector3d origin_m(swath_m * truth.offset_swaths.x(), truth.range_m,
                                 swath_m * truth.offset_swaths.y());
  const Eigen::Vector3d off_m = scaled(pose.state.origin_lrf_um) - origin_m;
  errors.across_m = std::hypot(off_m.x(), off_m.z());
  errors.along_m = std::abs(off_m.y());
  errors.rate_deg_s = kDegPerRad * (scaled(pose.state.rate_lrf_urad_s) - truth.rate_lrf_rad_s).norm();
  errors.velocity_m_s = (scaled(pose.state.velocity_lrf_um_s) - truth.velocity_lrf_m_s).norm();

  const Eigen::AngleAxisd turn((found * truth.q_lrf_trf.conjugate()).normalized());
  const double angle = turn.angle() > M_PI ? turn.angle() - 2.0 * M_PI : turn.angle();
  Eigen::Matrix<double, 6, 1> off;
  off << angle * turn.axis(), off_m;
  const Matrix12 all = matrix_of(pose.covariance);
  Eigen::Matrix<double, 6, 6> covariance;  // of turn and position
  covariance << all.block<3, 3>(0, 0), all.block<3, 3>(0, 6), all.block<3, 3>(6, 0), all.block<3, 3>(6, 6);
  errors.inside_95 = off.dot(covariance.ldlt().solve(off)) <= kChiSquare6_95;
  return errors;
}

PoseSummary summarise_poses(const std::vector<PoseErrors>& poses) {
  PoseSummary summary;
  summary.count = poses.size();
  if (poses.empty()) return summary;
  std::vector<double> all_deg, near_deg, across_m, along_m, rate_deg_s, velocity_m_s, inside;
  std::size_t known = 0, wrong = 0;
  for (const PoseErrors& pose : poses) {
    all_deg.push_back(pose.turn_deg);
    known += pose.known ? 1 : 0;
    if (pose.verified) {
      inside.push_back(pose.inside_95 ? 1.0 : 0.0);
      if (pose.turn_deg > kVerifiedWrong_deg) ++wrong;
    }
    if (pose.turn_deg > kWrong_deg) continue;
    near_deg.push_back(pose.turn_deg);
    across_m.push_back(pose.across_m);
    along_m.push_back(pose.along_m);
    rate_deg_s.push_back(pose.rate_deg_s);
    velocity_m_s.push_back(pose.velocity_m_s);
  }
  const auto count = static_cast<double>(poses.size());
  summary.known = static_cast<double>(known) / count;
  summary.mean_deg = mean_or_none(all_deg);
  summary.mean_within_20_deg = mean_or_none(near_deg);
  summary.median_deg = median(all_deg);
  summary.within_20deg = static_cast<double>(near_deg.size()) / count;
  summary.across_m = mean_or_none(across_m);
  summary.along_m = mean_or_none(along_m);
  summary.rate_deg_s = mean_or_none(rate_deg_s);
  summary.velocity_m_s = mean_or_none(velocity_m_s);
  summary.verified = static_cast<double>(inside.size()) / count;
  summary.verified_wrong = static_cast<double>(wrong) / count;
  summary.inside_95 = mean_or_none(inside);
  return summary;
}

}  // namespace tumblesight::sim
