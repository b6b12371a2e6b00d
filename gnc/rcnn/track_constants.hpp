// The constants of the attitude track: attitude_track.cpp, and on the ground its form in ONNX.
#pragma once

#include <array>

#include "gnc/rcnn/hypotheses.hpp"

namespace tumblesight::gnc {

// Of a^T b, for attitudes a and b that are kSameAttitude_deg apart: 1 + 2 cos 20 degrees.
template <class Real>
constexpr Real kTraceOfSameAttitude = constant<Real>(1.0 + 2.0 * 0.93969262078590838);
static_assert(kSameAttitude_deg == 20.0F);

inline constexpr double kMinProbability =
    1e-6;  // so that the weights of a group of candidates are never all zero
inline constexpr double kMaxCorrection = 8.0;  // of the logarithm of a weight, by the network

// Gains of the recursive least-squares fit of a straight line to k equally good measurements: attitude gain
// a = 2 (2k - 1) / (k (k + 1)), ratio of the rate gain to it 3 / (2k - 1). Constant from k = 10 on, so that
// the track keeps responding to measurements.
inline constexpr int kGains = 10;

template <class Real>
struct FilterGains {
  Real predicted_weight;  // of the predicted attitude relative to the hypotheses of a frame: (1 - a) / a
  Real rate_logit;        // logit of the ratio of the rate gain to the attitude gain
  Real evidence;  // decrease of a motion model's log-likelihood per squared innovation: (1 - a) / (2 a^2)
};

template <class Real>
constexpr FilterGains<Real> gains(double predicted_weight, double rate_logit, double evidence) {
  return {constant<Real>(predicted_weight), constant<Real>(rate_logit), constant<Real>(evidence)};
}

template <class Real>
constexpr std::array<FilterGains<Real>, kGains> kFilterGains{
    {gains<Real>(0.0003, 6.9067548, 0.0), gains<Real>(0.0003, 6.9067548, 0.0),
     gains<Real>(0.2, 0.40546511, 0.12), gains<Real>(0.42857143, -0.28768207, 0.30612245),
     gains<Real>(0.66666667, -0.69314718, 0.55555556), gains<Real>(0.90909091, -0.98082925, 0.8677686),
     gains<Real>(1.1538462, -1.2039728, 1.2426036), gains<Real>(1.4, -1.3862944, 1.68),
     gains<Real>(1.6470588, -1.540445, 2.1799308), gains<Real>(1.8947368, -1.6739764, 2.7423823)}};

inline constexpr double kMinVariance_rad2 = 7e-4;  // of the attitude of a frame: (1.5 degrees)^2
inline constexpr double kMinLogLikelihood = -6.0;
inline constexpr double kMaxEvidence = 64.0;     // against a motion model by one frame
inline constexpr double kLikelihoodDecay = 0.9;  // factor on the log-likelihoods per frame
inline constexpr double kLostTargetInnovation = 2.0 * (1.0 - 0.93969262);  // squared innovation of 20 degrees
// Sum over the hypotheses near the prediction of a motion model. With less, the motion model has lost the
// target.
inline constexpr double kMinProbabilityNearPrediction = 0.1;

}  // namespace tumblesight::gnc
