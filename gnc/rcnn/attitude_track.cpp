#include "gnc/rcnn/attitude_track.hpp"

#include <algorithm>

#include "gnc/attitude/quaternion.hpp"
#include "gnc/nn/activation.hpp"
#include "gnc/rcnn/track_constants.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kCandidates = shape::kCandidates;

// False for a damaged state: not finite, or not a rotation.
template <class Real>
bool is_valid(const Motion<Real>& motion) {
  const Real trace = trace_of_transpose_product<Real>(motion.r_lrf_trf, motion.r_lrf_trf);
  const Vector3<Real>& rate = motion.rate_lrf;
  const bool is_rotation = abs(trace - constant<Real>(3.0)) < constant<Real>(0.1);
  const bool has_rate = is_finite((rate.x() + rate.y()) + rate.z());
  return is_rotation & has_rate;
}

template <class Real>
bool is_valid(const AttitudeTrack<Real>& track) {
  bool valid = true;
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    valid &= is_valid<Real>(track.motion[motion_model]);
    valid &= is_finite(track.log_likelihood[motion_model]);
  }
  return valid;
}

// Weights of the candidates: probability times exp(correction) for a hypothesis, predicted_weight times
// exp(correction) for the predicted attitude. All are divided by a common factor, so that they stay within
// the range of Real.
template <class Real>
std::array<Real, kCandidates> candidate_weights(const Hypotheses<Real>& hypotheses, const Real* corrections,
                                                Real predicted_weight) {
  constexpr Real kBound = constant<Real>(kMaxCorrection);
  std::array<Real, kCandidates> weights;
  Real largest = -kBound;
  for (int i = 0; i < kCandidates; ++i) {
    weights[i] = clamp(corrections[i], -kBound, kBound);
    largest = max(largest, weights[i]);
  }
  for (int i = 0; i < kCandidates; ++i) {
    const Real prior = i < shape::kHypotheses
                           ? max(constant<Real>(kMinProbability), hypotheses.probability[i])
                           : predicted_weight;
    weights[i] = exp(weights[i] - largest) * prior;
  }
  return weights;
}

// The candidate with the largest corrected logit. The logit of the predicted attitude is 0 before the
// correction.
template <class Real>
int choose_anchor(const Hypotheses<Real>& hypotheses, const Real* corrections) {
  int anchor = 0;
  Real largest = hypotheses.logit[0] + corrections[0];
  for (int i = 1; i < kCandidates; ++i) {
    const Real value = (i < shape::kHypotheses ? hypotheses.logit[i] : Real{}) + corrections[i];
    anchor = select(value > largest, i, anchor);
    largest = max(largest, value);
  }
  return anchor;
}

// Sum over the hypotheses that are this attitude.
template <class Real>
Real probability_of(const Hypotheses<Real>& hypotheses, const Matrix3<Real>& r_lrf_trf) {
  Real probability{};
  for (int i = 0; i < shape::kHypotheses; ++i) {
    const bool is_near = same_attitude<Real>(hypotheses.r_lrf_trf[i], r_lrf_trf);
    probability += select(is_near, hypotheses.probability[i], Real{});
  }
  return probability;
}

// Squared angle between the attitude that a motion model predicted and the result, at most
// kLostTargetInnovation: the motion model has lost the target. That is also the value if the hypotheses show
// nothing near the prediction, since the result may then be the prediction itself.
template <class Real>
Real squared_innovation(const Hypotheses<Real>& hypotheses, const Motion<Real>& predicted,
                        const Matrix3<Real>& r_lrf_trf) {
  constexpr Real kLost = constant<Real>(kLostTargetInnovation);
  const Real probability_near = probability_of<Real>(hypotheses, predicted.r_lrf_trf);
  const Real innovation_squared =
      constant<Real>(3.0) - trace_of_transpose_product<Real>(predicted.r_lrf_trf, r_lrf_trf);
  return select(probability_near < constant<Real>(kMinProbabilityNearPrediction), kLost,
                min(innovation_squared, kLost));
}

