// Hypotheses: the attitudes that the CNN derives from one frame, with their probabilities. There are several,
// since one frame of a nearly symmetric target does not determine the attitude. Real: float or Fixed (Q7.24).
#pragma once

#include <array>

#include "gnc/attitude/rotation.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

template <class Real>
struct Hypotheses {
  std::array<Matrix3<Real>, shape::kHypotheses> r_lrf_trf;  // v_lrf = r_lrf_trf v_trf
  std::array<Real, shape::kHypotheses> logit;
  std::array<Real, shape::kHypotheses> probability;  // softmax of the logits
  int likeliest;             // index of the largest logit; the first if several are equal
  Real predicted_error_rad;  // expected error of the likeliest one, 0..pi
};

// Hypotheses from the output of the CNN, which states the attitudes in the view frame of the depth image.
// `r_lrf_view`: v_lrf = r_lrf_view v_view. Non-finite outputs give non-finite attitudes.
template <class Real>
Hypotheses<Real> decode_hypotheses(const OutputVector<Real>& output, const Matrix3<Real>& r_lrf_view);

// Attitudes closer than this are measurements of the same attitude; others are alternatives.
inline constexpr float kSameAttitude_deg = 20.0F;
template <class Real>
bool same_attitude(const Matrix3<Real>& a, const Matrix3<Real>& b);

// Weighted mean of the candidates that are the same attitude as the candidate `anchor`: their first two
// columns are averaged and orthonormalized.
//
// candidates  `count` rotation matrices; non-finite ones are skipped, but a non-finite anchor
//             gives a non-finite result
// weights     `count` weights >= 0; only their ratios matter. If all are zero the result is the anchor
template <class Real>
Matrix3<Real> mean_attitude(const Matrix3<Real>* candidates, const Real* weights, int count, int anchor);

}  // namespace tumblesight::gnc
