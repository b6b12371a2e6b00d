#include "sim/training/track_module.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kCandidates = shape::kCandidates;
constexpr double kTraceOfSameAttitude = 1.0 + 2.0 * 0.93969262;  // 20 degrees apart
constexpr double kLeastProbability = 1e-6;
constexpr double kLargestExponent = 8.0;
constexpr double kMeasurementVariance_rad2 = 7e-4;
constexpr double kLargestEvidence = 6.0;
constexpr double kMemory = 0.9;
constexpr double kMissOfLostTarget = static_cast<double>(2.0F * (1.0F - 0.93969262F));
constexpr double kLeastSeen = 0.1;
constexpr int kGains = 10;

struct FilterGains {
  double predicted_weight, rate_logit, evidence;
};

FilterGains gains_at(int frame) {
  const double k = std::min(frame + 1, kGains);
  const double a = 2.0 * (2.0 * k - 1.0) / (k * (k + 1.0));
  const double rate = std::min(0.999, 3.0 / (2.0 * k - 1.0));
  const bool settled = frame >= 2;
  return {settled ? (1.0 - a) / a : 3e-4, std::log(rate / (1.0 - rate)),
          settled ? (1.0 - a) / (2.0 * a * a) : 0.0};
}

torch::Tensor normalised(const torch::Tensor& v) {
  return v / v.square().sum(-1, true).clamp_min(1e-12).sqrt();
}

torch::Tensor orthonormalised(const torch::Tensor& matrix) {
  return rotation_from_columns(matrix.select(-1, 0), matrix.select(-1, 1));
}

// First two columns, one after the other: [..., 3, 3] -> [..., 6].
torch::Tensor two_columns(const torch::Tensor& rotation) {
  return rotation.narrow(-1, 0, 2).transpose(-1, -2).flatten(-2);
}

torch::Tensor trace_of_transpose_product(const torch::Tensor& a, const torch::Tensor& b) {
  return (a * b).sum({-1, -2});
}

// [B, K, 3, 3] and weights [B, K] -> the mean of the cluster of every candidate [B, K, 3, 3].
torch::Tensor means_of_clusters(const torch::Tensor& candidates, const torch::Tensor& weights) {
  const torch::Tensor flat = candidates.flatten(2);
  const torch::Tensor same = torch::matmul(flat, flat.transpose(1, 2)).detach() > kTraceOfSameAttitude;
  const torch::Tensor shares = same.to(torch::kFloat) * weights.unsqueeze(1);
  return orthonormalised(torch::matmul(shares / shares.sum(-1, true), flat).view_as(candidates));
}

torch::Tensor picked(const torch::Tensor& candidates, const torch::Tensor& index) {
  return candidates.gather(1, index.view({-1, 1, 1, 1}).expand({-1, 1, 3, 3})).squeeze(1);
}

torch::Tensor bounded(const torch::Tensor& rate) {
  const torch::Tensor length = (rate.square().sum(-1, true) + 1e-12).sqrt();
  return rate * (gnc::kLargestRate / length).clamp_max(1.0);
}

torch::Tensor cross_matrix(const torch::Tensor& v) {
  const torch::Tensor x = v.select(-1, 0), y = v.select(-1, 1), z = v.select(-1, 2), o = torch::zeros_like(x);
  return torch::stack({o, -z, y, z, o, -x, -y, x, o}, -1).view({-1, 3, 3});
}

torch::Tensor rotation_by(const torch::Tensor& turn) {
  const torch::Tensor v = bounded(turn);
  const torch::Tensor angle = (v.square().sum(-1) + 1e-12).sqrt().view({-1, 1, 1});
  const torch::Tensor k = cross_matrix(v);
  return torch::eye(3, v.options()) + torch::sin(angle) / angle * k +
         (1.0 - torch::cos(angle)) / angle.square() * torch::matmul(k, k);
}

