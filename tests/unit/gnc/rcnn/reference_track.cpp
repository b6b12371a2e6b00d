#include "tests/unit/gnc/rcnn/reference_track.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tumblesight::gnc {
namespace {

const double kLost = 2.0 * (1.0 - std::cos(20.0 * M_PI / 180.0));

double logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d rotation;
  rotation.col(0) = a.normalized();
  rotation.col(1) = (b - b.dot(rotation.col(0)) * rotation.col(0)).normalized();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  return rotation;
}

double angle_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle() * 180.0 / M_PI;
}

Eigen::Vector3d bounded(const Eigen::Vector3d& rate) {
  return rate.norm() > 1.9 ? Eigen::Vector3d(1.9 * rate.normalized()) : rate;
}

Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& turn) {
  return Eigen::AngleAxisd(bounded(turn).norm(), turn.normalized()).toRotationMatrix();
}

// 3 - trace of the relative rotation: for small angles the squared angle.
double chord_square(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return 3.0 - (a.transpose() * b).trace();
}

}  // namespace

double attitude_gain_after(int frames) {
  const double k = std::min(frames + 1, 10);
  return 2.0 * (2.0 * k - 1.0) / (k * (k + 1.0));
}

double rate_gain_after(int frames) {
  const double k = std::min(frames + 1, 10);
  return std::min(0.999, 3.0 / (2.0 * k - 1.0));
}

double predicted_weight_after(int frames) {
  const double gain = attitude_gain_after(frames);
  return frames < 2 ? 3e-4 : (1.0 - gain) / gain;
}

ReferenceTrack::ReferenceTrack(const Eigen::Matrix3d& inertia_trf) {
  inertia_.fill(inertia_trf);
  inertia_[0].setIdentity();
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d shrink = Eigen::Matrix3d::Identity();
    shrink(axis, axis) = std::sqrt(0.5);
    inertia_[2 + axis] = shrink * inertia_trf * shrink;
  }
}

std::array<double, ReferenceTrack::kMotionModels> ReferenceTrack::scores() const {
  std::array<double, kMotionModels> score = log_likelihood;
  score[1] -= 0.5;
  for (int motion_model = 2; motion_model < kMotionModels; ++motion_model) score[motion_model] -= 2.0;
  return score;
}

int ReferenceTrack::motion_model() const {
  const auto score = scores();
  return static_cast<int>(std::max_element(score.begin(), score.end()) - score.begin());
}

double ReferenceTrack::margin() const {
  auto score = scores();
  std::sort(score.begin(), score.end());
  return score[kMotionModels - 1] - score[kMotionModels - 2];
}

void ReferenceTrack::observe(const Values& output, const Eigen::Matrix3d& r_lrf_view) {
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Map<const Eigen::Vector3d> a(output.data() + 6 * i), b(output.data() + 6 * i + 3);
    hypotheses_[i] = r_lrf_view * rotation_of(a, b);
    logit_[i] = output.at(48 + i);
    sum += std::exp(logit_[i]);
  }
  for (int i = 0; i < 8; ++i) probability_[i] = std::exp(logit_[i]) / sum;
  likeliest_ = static_cast<int>(std::max_element(logit_.begin(), logit_.end()) - logit_.begin());
  single_frame_error_rad_ = M_PI * logistic(output.at(56));
  predict();
}

void ReferenceTrack::predict() {
  if (frames == 0) {
    predicted_.fill({hypotheses_[likeliest_], Eigen::Vector3d::Zero()});
    return;
  }
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    const Eigen::Matrix3d& inertia = inertia_[motion_model];
    Eigen::Matrix3d r = motion[motion_model].attitude;
    const Eigen::Vector3d momentum = r * inertia * r.transpose() * bounded(motion[motion_model].rate);
    const auto rate_at = [&](const Eigen::Matrix3d& at) -> Eigen::Vector3d {
      return at * inertia.inverse() * at.transpose() * momentum;
    };
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Eigen::Matrix3d middle = rotation_from_vector(rate_at(r) / 8.0) * r;
      r = rotation_from_vector(rate_at(middle) / 4.0) * r;
    }
    predicted_[motion_model] = {r, rate_at(r)};
  }
}

Eigen::Matrix3d ReferenceTrack::single_frame() {
  std::array<double, 9> weights{};
  std::copy(probability_.begin(), probability_.end(), weights.begin());
  return mean_around(likeliest_, 0, weights);
}