// The largest innovation that corrects the rate, as a versine. Larger ones are a change to another attitude
// of a symmetric target: 60 degrees after one nominal period. While the rate is being found, the limit grows
// with the turn that is possible in the time, from 10 degrees after none to 150 degrees after 2.5 periods.
Fixed largest_versine(Fixed periods, bool finds_rate) {
  constexpr auto kOne = constant<Fixed>(1.0);
  constexpr auto kNominal = constant<Fixed>(kVersineOf60Degrees);
  constexpr auto kPerPeriod = constant<Fixed>((kVersineOf150Degrees - kVersineOf60Degrees) / 1.5);
  const Fixed grown =
      min(constant<Fixed>(kVersineOf150Degrees), kNominal + (max(periods, kOne) - kOne) * kPerPeriod);
  const Fixed angle = constant<Fixed>(0.17453293) + constant<Fixed>(0.87266463) * periods;
  const Fixed half_square = constant<Fixed>(0.5) * angle * angle;
  const Fixed reduced = half_square - constant<Fixed>(1.0 / 6.0) * half_square * half_square;
  return select(periods < kOne, reduced, select(finds_rate, grown, kNominal));
}

// How an innovation changes the rate.
template <class Real>
struct RateCorrection {
  Real gain;             // on the innovation per nominal period
  Real periods;          // since the last frame
  Real largest_versine;  // of an innovation that counts
};

// The motion after the measurement `r_lrf_trf`.
template <class Real>
Motion<Real> corrected(const Motion<Real>& predicted, const Matrix3<Real>& r_lrf_trf,
                       const RateCorrection<Real>& correction) {
  const Matrix3<Real> lrf_predicted = predicted.r_lrf_trf.transpose();
  const Vector3<Real> innovation =
      rotation_vector<Real>(product<Real>(r_lrf_trf, lrf_predicted), correction.largest_versine);
  Vector3<Real> change;
  for (int i = 0; i < 3; ++i) change[i] = correction.gain * innovation[i] / correction.periods;
  return {r_lrf_trf, predicted.rate_lrf + change};
}

// The value by which the motion models are compared: log-likelihood minus required evidence.
template <class Real>
Real score(const AttitudeTrack<Real>& track, int motion_model) {
  constexpr std::array<Real, kMotionModels> kRequired{
      constant<Real>(kRequiredEvidence[0]), constant<Real>(kRequiredEvidence[1]),
      constant<Real>(kRequiredEvidence[2]), constant<Real>(kRequiredEvidence[3]),
      constant<Real>(kRequiredEvidence[4])};
  return track.log_likelihood[motion_model] - kRequired[motion_model];
}

// Evidence of a frame against a motion model with this squared innovation.
template <class Real>
Real evidence_against(Real innovation_squared, Real evidence, Real variance_rad2) {
  return min(constant<Real>(kMaxEvidence), evidence * innovation_squared / variance_rad2);
}

// Lowers the log-likelihood of each motion model by the evidence against it. A motion model that has lost the
// target takes over the motion of the best motion model that has not.
template <class Real>
void weigh_motion_models(const std::array<Real, kMotionModels>& innovation_squared, Real evidence,
                         Real variance_rad2, AttitudeTrack<Real>& track) {
  constexpr Real kLost = constant<Real>(kLostTargetInnovation);
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    track.log_likelihood[motion_model] =
        constant<Real>(kLikelihoodDecay) * track.log_likelihood[motion_model] -
        evidence_against<Real>(innovation_squared[motion_model], evidence, variance_rad2);
  }
  Real likeliest = track.log_likelihood[0];
  for (const Real value : track.log_likelihood) likeliest = max(likeliest, value);
  int best = 0;
  bool any_follows = false;
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    track.log_likelihood[motion_model] =
        max(constant<Real>(kMinLogLikelihood), track.log_likelihood[motion_model] - likeliest);
    const bool follows = innovation_squared[motion_model] < kLost;
    best = select(follows & (!any_follows | (score(track, motion_model) > score(track, best))), motion_model,
                  best);
    any_follows |= follows;
  }
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    const bool takes_over = any_follows & !(innovation_squared[motion_model] < kLost);
    track.motion[motion_model] = track.motion[select(takes_over, best, motion_model)];
  }
}

}  // namespace