torch::Tensor small_turn_of(const torch::Tensor& r) {
  const torch::Tensor y = 0.5 * (3.0 - r.diagonal(0, -2, -1).sum(-1));
  torch::Tensor f = torch::ones_like(y);
  for (int n = 8; n >= 1; --n) f = 1.0 + y.clamp(0.0, 0.5) * (n / (2.0 * n + 1.0)) * f;
  const torch::Tensor half = torch::where(y < 0.5, 0.5 * f, torch::zeros_like(f));
  const torch::Tensor skew = r - r.transpose(-1, -2);
  return half.unsqueeze(-1) *
         torch::stack({skew.select(-2, 2).select(-1, 1), skew.select(-2, 0).select(-1, 2),
                       skew.select(-2, 1).select(-1, 0)},
                      -1);
}

struct MotionTensors {
  torch::Tensor r_lrf_trf, rate_lrf;
};

MotionTensors spin(const MotionTensors& motion) {
  return {torch::matmul(rotation_by(motion.rate_lrf), motion.r_lrf_trf), bounded(motion.rate_lrf)};
}

// By the flight code itself, row by row: the gradient takes the turn as given.
MotionTensors tumble(const MotionTensors& motion, const gnc::Inertia& inertia) {
  using RowMajor = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>;
  const torch::Tensor before = motion.r_lrf_trf.detach().cpu().contiguous();
  const torch::Tensor rate_before = motion.rate_lrf.detach().cpu().contiguous();
  const torch::Tensor turn = torch::empty_like(before), rate = torch::empty_like(rate_before);
  for (std::int64_t row = 0; row < before.size(0); ++row) {
    gnc::Motion m;
    m.r_lrf_trf = RowMajor(before.data_ptr<float>() + 9 * row);
    m.rate_lrf = Eigen::Map<Eigen::Vector3f>(rate_before.data_ptr<float>() + 3 * row);
    const gnc::Motion after = gnc::tumble(m, inertia);
    RowMajor{turn.data_ptr<float>() + 9 * row} = after.r_lrf_trf * m.r_lrf_trf.transpose();
    Eigen::Map<Eigen::Vector3f>{rate.data_ptr<float>() + 3 * row} = after.rate_lrf;
  }
  const torch::Tensor turned = torch::matmul(turn.to(motion.r_lrf_trf.device()), motion.r_lrf_trf);
  return {turned, rate.to(motion.rate_lrf.device())};
}

// Row by row: a where `second` is false, b where it is true.
torch::Tensor chosen(const torch::Tensor& second, const torch::Tensor& a, const torch::Tensor& b) {
  std::vector<std::int64_t> shape(static_cast<std::size_t>(a.dim()), 1);
  shape[0] = -1;
  return torch::where(second.view(shape), b, a);
}

}  // namespace

torch::Tensor rotation_from_columns(const torch::Tensor& a, const torch::Tensor& b) {
  const torch::Tensor x1 = normalised(a);
  const torch::Tensor x2 = normalised(b - (x1 * b).sum(-1, true) * x1);
  return torch::stack({x1, x2, torch::cross(x1, x2, -1)}, -1);
}

FrameHypotheses::FrameHypotheses(const torch::Tensor& features_, const torch::Tensor& r_lrf_trf_,
                                 const torch::Tensor& logits_)
    : features(features_),
      r_lrf_trf(r_lrf_trf_),
      logits(logits_),
      probabilities(torch::softmax(logits_, -1)) {}

torch::Tensor TrackModule::predicted_r() const {
  return chosen(tumble_evidence_ > gnc::kEvidenceToTumble, r_lrf_trf_[0], r_lrf_trf_[1]);
}

void TrackModule::predict(const FrameHypotheses& frame) {
  if (frames_ == 0) {
    r_lrf_trf_.fill(picked(frame.r_lrf_trf, frame.logits.argmax(-1)));
    rate_lrf_.fill(torch::zeros({frame.logits.size(0), 3}, frame.logits.options()));
    tumble_evidence_ = torch::zeros({frame.logits.size(0)}, frame.logits.options());
    return;
  }
  const MotionTensors spun = spin({r_lrf_trf_[0], rate_lrf_[0]});
  const MotionTensors tumbled = tumble({r_lrf_trf_[1], rate_lrf_[1]}, inertia_);
  r_lrf_trf_ = {spun.r_lrf_trf, tumbled.r_lrf_trf};
  rate_lrf_ = {spun.rate_lrf, tumbled.rate_lrf};
}

