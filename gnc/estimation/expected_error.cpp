#include "gnc/estimation/expected_error.hpp"

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

}  // namespace

Fixed expected_error_rad(const ErrorEvidence& evidence) {
  const Weights& w = evidence.has_pose ? kWithPose : kWithoutPose;
  const Fixed innovation = clamp(evidence.innovation_squared, Fixed{}, constant<Fixed>(kSquareOf30Degrees));
  const std::int64_t sum = w.logit * evidence.network_logit.raw() +
                           w.misfit * (static_cast<std::int64_t>(evidence.misfit) << 8) +  // from Q0.16
                           w.innovation * innovation.raw() + w.second * evidence.second_share.raw();
  const auto term = [](bool counts, std::int64_t value) { return select(counts, value, 0); };
  const bool near = !evidence.is_far;
  const bool is_explained = !evidence.ranges_disagree && !evidence.silhouette_disagrees;
  const std::int64_t of_pose = term(evidence.lacks_motion && near, w.few_poses) +
                               term(evidence.silhouette_disagrees && near, w.silhouette) +
                               term(evidence.is_far, w.far) +
                               term(evidence.is_far && is_explained, w.far_explained);
  const Fixed wrong = sigmoid(Fixed::from_raw((sum >> Fixed::kFractionBits) + w.constant + of_pose));
  const Fixed right_rad = evidence.has_pose && near ? evidence.pose_error_rad : evidence.network_error_rad;
  return right_rad + wrong * (kWrongError_rad - right_rad);
}

}  // namespace tumblesight::gnc
