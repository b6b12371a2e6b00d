#include "gnc/rcnn/attitude_track.hpp"

#include <algorithm>

#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kCandidates = shape::kCandidates;
constexpr double kLeastProbability = 1e-6;  // so that the weights of a cluster never all vanish
constexpr double kLargestExponent = 8.0;    // of the network's word on a weight

// The gains with which a straight line is fitted to k equally good measurements, one by one: attitude
// a = 2 (2k - 1) / (k (k + 1)), rate over attitude 3 / (2k - 1). Frozen at k = 10, so that the track never
// turns deaf.
constexpr int kGains = 10;

template <class Real>
struct FilterGains {
  Real predicted_weight;  // of the predicted attitude, the hypotheses of a frame weighing 1: (1 - a) / a
  Real rate_logit;        // sigmoid^-1 of the rate's gain over the attitude's
  Real evidence;          // by how much a law's squared miss tells against it: (1 - a) / (2 a^2)
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

constexpr double kLeastVariance_rad2 = 7e-4;  // of a frame's attitude: 1.5 degrees
constexpr double kLeastLogLikelihood = -6.0;
constexpr double kMostTold = 64.0;                              // by one frame against a law
constexpr double kMemory = 0.9;                                 // of the likelihoods, from frame to frame
constexpr double kMissOfLostTarget = 2.0 * (1.0 - 0.93969262);  // 20 degrees
constexpr double kLeastSeen = 0.1;  // probability near a prediction; with less, the target is lost

// False for what a damaged state may hold: not finite, or no rotation.
template <class Real>
bool is_sound(const Motion<Real>& motion) {
  const Real trace = trace_of_transpose_product<Real>(motion.r_lrf_trf, motion.r_lrf_trf);
  const Vector3<Real>& rate = motion.rate_lrf;
  const bool is_rotation = absolute(trace - constant<Real>(3.0)) < constant<Real>(0.1);
  const bool has_rate = is_finite((rate.x() + rate.y()) + rate.z());
  return is_rotation & has_rate;
}

template <class Real>
bool is_sound(const AttitudeTrack<Real>& track) {
  bool sound = true;
  for (int law = 0; law < kLaws; ++law) {
    sound &= is_sound<Real>(track.motion[law]);
    sound &= is_finite(track.log_likelihood[law]);
  }
  return sound;
}

// p exp(word) for the hypotheses, prior exp(word) for the predicted attitude; all over one common factor,
// lest they leave the range of Real.
template <class Real>
std::array<Real, kCandidates> weights_of(const Hypotheses<Real>& hypotheses, const Real* words,
                                         Real predicted_weight) {
  constexpr Real kBound = constant<Real>(kLargestExponent);
  std::array<Real, kCandidates> weights;
  Real largest = -kBound;
  for (int i = 0; i < kCandidates; ++i) {
    weights[i] = clamp(words[i], -kBound, kBound);
    largest = max(largest, weights[i]);
  }
  for (int i = 0; i < kCandidates; ++i) {
    const Real prior = i < shape::kHypotheses
                           ? max(constant<Real>(kLeastProbability), hypotheses.probability[i])
                           : predicted_weight;
    weights[i] = exp(weights[i] - largest) * prior;
  }
  return weights;
}

template <class Real>
int anchor_of(const Hypotheses<Real>& hypotheses, const Real* words) {
  int anchor = 0;
  Real largest = hypotheses.logit[0] + words[0];
  for (int i = 1; i < kCandidates; ++i) {
    const Real value = (i < shape::kHypotheses ? hypotheses.logit[i] : Real{}) + words[i];
    anchor = select(value > largest, i, anchor);
    largest = max(largest, value);
  }
  return anchor;
}

// The squared angle between where the law saw the target coming and where it now is. A miss tells no more
// than that the target is lost; and it is lost, however near the answer, where the frame shows nothing near
// the prediction: the answer may be that very prediction.
template <class Real>
Real squared_miss(const Hypotheses<Real>& hypotheses, const Motion<Real>& predicted,
                  const Matrix3<Real>& r_lrf_trf) {
  constexpr Real kLost = constant<Real>(kMissOfLostTarget);
  Real seen{};
  for (int i = 0; i < shape::kHypotheses; ++i) {
    const bool near = same_attitude<Real>(hypotheses.r_lrf_trf[i], predicted.r_lrf_trf);
    seen += select(near, hypotheses.probability[i], Real{});
  }
  const Real miss = constant<Real>(3.0) - trace_of_transpose_product<Real>(predicted.r_lrf_trf, r_lrf_trf);
  return select(seen < constant<Real>(kLeastSeen), kLost, min(miss, kLost));
}

template <class Real>
Motion<Real> corrected(const Motion<Real>& predicted, const Matrix3<Real>& r_lrf_trf, Real rate_gain) {
  const Matrix3<Real> lrf_predicted = predicted.r_lrf_trf.transpose();
  const Vector3<Real> miss = small_turn_of<Real>(product<Real>(r_lrf_trf, lrf_predicted));
  return {r_lrf_trf, predicted.rate_lrf + scaled<Real>(miss, rate_gain)};
}

template <class Real>
Real standing(const AttitudeTrack<Real>& track, int law) {
  constexpr std::array<Real, kLaws> kAsked{
      constant<Real>(kEvidenceAsked[0]), constant<Real>(kEvidenceAsked[1]), constant<Real>(kEvidenceAsked[2]),
      constant<Real>(kEvidenceAsked[3]), constant<Real>(kEvidenceAsked[4])};
  return track.log_likelihood[law] - kAsked[law];
}

// How much the frame tells against a law with this squared miss.
template <class Real>
Real told(Real miss, Real evidence, Real variance_rad2) {
  return min(constant<Real>(kMostTold), evidence * miss / variance_rad2);
}

// Every law's log-likelihood falls by what is told against it. A law that has lost the target goes on from
// where the best of those that see it does.
template <class Real>
void weigh_laws(const std::array<Real, kLaws>& miss, Real evidence, Real variance_rad2,
                AttitudeTrack<Real>& track) {
  constexpr Real kLost = constant<Real>(kMissOfLostTarget);
  for (int law = 0; law < kLaws; ++law) {
    track.log_likelihood[law] =
        constant<Real>(kMemory) * track.log_likelihood[law] - told<Real>(miss[law], evidence, variance_rad2);
  }
  Real likeliest = track.log_likelihood[0];
  for (const Real one : track.log_likelihood) likeliest = max(likeliest, one);
  int best = 0;
  bool any_sees_it = false;
  for (int law = 0; law < kLaws; ++law) {
    track.log_likelihood[law] =
        max(constant<Real>(kLeastLogLikelihood), track.log_likelihood[law] - likeliest);
    const bool sees_it = miss[law] < kLost;
    best = select(sees_it & (!any_sees_it | (standing(track, law) > standing(track, best))), law, best);
    any_sees_it |= sees_it;
  }
  for (int law = 0; law < kLaws; ++law) {
    const bool follows = any_sees_it & !(miss[law] < kLost);
    track.motion[law] = track.motion[select(follows, best, law)];
  }
}

}  // namespace

