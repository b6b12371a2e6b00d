#include "sim/training/track_module.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gnc/rcnn/network_shape.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kCandidates = shape::kCandidates;
constexpr double kTraceOfSameAttitude = 1.0 + 2.0 * 0.93969262;  // 20 degrees apart
constexpr double kLeastProbability = 1e-6;
constexpr double kLargestExponent = 8.0;
constexpr double kLeastVariance_rad2 = 7e-4;
constexpr double kLeastLogLikelihood = -6.0;
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

// The first column, then the second: [..., 3, 3] -> [..., 6].
torch::Tensor two_columns(const torch::Tensor& rotation) {
  return rotation.narrow(-1, 0, 2).transpose(-1, -2).flatten(-2);
}

torch::Tensor trace_of_transpose_product(const torch::Tensor& a, const torch::Tensor& b) {
  return (a * b).sum({-1, -2});
}

// Candidates [..., K, 3, 3] with weights [..., K] -> mean of the cluster around each candidate [..., K, 3,
// 3].
torch::Tensor means_of_clusters(const torch::Tensor& candidates, const torch::Tensor& weights) {
  const torch::Tensor flat = candidates.flatten(-2);
  const torch::Tensor same = torch::matmul(flat, flat.transpose(-1, -2)).detach() > kTraceOfSameAttitude;
  const torch::Tensor shares = same.to(torch::kFloat) * weights.unsqueeze(-2);
  return orthonormalised(torch::matmul(shares / shares.sum(-1, true), flat).view_as(candidates));
}

// For every row of the batch, the entry `index` [B] along the dimension `of`.
torch::Tensor picked(const torch::Tensor& values, const torch::Tensor& index, int of = 1) {
  std::vector<std::int64_t> one(static_cast<std::size_t>(values.dim()), 1), all = values.sizes().vec();
  one[0] = -1;
  all[static_cast<std::size_t>(of)] = 1;
  return values.gather(of, index.view(one).expand(all)).squeeze(of);
}

torch::Tensor bounded(const torch::Tensor& rate) {
  const torch::Tensor length = (rate.square().sum(-1, true) + 1e-12).sqrt();
  return rate * (gnc::kLargestRate / length).clamp_max(1.0);
}

torch::Tensor cross_matrix(const torch::Tensor& v) {
  const torch::Tensor x = v.select(-1, 0), y = v.select(-1, 1), z = v.select(-1, 2), o = torch::zeros_like(x);
  return torch::stack({o, -z, y, z, o, -x, -y, x, o}, -1).unflatten(-1, {3, 3});
}

torch::Tensor rotation_by(const torch::Tensor& v) {
  const torch::Tensor angle = (v.square().sum(-1) + 1e-12).sqrt().unsqueeze(-1).unsqueeze(-1);
  const torch::Tensor k = cross_matrix(v);
  return torch::eye(3, v.options()) + torch::sin(angle) / angle * k +
         (1.0 - torch::cos(angle)) / angle.square() * torch::matmul(k, k);
}

// The largest innovation that corrects the rate, as a versine (gnc/rcnn/attitude_track.cpp).
torch::Tensor largest_versine(const torch::Tensor& periods, bool finds_rate) {
  const torch::Tensor nominal = torch::full_like(periods, gnc::kVersineOf60Degrees);
  const torch::Tensor grown = (nominal + (periods - 1.0).clamp_min(0.0) *
                                             (gnc::kVersineOf150Degrees - gnc::kVersineOf60Degrees) / 1.5)
                                  .clamp_max(gnc::kVersineOf150Degrees);
  const torch::Tensor half_square = 0.5 * (0.17453293 + 0.87266463 * periods).square();
  const torch::Tensor reduced = half_square - half_square.square() / 6.0;
  return torch::where(periods < 1.0, reduced, finds_rate ? grown : nominal);
}

// The rotation vector of `r`; zero where its versine is not below `largest`.
torch::Tensor turn_of(const torch::Tensor& r, const torch::Tensor& largest) {
  const torch::Tensor y = 0.5 * (3.0 - r.diagonal(0, -2, -1).sum(-1));
  torch::Tensor f = torch::ones_like(y);
  for (int n = 8; n >= 1; --n) f = 1.0 + y.clamp(0.0, 0.5) * (n / (2.0 * n + 1.0)) * f;
  const torch::Tensor skew = r - r.transpose(-1, -2);
  const torch::Tensor v = torch::stack(
      {skew.select(-2, 2).select(-1, 1), skew.select(-2, 0).select(-1, 2), skew.select(-2, 1).select(-1, 0)},
      -1);
  const torch::Tensor sine = 0.5 * (v.square().sum(-1) + 1e-12).sqrt();
  const torch::Tensor large = torch::atan2(sine, 1.0 - y) / sine;
  const torch::Tensor factor = torch::where(y < gnc::kVersineOf60Degrees, f, large);
  return torch::where(y < largest, 0.5 * factor, torch::zeros_like(f)).unsqueeze(-1) * v;
}

