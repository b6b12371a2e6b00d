// Confusion: how often an estimate is one of the attitudes in which a nearly symmetric target looks the same,
// and how good the estimate is apart from that.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

// A rotation of the target in its own frame after which it looks nearly as before. Those known are all about
// z and go by their angle.
struct NearSymmetry {
  std::string name;
  Eigen::Quaterniond q_trf;
};

// The identity ("right") first; alone for targets without any, a user's own among them.
std::vector<NearSymmetry> near_symmetries(const std::string& target);

inline constexpr double kConfusionLimit_deg = 20.0;  // the paper's limit of success

struct Confusion {
  std::vector<std::string> names;  // of the symmetries
  std::vector<double> shares;      // 0..1 of the estimates, within kConfusionLimit_deg of the true attitude
                                   // turned by that symmetry
  double none = 0.0;               // of no such attitude
  double blur_deg = 0.0;  // mean error to the nearest of these attitudes: what is left without confusion
  double blur_standard_error_deg = 0.0;
  std::size_t count = 0;
};

// An estimate that is missing counts as none, 180 degrees off. Of the baseline only frames where it was run.
Confusion confusion(const std::vector<FrameResult>& results, Estimator estimator,
                    const std::vector<NearSymmetry>& symmetries);

}  // namespace tumblesight::sim