template <class Real>
int AttitudeTrack<Real>::law() const {
  int best = kSpinLaw;
  for (int law = 1; law < kLaws; ++law)
    best = select(standing(*this, law) > standing(*this, best), law, best);
  return best;
}

template <class Real>
Prediction<Real> predict(const AttitudeTrack<Real>& track, const MotionLaws<Real>& laws,
                         const Hypotheses<Real>& hypotheses) {
  // Both ways are gone in every frame, so that each takes the same time.
  const bool has_track = (track.frames > 0) & is_sound(track);
  std::array<Motion<Real>, 2> choice{};  // without a track, with one
  choice[0] = {hypotheses.r_lrf_trf[hypotheses.likeliest], Vector3<Real>::Zero()};
  Prediction<Real> prediction;
  for (int law = 0; law < kLaws; ++law) {
    choice[1] = tumble<Real>(track.motion[law], laws[law]);
    prediction.motion[law] = choice[has_track];
  }
  prediction.law = select(has_track, track.law(), kSpinLaw);
  return prediction;
}

template <class N>
void fill_lstm_input(const Features<N>& features, const Hypotheses<typename N::Real>& hypotheses,
                     const Matrix3<typename N::Real>& predicted_r_lrf_trf, LstmInput<N>& input) {
  using Real = typename N::Real;
  auto* next = std::copy(features.begin(), features.end(), input.begin());
  const auto put_columns = [&next](const Matrix3<Real>& rotation) {
    for (int column = 0; column < 2; ++column) {
      for (int row = 0; row < 3; ++row) to_input(rotation(row, column), *next++);
    }
  };
  for (const Matrix3<Real>& r_lrf_trf : hypotheses.r_lrf_trf) {
    put_columns(transpose_product<Real>(predicted_r_lrf_trf, r_lrf_trf));
  }
  for (const Real probability : hypotheses.probability) to_input(probability, *next++);
  put_columns(predicted_r_lrf_trf);
}