ReferenceTrack::Values ReferenceTrack::lstm_input(const Values& dense2) const {
  Values input = dense2;
  const auto append = [&input](const Eigen::Matrix3d& rotation) {
    for (int i = 0; i < 6; ++i) input.push_back(rotation(i % 3, i / 3));
  };
  const Eigen::Matrix3d& predicted = predicted_[motion_model()].attitude;
  for (const Eigen::Matrix3d& hypothesis : hypotheses_) append(predicted.transpose() * hypothesis);
  input.insert(input.end(), probability_.begin(), probability_.end());
  append(predicted);
  return input;
}

Eigen::Matrix3d ReferenceTrack::mean_around(int anchor, int motion_model,
                                            const std::array<double, 9>& weights) {
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::Zero();
  int members = 0;
  for (int i = 0; i < 9; ++i) {
    if (!same(candidate(i, motion_model), candidate(anchor, motion_model))) continue;
    first += weights[i] * candidate(i, motion_model).col(0);
    second += weights[i] * candidate(i, motion_model).col(1);
    ++members;
  }
  means_taken += members > 1 ? 1 : 0;
  return rotation_of(first, second);
}

void ReferenceTrack::correct(int motion_model, int anchor, const std::array<double, 9>& weights,
                             double rate_correction) {
  motion[motion_model] = predicted_[motion_model];
  motion[motion_model].attitude = mean_around(anchor, motion_model, weights);
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(motion[motion_model].attitude * predicted_[motion_model].attitude.transpose()));
  if (frames == 0 || turn.angle() >= M_PI / 3.0) return;
  const double prior = rate_gain_after(frames);
  motion[motion_model].rate +=
      logistic(rate_correction + std::log(prior / (1.0 - prior))) * turn.angle() * turn.axis();
  ++rates_corrected;
}

bool ReferenceTrack::same(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const double angle_between_deg = angle_deg(a, b);
  smallest_margin_deg = std::min(smallest_margin_deg, std::abs(angle_between_deg - 20.0));
  return angle_between_deg < 20.0;
}

double ReferenceTrack::squared_innovation(int motion_model) {
  double probability_near = 0.0;
  for (int i = 0; i < 8; ++i) {
    if (same(hypotheses_[i], predicted_[motion_model].attitude)) probability_near += probability_[i];
  }
  return probability_near < 0.1 ? kLost
                                : std::min(kLost, chord_square(motion[motion_model].attitude,
                                                               predicted_[motion_model].attitude));
}

void ReferenceTrack::advance(const Values& head) {
  std::array<double, 9> vote, weight;
  for (int i = 0; i < 9; ++i) {
    vote[i] = (i < 8 ? logit_[i] : 0.0) + head.at(i);
    weight[i] = (i < 8 ? std::max(probability_[i], 1e-6) : predicted_weight_after(frames)) *
                std::exp(std::clamp(head.at(9 + i), -8.0, 8.0));
  }
  const int anchor = static_cast<int>(std::max_element(vote.begin(), vote.end()) - vote.begin());
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model)
    correct(motion_model, anchor, weight, head.at(18));
  error_rad = M_PI * logistic(head.at(19));
  // Log-likelihood of Gaussian innovations; the first two frames are no evidence.
  const double a = attitude_gain_after(frames);
  const double variance = std::max(7e-4, error_rad * error_rad);
  std::array<double, kMotionModels> innovation;
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    innovation[motion_model] = squared_innovation(motion_model);
    log_likelihood[motion_model] *= 0.9;
    if (frames >= 2)
      log_likelihood[motion_model] -= (1.0 - a) / (2.0 * a * a) / variance * innovation[motion_model];
  }
  const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  for (double& value : log_likelihood) value = std::max(-6.0, value - best);
  std::array<double, kMotionModels> following = scores();
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model)
    following[motion_model] -= innovation[motion_model] < kLost ? 0.0 : 1e9;
  const auto best_motion_model = std::max_element(following.begin(), following.end()) - following.begin();
  for (int motion_model = 0; motion_model < kMotionModels; ++motion_model) {
    if (innovation[motion_model] >= kLost && innovation[best_motion_model] < kLost)
      motion[motion_model] = motion[best_motion_model];
  }
  ++frames;
}

}  // namespace tumblesight::gnc