template <class Real>
int AttitudeTrack<Real>::motion_model() const {
  int best = kSpinModel;
  for (int motion_model = 1; motion_model < kMotionModels; ++motion_model)
    best = select(score(*this, motion_model) > score(*this, best), motion_model, best);
  return best;
}

template <class Real>
void AttitudeTrack<Real>::forget_rate(bool forgets) {
  const Motion<Real> at_rest{motion[this->motion_model()].r_lrf_trf, Vector3<Real>::Zero()};
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    const std::array<Motion<Real>, 2> choice{motion[motion_model], at_rest};
    motion[motion_model] = choice[forgets];
    log_likelihood[motion_model] = select(forgets, Real{}, log_likelihood[motion_model]);
  }
  frames = select(forgets, min<std::uint32_t>(frames, 1), frames);
}

template <class Real>
Prediction<Real> predict(const AttitudeTrack<Real>& track, const MotionModels<Real>& motion_models,
                         const Hypotheses<Real>& hypotheses, const FrameInterval& interval) {
  const bool has_track = (track.frames > 0) & is_valid(track);
  // Without a track the motion is not used, and the time of one period is spent.
  const std::int64_t elapsed_ns =
      select(has_track, clamp<std::int64_t>(interval.elapsed_ns, kShortestInterval_ns, kLongestInterval_ns),
             kNominalPeriod_ns);
  const Matrix3<Real> r_now_last = converted<Real>(rotation_from_quaternion(interval.q_now_last));
  // Both alternatives are computed in every frame, so that the time depends on the interval only.
  std::array<Motion<Real>, 2> choice{};  // [0] without a track, [1] with a track
  choice[0] = {hypotheses.r_lrf_trf[hypotheses.likeliest], Vector3<Real>::Zero()};
  Prediction<Real> prediction;
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    choice[1] = turned<Real>(
        propagate<Real>(track.motion[motion_model], motion_models[motion_model], elapsed_ns), r_now_last);
    prediction.motion[motion_model] = choice[has_track];
  }
  prediction.motion_model = select(has_track, track.motion_model(), kSpinModel);
  prediction.elapsed_periods = in_periods(elapsed_ns);
  prediction.has_track = has_track;
  return prediction;
}

template <class Real>
bool keep_confirmed(const Hypotheses<Real>& hypotheses, const FrameInterval& interval,
                    Prediction<Real>& prediction, AttitudeTrack<Real>& track) {
  const bool confirmed = probability_of<Real>(hypotheses, prediction.r_lrf_trf()) >
                         constant<Real>(kMinProbabilityNearPrediction);
  const Matrix3<Real> r_now_last = converted<Real>(rotation_from_quaternion(interval.q_now_last));
  const std::array<Motion<Real>, 2> last{prediction.motion[0],
                                         turned<Real>(track.motion[track.motion_model()], r_now_last)};
  const Motion<Real> at_rest{last[prediction.has_track].r_lrf_trf, Vector3<Real>::Zero()};
  const Motion<Real> first =
      corrected<Real>(at_rest, hypotheses.r_lrf_trf[hypotheses.likeliest],
                      {constant<Real>(1.0), converted<Real>(prediction.elapsed_periods),
                       constant<Real>(kVersineOf150Degrees)});
  for (Motion<Real>& motion : prediction.motion) {
    const std::array<Motion<Real>, 2> choice{first, motion};
    motion = choice[confirmed];
  }
  const std::array<AttitudeTrack<Real>, 2> choice{AttitudeTrack<Real>{}, track};
  track = choice[confirmed];
  prediction.motion_model = select(confirmed, prediction.motion_model, kSpinModel);
  prediction.has_track &= confirmed;
  return confirmed;
}

