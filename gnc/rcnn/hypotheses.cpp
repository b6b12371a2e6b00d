#include "gnc/rcnn/hypotheses.hpp"

#include "gnc/nn/activation.hpp"
#include "gnc/rcnn/track_constants.hpp"

namespace tumblesight::gnc {
namespace {

// Softmax: exp(x_k - largest) over their sum, added in order.
template <class Real>
std::array<Real, shape::kHypotheses> softmax(const std::array<Real, shape::kHypotheses>& logit,
                                             Real largest) {
  std::array<Real, shape::kHypotheses> probability;
  Real sum{};
  for (int k = 0; k < shape::kHypotheses; ++k) {
    probability[k] = exp(logit[k] - largest);
    sum += probability[k];
  }
  for (Real& p : probability) p = p / sum;
  return probability;
}

}  // namespace

template <class Real>
bool same_attitude(const Matrix3<Real>& a, const Matrix3<Real>& b) {
  return trace_of_transpose_product<Real>(a, b) > kTraceOfSameAttitude<Real>;
}

template <class Real>
Hypotheses<Real> decode_hypotheses(const OutputVector<Real>& output, const Matrix3<Real>& r_lrf_view) {
  Hypotheses<Real> result;
  result.likeliest = 0;
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const Real* columns = output.data() + 6 * k;
    const Matrix3<Real> r_view_trf =
        rotation_from_columns<Real>(orthonormalize<Real>(Vector3<Real>(columns[0], columns[1], columns[2]),
                                                         Vector3<Real>(columns[3], columns[4], columns[5])));
    result.r_lrf_trf[k] = product<Real>(r_lrf_view, r_view_trf);
    result.logit[k] = output[shape::kColumns + k];
    result.likeliest = select(result.logit[k] > result.logit[result.likeliest], k, result.likeliest);
  }
  result.probability = softmax<Real>(result.logit, result.logit[result.likeliest]);
  result.predicted_error_rad = constant<Real>(kPi) * sigmoid(output[shape::kOutput - 1]);
  return result;
}

template <class Real>
Matrix3<Real> mean_attitude(const Matrix3<Real>* candidates, const Real* weights, int count, int anchor) {
  constexpr Real kZero{};
  const auto is_same = [&](int i) {
    const Real trace = trace_of_transpose_product<Real>(candidates[i], candidates[anchor]);
    return (i == anchor) | (trace > kTraceOfSameAttitude<Real>);
  };
  Real largest = kZero;
  for (int i = 0; i < count; ++i) largest = select(is_same(i) & (weights[i] > largest), weights[i], largest);
  const bool none = !(largest > kZero);
  const Real divisor = select(none, constant<Real>(1.0), largest);

  Vector3<Real> first = Vector3<Real>::Zero();
  Vector3<Real> second = Vector3<Real>::Zero();
  for (int i = 0; i < count; ++i) {
    const bool same = is_same(i);
    const Real anchor_only = select(i == anchor, constant<Real>(1.0), kZero);
    const Real weight = select(same, select(none, anchor_only, weights[i] / divisor), kZero);
    // Another candidate is replaced by the anchor, since its weight of zero times NaN would be NaN.
    const Matrix3<Real>& member = candidates[select(same, i, anchor)];
    first += scaled<Real>(Vector3<Real>(member.col(0)), weight);
    second += scaled<Real>(Vector3<Real>(member.col(1)), weight);
  }
  return rotation_from_columns<Real>(orthonormalize<Real>(first, second));
}

#define TUMBLESIGHT_INSTANTIATE(Real)                                                           \
  template bool same_attitude(const Matrix3<Real>&, const Matrix3<Real>&);                      \
  template Hypotheses<Real> decode_hypotheses(const OutputVector<Real>&, const Matrix3<Real>&); \
  template Matrix3<Real> mean_attitude(const Matrix3<Real>*, const Real*, int, int)

TUMBLESIGHT_INSTANTIATE(Fixed);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(float);
#endif

}  // namespace tumblesight::gnc
