#include "gnc/rcnn/hypotheses.hpp"

#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

template <class Real>
constexpr Real kTraceOfSameAttitude = constant<Real>(1.0 + 2.0 * 0.93969262078590838);  // 1 + 2 cos 20 deg
static_assert(kSameAttitude_deg == 20.0F);

// exp(x_k) over their sum, added in order, with the largest subtracted first.
template <class Real>
std::array<Real, shape::kHypotheses> softmax(const std::array<Real, shape::kHypotheses>& logit,
                                             Real largest) {
  std::array<Real, shape::kHypotheses> share;
  Real sum{};
  for (int k = 0; k < shape::kHypotheses; ++k) {
    share[k] = exp(logit[k] - largest);
    sum += share[k];
  }
  for (Real& one : share) one = one / sum;
  return share;
}

}  // namespace

template <class Real>
bool same_attitude(const Matrix3<Real>& a, const Matrix3<Real>& b) {
  return trace_of_transpose_product<Real>(a, b) > kTraceOfSameAttitude<Real>;
}

template <class Real>
Hypotheses<Real> hypotheses_of(const OutputVector<Real>& output, const Matrix3<Real>& r_lrf_view) {
  Hypotheses<Real> result;
  result.likeliest = 0;
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const Real* six = output.data() + 6 * k;
    const Matrix3<Real> r_view_trf = rotation_from_columns<Real>(
        orthonormalise<Real>(Vector3<Real>(six[0], six[1], six[2]), Vector3<Real>(six[3], six[4], six[5])));
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
    const Real alone = select(i == anchor, constant<Real>(1.0), kZero);
    const Real weight = select(same, select(none, alone, weights[i] / divisor), kZero);
    const Matrix3<Real>& counted = candidates[select(same, i, anchor)];  // zero times NaN would be NaN
    first += scaled<Real>(Vector3<Real>(counted.col(0)), weight);
    second += scaled<Real>(Vector3<Real>(counted.col(1)), weight);
  }
  return rotation_from_columns<Real>(orthonormalise<Real>(first, second));
}

#define TUMBLESIGHT_INSTANTIATE(Real)                                                       \
  template bool same_attitude(const Matrix3<Real>&, const Matrix3<Real>&);                  \
  template Hypotheses<Real> hypotheses_of(const OutputVector<Real>&, const Matrix3<Real>&); \
  template Matrix3<Real> mean_attitude(const Matrix3<Real>*, const Real*, int, int)

TUMBLESIGHT_INSTANTIATE(Fixed);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(float);
#endif

}  // namespace tumblesight::gnc
