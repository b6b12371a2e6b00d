// Synthetic frames and network outputs for the tests of the attitude track.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "gnc/rcnn/attitude_track.hpp"
#include "tests/support/angles.hpp"

namespace tumblesight::gnc {

// Indexes into the output of the recurrent head.
inline constexpr int kPredicted = shape::kHypotheses;  // among the candidates
inline constexpr int kWeightCorrections = shape::kCandidates;
inline constexpr int kRateCorrection = 2 * shape::kCandidates;
inline constexpr int kErrorLogit = kRateCorrection + 1;

inline Eigen::Matrix3d turn(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

inline Eigen::Matrix3d turn(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle_rad = rotation_vector_rad.norm();
  return angle_rad > 0.0 ? turn(angle_rad, rotation_vector_rad)
                         : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

inline double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  // From the chord, since the arc cosine is inaccurate for small angles.
  return 2.0 * std::asin(std::min(1.0, (a - b).norm() / (2.0 * std::sqrt(2.0))));
}
inline double angle_between(const Eigen::Matrix3f& a, const Eigen::Matrix3d& b) {
  return angle_between(Eigen::Matrix3d(a.cast<double>()), b);
}

struct Alternative {
  Eigen::Matrix3d r_lrf_trf;
  float probability;
};

// A frame whose first hypotheses are these, in descending probability. The others have a probability of zero
// and are 150 degrees from the first.
inline Hypotheses<float> make_frame(std::initializer_list<Alternative> alternatives) {
  Hypotheses<float> frame{};
  const Eigen::Matrix3d far = turn(150.0 * kDegree, {0.3, -0.5, 0.8}) * alternatives.begin()->r_lrf_trf;
  for (int i = 0; i < shape::kHypotheses; ++i) {
    const bool given = i < static_cast<int>(alternatives.size());
    const Alternative alternative = given ? alternatives.begin()[i] : Alternative{far, 0.0F};
    frame.r_lrf_trf[i] = alternative.r_lrf_trf.cast<float>();
    frame.probability[i] = alternative.probability;
    frame.logit[i] = given ? 10.0F + std::log(alternative.probability) : -30.0F;
    frame.likeliest = frame.logit[i] > frame.logit[frame.likeliest] ? i : frame.likeliest;
  }
  frame.predicted_error_rad = 0.1F;
  return frame;
}

// One frame of the estimator, with `head` as the output of the recurrent head.
inline TrackedAttitude<float> follow(const Hypotheses<float>& frame, const HeadOutput<float>& head,
                                     AttitudeTrack<float>& track, const Inertia<float>& inertia = {},
                                     const FrameInterval& interval = {}) {
  return advance<float>(frame, predict<float>(track, motion_models<float>(inertia), frame, interval), head,
                        track);
}

}  // namespace tumblesight::gnc