struct MotionTensors {
  torch::Tensor r_lrf_trf, rate_lrf;  // [B, motion models, 3, 3], [B, motion models, 3]
};

MotionTensors spin(const MotionTensors& motion, const torch::Tensor& periods) {
  const torch::Tensor rate = bounded(motion.rate_lrf);
  return {torch::matmul(rotation_by(rate * periods.view({-1, 1, 1})), motion.r_lrf_trf), rate};
}

// Calls the flight code for each motion. The gradient treats the turn as a constant.
MotionTensors tumble(const MotionTensors& motion, const gnc::Inertia<float>* motion_models,
                     const torch::Tensor& periods) {
  using RowMajor = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>;
  const torch::Tensor before = motion.r_lrf_trf.detach().cpu().contiguous();
  const torch::Tensor rate_before = motion.rate_lrf.detach().cpu().contiguous();
  const torch::Tensor turn = torch::empty_like(before), rate = torch::empty_like(rate_before);
  const std::int64_t count = before.size(1);
  const torch::Tensor times = periods.cpu().contiguous();
  for (std::int64_t i = 0; i < before.size(0) * count; ++i) {
    gnc::Motion<float> m;
    m.r_lrf_trf = RowMajor(before.data_ptr<float>() + 9 * i);
    m.rate_lrf = Eigen::Map<Eigen::Vector3f>(rate_before.data_ptr<float>() + 3 * i);
    const std::int64_t elapsed_ns =
        std::llround(static_cast<double>(times.data_ptr<float>()[i / count]) * gnc::kNominalPeriod_ns);
    const gnc::Motion<float> after = gnc::propagate<float>(m, motion_models[i % count], elapsed_ns);
    RowMajor{turn.data_ptr<float>() + 9 * i} = after.r_lrf_trf * m.r_lrf_trf.transpose();
    Eigen::Map<Eigen::Vector3f>{rate.data_ptr<float>() + 3 * i} = after.rate_lrf;
  }
  const torch::Tensor turned = torch::matmul(turn.to(motion.r_lrf_trf.device()), motion.r_lrf_trf);
  return {turned, rate.to(motion.rate_lrf.device())};
}

}  // namespace

torch::Tensor rotation_from_columns(const torch::Tensor& a, const torch::Tensor& b) {
  const torch::Tensor x1 = normalised(a);
  const torch::Tensor x2 = normalised(b - (x1 * b).sum(-1, true) * x1);
  return torch::stack({x1, x2, torch::cross(x1, x2, -1)}, -1);
}

FrameHypotheses::FrameHypotheses(const torch::Tensor& features_, const torch::Tensor& r_lrf_trf_,
                                 const torch::Tensor& logits_, const torch::Tensor& periods_)
    : features(features_),
      r_lrf_trf(r_lrf_trf_),
      logits(logits_),
      probabilities(torch::softmax(logits_, -1)),
      periods(periods_) {}

torch::Tensor TrackModule::standing() const {
  const torch::Tensor asked =
      torch::tensor(std::vector<float>(gnc::kRequiredEvidence.begin(), gnc::kRequiredEvidence.end()));
  return log_likelihood_ - asked.to(log_likelihood_.device());
}

torch::Tensor TrackModule::motion_model() const {
  return standing().argmax(-1);
}

void TrackModule::predict(const FrameHypotheses& frame) {
  if (frames_ == 0) {
    const std::int64_t rows = frame.logits.size(0);
    r_lrf_trf_ =
        picked(frame.r_lrf_trf, frame.logits.argmax(-1)).unsqueeze(1).expand({-1, gnc::kMotionModels, 3, 3});
    rate_lrf_ = torch::zeros({rows, gnc::kMotionModels, 3}, frame.logits.options());
    log_likelihood_ = torch::zeros({rows, gnc::kMotionModels}, frame.logits.options());
    return;
  }
  // The first motion model is a spin: the gradient flows through it.
  static_assert(gnc::kSpinModel == 0);
  constexpr int kOthers = gnc::kMotionModels - 1;
  const MotionTensors spun = spin({r_lrf_trf_.narrow(1, 0, 1), rate_lrf_.narrow(1, 0, 1)}, frame.periods);
  const MotionTensors tumbled = tumble({r_lrf_trf_.narrow(1, 1, kOthers), rate_lrf_.narrow(1, 1, kOthers)},
                                       motion_models_.data() + 1, frame.periods);
  r_lrf_trf_ = torch::cat({spun.r_lrf_trf, tumbled.r_lrf_trf}, 1);
  rate_lrf_ = torch::cat({spun.rate_lrf, tumbled.rate_lrf}, 1);
}