torch::Tensor TrackModule::lstm_input(const FrameHypotheses& frame) const {
  const torch::Tensor predicted = predicted_r();
  const torch::Tensor relative = torch::matmul(predicted.transpose(-1, -2).unsqueeze(1), frame.r_lrf_trf);
  return torch::cat(
      {frame.features, two_columns(relative).flatten(1), frame.probabilities, two_columns(predicted)}, -1);
}

Fusion TrackModule::advance(const FrameHypotheses& frame, const torch::Tensor& word) {
  const FilterGains gains = gains_at(frames_);
  const torch::Tensor column = torch::ones({frame.logits.size(0), 1}, frame.logits.options());
  const torch::Tensor prior =
      torch::cat({frame.probabilities.clamp_min(kLeastProbability), column * gains.predicted_weight}, -1);
  const torch::Tensor weights =
      prior * word.narrow(-1, kCandidates, kCandidates).clamp(-kLargestExponent, kLargestExponent).exp();
  const torch::Tensor anchor_logits =
      torch::cat({frame.logits, 0.0 * column}, -1) + word.narrow(-1, 0, kCandidates);
  const torch::Tensor anchor = anchor_logits.argmax(-1);
  const torch::Tensor rate_gain =
      torch::sigmoid(word.select(-1, 2 * kCandidates) + gains.rate_logit).unsqueeze(-1);

  std::array<torch::Tensor, gnc::kLaws> means, answers, misses;
  for (std::size_t law = 0; law < gnc::kLaws; ++law) {
    const torch::Tensor predicted = r_lrf_trf_[law];
    means[law] = means_of_clusters(torch::cat({frame.r_lrf_trf, predicted.unsqueeze(1)}, 1), weights);
    answers[law] = picked(means[law], anchor);
    const torch::Tensor near =
        (trace_of_transpose_product(frame.r_lrf_trf, predicted.unsqueeze(1)) > kTraceOfSameAttitude)
            .to(torch::kFloat);
    const torch::Tensor lost = (near * frame.probabilities).sum(-1) < kLeastSeen;
    misses[law] = (3.0 - trace_of_transpose_product(predicted, answers[law]))
                      .clamp_max(kMissOfLostTarget)
                      .masked_fill(lost, kMissOfLostTarget)
                      .detach();
    if (frames_ > 0) {
      const torch::Tensor turn = torch::matmul(answers[law], predicted.transpose(-1, -2));
      rate_lrf_[law] = rate_lrf_[law] + rate_gain * small_turn_of(turn);
    }
    r_lrf_trf_[law] = answers[law];
  }
  const torch::Tensor nearer = (misses[0] - misses[1]) * (gains.evidence / kMeasurementVariance_rad2);
  tumble_evidence_ = (kMemory * tumble_evidence_ + nearer).clamp(-kLargestEvidence, kLargestEvidence);
  const torch::Tensor spin_lost = (misses[0] >= kMissOfLostTarget) & (misses[1] < kMissOfLostTarget);
  const torch::Tensor tumble_lost = (misses[1] >= kMissOfLostTarget) & (misses[0] < kMissOfLostTarget);
  r_lrf_trf_ = {chosen(spin_lost, answers[0], answers[1]), chosen(tumble_lost, answers[1], answers[0])};
  rate_lrf_ = {chosen(spin_lost, rate_lrf_[0], rate_lrf_[1]),
               chosen(tumble_lost, rate_lrf_[1], rate_lrf_[0])};
  ++frames_;
  const torch::Tensor tumbles = tumble_evidence_ > gnc::kEvidenceToTumble;
  return {chosen(tumbles, r_lrf_trf_[0], r_lrf_trf_[1]), chosen(tumbles, means[0], means[1]), anchor_logits,
          word.select(-1, 2 * kCandidates + 1)};
}

}  // namespace tumblesight::sim
