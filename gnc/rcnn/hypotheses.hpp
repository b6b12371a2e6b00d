// Hypotheses: what the CNN says of one frame: several attitudes, since one frame of a nearly symmetric target
// leaves several open, with their probabilities. Real: float or Fixed.
#pragma once

#include <array>

#include "gnc/attitude/rotation.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

template <class Real>
struct Hypotheses {
  std::array<Matrix3<Real>, shape::kHypotheses> r_lrf_trf;
  std::array<Real, shape::kHypotheses> logit;
  std::array<Real, shape::kHypotheses> probability;
  int likeliest;  // the first of equals
  Real predicted_error_rad;
};

// `output` states the attitudes in the depth image's view.
template <class Real>
Hypotheses<Real> hypotheses_of(const OutputVector<Real>& output, const Matrix3<Real>& r_lrf_view);

// Attitudes nearer to each other than this are one attitude, measured twice; farther ones are alternatives.
inline constexpr float kSameAttitude_deg = 20.0F;
template <class Real>
bool same_attitude(const Matrix3<Real>& a, const Matrix3<Real>& b);

// Weighted mean of those `candidates` that are the same attitude as candidate `anchor`: their first two
// columns averaged and orthonormalised. Only ratios of the weights matter; where all are zero, the anchor.
// Not finite where the anchor is not.
template <class Real>
Matrix3<Real> mean_attitude(const Matrix3<Real>* candidates, const Real* weights, int count, int anchor);

}  // namespace tumblesight::gnc
