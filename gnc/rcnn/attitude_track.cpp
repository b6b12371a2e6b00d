#include "gnc/rcnn/attitude_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gnc/attitude/rotation.hpp"
#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kCandidates = shape::kCandidates;
constexpr float kPi = 3.14159265F;
constexpr float kLeastProbability = 1e-6F;  // so that the weights of a cluster never all vanish
constexpr float kLargestExponent = 8.0F;    // of the network's word on a weight

// The gains with which a straight line is fitted to k equally good measurements, one by one: attitude
// a = 2 (2k - 1) / (k (k + 1)), rate over attitude 3 / (2k - 1). Frozen at k = 10, so that the track never
// turns deaf.
constexpr int kGains = 10;

struct FilterGains {
  float predicted_weight;  // of the predicted attitude, the hypotheses of a frame weighing 1: (1 - a) / a
  float rate_logit;        // sigmoid^-1 of the rate's gain over the attitude's
  float evidence;          // by how much a law's squared miss tells against it: (1 - a) / (2 a^2)
};

constexpr std::array<FilterGains, kGains> kFilterGains{{{0.0003F, 6.9067548F, 0.0F},
                                                        {0.0003F, 6.9067548F, 0.0F},
                                                        {0.2F, 0.40546511F, 0.12F},
                                                        {0.42857143F, -0.28768207F, 0.30612245F},
                                                        {0.66666667F, -0.69314718F, 0.55555556F},
                                                        {0.90909091F, -0.98082925F, 0.8677686F},
                                                        {1.1538462F, -1.2039728F, 1.2426036F},
                                                        {1.4F, -1.3862944F, 1.68F},
                                                        {1.6470588F, -1.540445F, 2.1799308F},
                                                        {1.8947368F, -1.6739764F, 2.7423823F}}};

constexpr float kLeastVariance_rad2 = 7e-4F;  // of a frame's attitude: 1.5 degrees
constexpr float kLeastLogLikelihood = -6.0F;
constexpr float kMemory = 0.9F;                                   // of the likelihoods, from frame to frame
constexpr float kMissOfLostTarget = 2.0F * (1.0F - 0.93969262F);  // 20 degrees
constexpr float kLeastSeen = 0.1F;  // probability near a prediction; with less, the target is lost

// False for what a damaged state may hold: not finite, or no rotation.
bool is_sound(const Motion& motion) {
  const float trace = trace_of_transpose_product(motion.r_lrf_trf, motion.r_lrf_trf);
  return std::abs(trace - 3.0F) < 0.1F && std::isfinite(motion.rate_lrf.sum());
}

bool is_sound(const AttitudeTrack& track) {
  bool sound = true;
  for (int law = 0; law < kLaws; ++law)
    sound = is_sound(track.motion[law]) && std::isfinite(track.log_likelihood[law]) && sound;
  return sound;
}

// p exp(word) for the hypotheses, prior exp(word) for the predicted attitude.
std::array<float, kCandidates> weights_of(const Hypotheses& hypotheses, const float* words,
                                          float predicted_weight) {
  std::array<float, kCandidates> weights;
  for (int i = 0; i < kCandidates; ++i) {
    weights[i] = std::min(kLargestExponent, std::max(-kLargestExponent, words[i]));
  }
  gnc::exp(weights.data(), weights.data(), kCandidates);
  for (int i = 0; i < shape::kHypotheses; ++i) {
    weights[i] *= std::max(kLeastProbability, hypotheses.probability[i]);
  }
  weights[shape::kHypotheses] *= predicted_weight;
  return weights;
}

int anchor_of(const Hypotheses& hypotheses, const float* words) {
  int anchor = 0;
  float largest = hypotheses.logit[0] + words[0];
  for (int i = 1; i < kCandidates; ++i) {
    const float value = (i < shape::kHypotheses ? hypotheses.logit[i] : 0.0F) + words[i];
    anchor = value > largest ? i : anchor;
    largest = std::max(largest, value);
  }
  return anchor;
}

// The squared angle between where the law saw the target coming and where it now is. A miss tells no more
// than that the target is lost; and it is lost, however near the answer, where the frame shows nothing near
// the prediction: the answer may be that very prediction.
float squared_miss(const Hypotheses& hypotheses, const Motion& predicted, const Eigen::Matrix3f& r_lrf_trf) {
  float seen = 0.0F;
  for (int i = 0; i < shape::kHypotheses; ++i) {
    seen += same_attitude(hypotheses.r_lrf_trf[i], predicted.r_lrf_trf) ? hypotheses.probability[i] : 0.0F;
  }
  const float miss = 3.0F - trace_of_transpose_product(predicted.r_lrf_trf, r_lrf_trf);
  return seen < kLeastSeen ? kMissOfLostTarget : std::min(miss, kMissOfLostTarget);
}

