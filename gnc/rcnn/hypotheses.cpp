#include "gnc/rcnn/hypotheses.hpp"

#include <algorithm>

#include "gnc/attitude/rotation.hpp"
#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

constexpr float kPi = 3.14159265F;
constexpr float kTraceOfSameAttitude = 1.0F + 2.0F * 0.93969262F;  // 1 + 2 cos 20 deg
static_assert(kSameAttitude_deg == 20.0F);

}  // namespace

bool same_attitude(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  return trace_of_transpose_product(a, b) > kTraceOfSameAttitude;
}

Hypotheses hypotheses_of(const OutputVector& output, const Eigen::Matrix3f& r_lrf_view) {
  Hypotheses result;
  const float* logits = output.data() + shape::kColumns;
  result.likeliest = 0;
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const float* six = output.data() + 6 * k;
    const Eigen::Matrix3f r_view_trf =
        rotation_from_columns(orthonormalise({six[0], six[1], six[2]}, {six[3], six[4], six[5]}));
    result.r_lrf_trf[k] = product(r_lrf_view, r_view_trf);
    result.logit[k] = logits[k];
    result.likeliest = logits[k] > logits[result.likeliest] ? k : result.likeliest;
  }
  softmax(logits, result.probability.data(), shape::kHypotheses);
  result.predicted_error_rad = kPi * sigmoid(output[shape::kOutput - 1]);
  return result;
}

Eigen::Matrix3f mean_attitude(const Eigen::Matrix3f* candidates, const float* weights, int count,
                              int anchor) {
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Vector3f second = Eigen::Vector3f::Zero();
  float total = 0.0F;
  for (int i = 0; i < count; ++i) {
    const float trace = trace_of_transpose_product(candidates[i], candidates[anchor]);
    const bool same = i == anchor || trace > kTraceOfSameAttitude;
    const float weight = same ? weights[i] : 0.0F;
    const Eigen::Matrix3f& counted = candidates[same ? i : anchor];  // zero times NaN would be NaN
    first += weight * counted.col(0);
    second += weight * counted.col(1);
    total += weight;
  }
  return rotation_from_columns(orthonormalise(first / total, second / total));
}

}  // namespace tumblesight::gnc
