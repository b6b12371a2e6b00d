#include "gnc/estimation/pose_agreement.hpp"

#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kMicro = 1'000'000;

// Of the angle between two attitudes, to 100 urad up to 20 degrees.
std::int64_t angle_urad(const QuaternionQ30& a, const QuaternionQ30& b) {
  const std::int64_t cosine = cos_half_angle(a, b);
  const std::int64_t square = max<std::int64_t>(0, (std::int64_t{1} << 60) - cosine * cosine);
  const std::int64_t sine = integer_sqrt(static_cast<std::uint64_t>(square));  // Q30
  const std::int64_t cube = (((sine * sine) >> 30) * sine) >> 30;
  return (2 * (sine + cube / 6) * kMicro) >> 30;  // by the series of the arc sine
}

}  // namespace

void add_pose(const PoseEstimate& pose, const QuaternionQ30& q_lrf_trf, ErrorEvidence& evidence) {
  evidence.has_pose = (pose.doubts & (kPoseUnknown | kPoseCoasts)) == 0;
  if (!evidence.has_pose) return;
  evidence.ranges_disagree = (pose.doubts & kPoseRanges) != 0;
  evidence.silhouette_disagrees = (pose.doubts & kPoseOutline) != 0;
  evidence.lacks_motion = (pose.doubts & kPoseMotion) != 0;
  evidence.is_far = (pose.doubts & kPoseNetwork) != 0;
  constexpr std::int64_t kMost_urad = 4 * kMicro;
  std::int64_t square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t sigma_urad = min<std::int64_t>(pose.covariance.sigma[i], kMost_urad);
    square += sigma_urad * sigma_urad;
  }
  const std::int64_t angle = angle_urad(q_lrf_trf, pose.state.q_lrf_trf);
  const std::int64_t error_urad = integer_sqrt(static_cast<std::uint64_t>(square + angle * angle));
  evidence.pose_error_rad = Fixed::from_raw(divide(error_urad << Fixed::kFractionBits, kMicro));
}

}  // namespace tumblesight::gnc
