// Hypotheses: what the CNN says of one frame: several attitudes, since one frame of a nearly symmetric target
// leaves several open, with their probabilities.
#pragma once

#include <Eigen/Core>
#include <array>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

struct Hypotheses {
  std::array<Eigen::Matrix3f, shape::kHypotheses> r_lrf_trf;
  std::array<float, shape::kHypotheses> logit;
  std::array<float, shape::kHypotheses> probability;
  int likeliest;  // the first of equals
  float predicted_error_rad;
};

// `output` states the attitudes in the depth image's view.
Hypotheses hypotheses_of(const OutputVector& output, const Eigen::Matrix3f& r_lrf_view);

// Attitudes nearer to each other than this are one attitude, measured twice; farther ones are alternatives.
inline constexpr float kSameAttitude_deg = 20.0F;
bool same_attitude(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b);

// Weighted mean of those `candidates` that are the same attitude as candidate `anchor`: their first two
// columns averaged and orthonormalised. Not finite where the anchor is not.
Eigen::Matrix3f mean_attitude(const Eigen::Matrix3f* candidates, const float* weights, int count, int anchor);

}  // namespace tumblesight::gnc