torch::Tensor TrackModule::lstm_input(const FrameHypotheses& frame) const {
  const torch::Tensor predicted = picked(r_lrf_trf_, motion_model());
  const torch::Tensor relative = torch::matmul(predicted.transpose(-1, -2).unsqueeze(1), frame.r_lrf_trf);
  return torch::cat(
      {frame.features, two_columns(relative).flatten(1), frame.probabilities, two_columns(predicted)}, -1);
}

Fusion TrackModule::advance(const FrameHypotheses& frame, const torch::Tensor& head_output) {
  const FilterGains gains = gains_at(frames_);
  const torch::Tensor column = torch::ones({frame.logits.size(0), 1}, frame.logits.options());
  const torch::Tensor prior =
      torch::cat({frame.probabilities.clamp_min(kLeastProbability), column * gains.predicted_weight}, -1);
  const torch::Tensor weights =
      prior *
      head_output.narrow(-1, kCandidates, kCandidates).clamp(-kLargestExponent, kLargestExponent).exp();
  const torch::Tensor anchor_logits =
      torch::cat({frame.logits, 0.0 * column}, -1) + head_output.narrow(-1, 0, kCandidates);
  const torch::Tensor anchor = anchor_logits.argmax(-1);
  const torch::Tensor rate_gain =
      torch::sigmoid(head_output.select(-1, 2 * kCandidates) + gains.rate_logit).view({-1, 1, 1});
  const torch::Tensor error_logit = head_output.select(-1, 2 * kCandidates + 1);

  const torch::Tensor hypotheses = frame.r_lrf_trf.unsqueeze(1);  // [B, 1, 8, 3, 3]
  const torch::Tensor candidates =
      torch::cat({hypotheses.expand({-1, gnc::kMotionModels, -1, -1, -1}), r_lrf_trf_.unsqueeze(2)}, 2);
  const torch::Tensor means = means_of_clusters(candidates, weights.unsqueeze(1));  // [B, 5, 9, 3, 3]
  const torch::Tensor answers = picked(means, anchor, 2);
  const torch::Tensor near =
      (trace_of_transpose_product(hypotheses, r_lrf_trf_.unsqueeze(2)) > kTraceOfSameAttitude)
          .to(torch::kFloat);
  const torch::Tensor unseen = (near * frame.probabilities.unsqueeze(1)).sum(-1) < kLeastSeen;
  const torch::Tensor misses = (3.0 - trace_of_transpose_product(r_lrf_trf_, answers))
                                   .clamp_max(kMissOfLostTarget)
                                   .masked_fill(unseen, kMissOfLostTarget)
                                   .detach();
  if (frames_ > 0) {
    const torch::Tensor largest = largest_versine(frame.periods, frames_ < kGains).unsqueeze(-1);
    const torch::Tensor innovation = turn_of(torch::matmul(answers, r_lrf_trf_.transpose(-1, -2)), largest);
    rate_lrf_ = rate_lrf_ + rate_gain * innovation / frame.periods.view({-1, 1, 1});
  }

  const torch::Tensor variance =
      (kPi * torch::sigmoid(error_logit)).square().clamp_min(kLeastVariance_rad2).detach().unsqueeze(1);
  log_likelihood_ = kMemory * log_likelihood_ - gains.evidence / variance * misses;
  log_likelihood_ = (log_likelihood_ - log_likelihood_.amax(-1, true)).clamp_min(kLeastLogLikelihood);
  // A motion model that has lost the target continues from the state of the best motion model that has not.
  const torch::Tensor lost = misses >= kMissOfLostTarget;
  const torch::Tensor best = standing().masked_fill(lost, -1e9).argmax(-1);
  const torch::Tensor moved = (lost & ~lost.all(-1, true)).unsqueeze(-1);
  r_lrf_trf_ = torch::where(moved.unsqueeze(-1), picked(answers, best).unsqueeze(1), answers);
  rate_lrf_ = torch::where(moved, picked(rate_lrf_, best).unsqueeze(1), rate_lrf_);
  ++frames_;
  return {picked(r_lrf_trf_, motion_model()), picked(means, motion_model()), anchor_logits, error_logit};
}

}  // namespace tumblesight::sim