template <class Real>
TrackedAttitude<Real> advance(const Hypotheses<Real>& hypotheses, const Prediction<Real>& prediction,
                              const HeadOutput<Real>& head, AttitudeTrack<Real>& track) {
  const std::array<AttitudeTrack<Real>, 2> choice{AttitudeTrack<Real>{}, track};  // damaged, sound
  track = choice[is_sound(track)];
  const FilterGains<Real>& filter = kFilterGains<Real>[std::min<std::uint32_t>(track.frames, kGains - 1)];
  const Real* words = head.data();
  const int anchor = anchor_of<Real>(hypotheses, words);
  const auto weights = weights_of<Real>(hypotheses, words + kCandidates, filter.predicted_weight);
  const Real learnt_gain = sigmoid(filter.rate_logit + words[2 * kCandidates]);
  const Real rate_gain = select(track.frames > 0, learnt_gain, Real{});

  std::array<Matrix3<Real>, kCandidates> candidates;
  std::copy(hypotheses.r_lrf_trf.begin(), hypotheses.r_lrf_trf.end(), candidates.begin());
  std::array<Real, kLaws> miss;
  for (int law = 0; law < kLaws; ++law) {
    candidates[shape::kHypotheses] = prediction.motion[law].r_lrf_trf;
    const Matrix3<Real> r_lrf_trf =
        mean_attitude<Real>(candidates.data(), weights.data(), kCandidates, anchor);
    miss[law] = squared_miss<Real>(hypotheses, prediction.motion[law], r_lrf_trf);
    track.motion[law] = corrected<Real>(prediction.motion[law], r_lrf_trf, rate_gain);
  }
  const Real predicted_error_rad = constant<Real>(kPi) * sigmoid(words[2 * kCandidates + 1]);
  const Real variance_rad2 =
      max(constant<Real>(kLeastVariance_rad2), predicted_error_rad * predicted_error_rad);
  weigh_laws<Real>(miss, filter.evidence, variance_rad2, track);
  ++track.frames;
  return {track.motion[track.law()].r_lrf_trf, predicted_error_rad};
}

#define TUMBLESIGHT_INSTANTIATE(N)                                                                          \
  template struct AttitudeTrack<N::Real>;                                                                   \
  template Prediction<N::Real> predict(const AttitudeTrack<N::Real>&, const MotionLaws<N::Real>&,           \
                                       const Hypotheses<N::Real>&);                                         \
  template void fill_lstm_input<N>(const Features<N>&, const Hypotheses<N::Real>&, const Matrix3<N::Real>&, \
                                   LstmInput<N>&);                                                          \
  template TrackedAttitude<N::Real> advance(const Hypotheses<N::Real>&, const Prediction<N::Real>&,         \
                                            const HeadOutput<N::Real>&, AttitudeTrack<N::Real>&)

TUMBLESIGHT_INSTANTIATE(FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(Float32);
#endif

}  // namespace tumblesight::gnc