Motion corrected(const Motion& predicted, const Eigen::Matrix3f& r_lrf_trf, float rate_gain) {
  const Eigen::Matrix3f lrf_predicted = predicted.r_lrf_trf.transpose();
  return {r_lrf_trf, predicted.rate_lrf + rate_gain * small_turn_of(product(r_lrf_trf, lrf_predicted))};
}

float standing(const AttitudeTrack& track, int law) {
  return track.log_likelihood[law] - kEvidenceAsked[law];
}

// Every law's log-likelihood falls by `told` times its squared miss. A law that has lost the target goes on
// from where the best of those that see it does.
void weigh_laws(const std::array<float, kLaws>& miss, float told, AttitudeTrack& track) {
  float likeliest = kMemory * track.log_likelihood[0] - told * miss[0];
  for (int law = 0; law < kLaws; ++law) {
    track.log_likelihood[law] = kMemory * track.log_likelihood[law] - told * miss[law];
    likeliest = std::max(likeliest, track.log_likelihood[law]);
  }
  int best = -1;
  for (int law = 0; law < kLaws; ++law) {
    track.log_likelihood[law] = std::max(kLeastLogLikelihood, track.log_likelihood[law] - likeliest);
    const bool sees_it = miss[law] < kMissOfLostTarget;
    best = sees_it && (best < 0 || standing(track, law) > standing(track, best)) ? law : best;
  }
  for (int law = 0; law < kLaws; ++law) {
    if (best >= 0 && miss[law] >= kMissOfLostTarget) track.motion[law] = track.motion[best];
  }
}

}  // namespace

int AttitudeTrack::law() const {
  int best = kSpinLaw;
  for (int law = 1; law < kLaws; ++law) best = standing(*this, law) > standing(*this, best) ? law : best;
  return best;
}

Prediction predict(const AttitudeTrack& track, const MotionLaws& laws, const Hypotheses& hypotheses) {
  Prediction prediction;
  if (track.frames == 0 || !is_sound(track)) {
    prediction.motion.fill({hypotheses.r_lrf_trf[hypotheses.likeliest], Eigen::Vector3f::Zero()});
    return prediction;
  }
  for (int law = 0; law < kLaws; ++law) prediction.motion[law] = tumble(track.motion[law], laws[law]);
  prediction.law = track.law();
  return prediction;
}

void fill_lstm_input(const layers::Dense2::Output& features, const Hypotheses& hypotheses,
                     const Eigen::Matrix3f& predicted_r_lrf_trf, layers::Recurrent::Input& input) {
  float* next = std::copy(features.begin(), features.end(), input.begin());
  const auto put_columns = [&next](const Eigen::Matrix3f& rotation) {
    for (int column = 0; column < 2; ++column) {
      for (int row = 0; row < 3; ++row) *next++ = rotation(row, column);
    }
  };
  for (const Eigen::Matrix3f& r_lrf_trf : hypotheses.r_lrf_trf) {
    put_columns(transpose_product(predicted_r_lrf_trf, r_lrf_trf));
  }
  next = std::copy(hypotheses.probability.begin(), hypotheses.probability.end(), next);
  put_columns(predicted_r_lrf_trf);
}

TrackedAttitude advance(const Hypotheses& hypotheses, const Prediction& prediction,
                        const layers::Head2::Output& head, AttitudeTrack& track) {
  if (!is_sound(track)) track = AttitudeTrack{};
  const FilterGains& gains = kFilterGains[std::min<std::uint32_t>(track.frames, kGains - 1)];
  const float* words = head.data();
  const int anchor = anchor_of(hypotheses, words);
  const auto weights = weights_of(hypotheses, words + kCandidates, gains.predicted_weight);
  const float rate_gain = track.frames > 0 ? sigmoid(gains.rate_logit + words[2 * kCandidates]) : 0.0F;

  std::array<Eigen::Matrix3f, kCandidates> candidates;
  std::copy(hypotheses.r_lrf_trf.begin(), hypotheses.r_lrf_trf.end(), candidates.begin());
  std::array<float, kLaws> miss;
  for (int law = 0; law < kLaws; ++law) {
    candidates[shape::kHypotheses] = prediction.motion[law].r_lrf_trf;
    const Eigen::Matrix3f r_lrf_trf = mean_attitude(candidates.data(), weights.data(), kCandidates, anchor);
    miss[law] = squared_miss(hypotheses, prediction.motion[law], r_lrf_trf);
    track.motion[law] = corrected(prediction.motion[law], r_lrf_trf, rate_gain);
  }
  const float predicted_error_rad = kPi * sigmoid(words[2 * kCandidates + 1]);
  const float variance_rad2 = std::max(kLeastVariance_rad2, predicted_error_rad * predicted_error_rad);
  weigh_laws(miss, gains.evidence / variance_rad2, track);
  ++track.frames;
  return {track.motion[track.law()].r_lrf_trf, predicted_error_rad};
}

}  // namespace tumblesight::gnc
