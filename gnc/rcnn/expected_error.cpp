#include "gnc/rcnn/expected_error.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr double kSquareOf30Degrees = 0.26794919;

constexpr std::int64_t weight(double value) {
  return constant<Fixed>(value).raw();
}

// Weights of the regression, Q24. Sums are made in 64 bits, since Fixed would limit each of their terms.
struct Weights {
  std::int64_t constant, logit, misfit, innovation, second;
  std::int64_t few_poses, silhouette, far, far_explained;  // 0 where there is no pose
};
// Fitted to the parametric meshes of three targets under the paper's conditions and effects.
constexpr Weights kWithoutPose{
    weight(-5.5), weight(0.82), weight(13.0), weight(1.6 / kSquareOf30Degrees), weight(2.3), 0, 0, 0, 0};
constexpr Weights kWithPose{weight(-5.62), weight(0.84), weight(9.1),  weight(0.77 / kSquareOf30Degrees),
                            weight(1.6),   weight(2.33), weight(0.56), weight(3.64),
                            weight(1.32)};

// The mean of wrong attitudes: 105 degrees.
constexpr auto kWrongError_rad = constant<Fixed>(1.84);

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

Fixed expected_error_rad(const ErrorEvidence& evidence) {
  const Weights& w = evidence.has_pose ? kWithPose : kWithoutPose;
  const auto has = [&evidence](PoseDoubts doubt) { return (evidence.pose_doubts & doubt) != 0; };
  const bool is_far = has(kPoseNetwork);
  const Fixed innovation = clamp(evidence.innovation_squared, Fixed{}, constant<Fixed>(kSquareOf30Degrees));
  const std::int64_t sum = w.logit * evidence.network_logit.raw() +
                           w.misfit * (static_cast<std::int64_t>(evidence.misfit) << 8) +  // from Q0.16
                           w.innovation * innovation.raw() + w.second * evidence.second_share.raw();
  const auto term = [](bool counts, std::int64_t value) { return select(counts, value, 0); };
  const std::int64_t of_pose = term(has(kPoseMotion) && !is_far, w.few_poses) +
                               term(has(kPoseOutline) && !is_far, w.silhouette) + term(is_far, w.far) +
                               term(is_far && !has(kPoseRanges | kPoseOutline), w.far_explained);
  const Fixed wrong = sigmoid(Fixed::from_raw((sum >> Fixed::kFractionBits) + w.constant + of_pose));
  const Fixed right_rad = evidence.has_pose && !is_far ? evidence.pose_error_rad : evidence.network_error_rad;
  return right_rad + wrong * (kWrongError_rad - right_rad);
}

void add_pose(const PoseEstimate& pose, const QuaternionQ30& q_lrf_trf, ErrorEvidence& evidence) {
  evidence.has_pose = (pose.doubts & (kPoseUnknown | kPoseCoasts)) == 0;
  if (!evidence.has_pose) return;
  evidence.pose_doubts = pose.doubts;
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