template <class N>
void fill_lstm_input(const Features<N>& features, const Hypotheses<typename N::Real>& hypotheses,
                     const Matrix3<typename N::Real>& predicted_r_lrf_trf, LstmInput<N>& input) {
  using Real = typename N::Real;
  auto* next = std::copy(features.begin(), features.end(), input.begin());
  const auto append_columns = [&next](const Matrix3<Real>& rotation) {
    for (int column = 0; column < 2; ++column) {
      for (int row = 0; row < 3; ++row) to_input(rotation(row, column), *next++);
    }
  };
  for (const Matrix3<Real>& r_lrf_trf : hypotheses.r_lrf_trf) {
    append_columns(transpose_product<Real>(predicted_r_lrf_trf, r_lrf_trf));
  }
  for (const Real probability : hypotheses.probability) to_input(probability, *next++);
  append_columns(predicted_r_lrf_trf);
}

template <class Real>
TrackedAttitude<Real> advance(const Hypotheses<Real>& hypotheses, const Prediction<Real>& prediction,
                              const HeadOutput<Real>& head, AttitudeTrack<Real>& track) {
  const std::array<AttitudeTrack<Real>, 2> choice{AttitudeTrack<Real>{}, track};  // [0] damaged, [1] valid
  track = choice[is_valid(track)];
  const FilterGains<Real>& filter = kFilterGains<Real>[std::min<std::uint32_t>(track.frames, kGains - 1)];
  const Real* corrections = head.data();
  const int anchor = choose_anchor<Real>(hypotheses, corrections);
  const auto weights =
      candidate_weights<Real>(hypotheses, corrections + kCandidates, filter.predicted_weight);
  const Real learned_gain = sigmoid(filter.rate_logit + corrections[2 * kCandidates]);
  const RateCorrection<Real> rate_correction{
      select(track.frames > 0, learned_gain, Real{}), converted<Real>(prediction.elapsed_periods),
      converted<Real>(largest_versine(prediction.elapsed_periods, track.frames < kGains))};

  std::array<Matrix3<Real>, kCandidates> candidates;
  std::copy(hypotheses.r_lrf_trf.begin(), hypotheses.r_lrf_trf.end(), candidates.begin());
  std::array<Real, kMotionModels> innovation_squared;
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    candidates[shape::kHypotheses] = prediction.motion[motion_model].r_lrf_trf;
    const Matrix3<Real> r_lrf_trf =
        mean_attitude<Real>(candidates.data(), weights.data(), kCandidates, anchor);
    innovation_squared[motion_model] =
        squared_innovation<Real>(hypotheses, prediction.motion[motion_model], r_lrf_trf);
    track.motion[motion_model] = corrected<Real>(prediction.motion[motion_model], r_lrf_trf, rate_correction);
  }
  const Real predicted_error_rad = constant<Real>(kPi) * sigmoid(corrections[2 * kCandidates + 1]);
  const Real variance_rad2 =
      max(constant<Real>(kMinVariance_rad2), predicted_error_rad * predicted_error_rad);
  weigh_motion_models<Real>(innovation_squared, filter.evidence, variance_rad2, track);
  ++track.frames;
  return {track.motion[track.motion_model()].r_lrf_trf, predicted_error_rad};
}

#define TUMBLESIGHT_INSTANTIATE(N)                                                                          \
  template struct AttitudeTrack<N::Real>;                                                                   \
  template bool keep_confirmed(const Hypotheses<N::Real>&, const FrameInterval&, Prediction<N::Real>&,      \
                               AttitudeTrack<N::Real>&);                                                    \
  template Prediction<N::Real> predict(const AttitudeTrack<N::Real>&, const MotionModels<N::Real>&,         \
                                       const Hypotheses<N::Real>&, const FrameInterval&);                   \
  template void fill_lstm_input<N>(const Features<N>&, const Hypotheses<N::Real>&, const Matrix3<N::Real>&, \
                                   LstmInput<N>&);                                                          \
  template TrackedAttitude<N::Real> advance(const Hypotheses<N::Real>&, const Prediction<N::Real>&,         \
                                            const HeadOutput<N::Real>&, AttitudeTrack<N::Real>&)

TUMBLESIGHT_INSTANTIATE(FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(Float32);
#endif

}  // namespace tumblesight::gnc
