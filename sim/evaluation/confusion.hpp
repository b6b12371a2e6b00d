// Confusion: how often an estimate is one of the attitudes in which a nearly symmetric target looks the same,
// and how good the estimate is apart from that.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

// A rotation of the target in its own frame after which it looks nearly the same. Named by its angle about z.
struct NearSymmetry {
  std::string name;
  Eigen::Quaterniond q_trf;
};

// From Mission::quasi_symmetry_about_z. The identity ("right") comes first. It is the only one for a target
// without a symmetry and for one that does not ship.
std::vector<NearSymmetry> near_symmetries(const std::string& target);

inline constexpr double kConfusionLimit_deg = 20.0;  // the paper's limit of success

struct Confusion {
  std::vector<std::string> names;  // of the symmetries
  std::vector<double> shares;      // 0..1 of the estimates, within kConfusionLimit_deg of the true attitude
                                   // turned by that symmetry
  double none = 0.0;               // share 0..1 of the estimates that are near no such attitude
  // Mean error to the nearest of these attitudes: what is left without confusion.
  double blur_deg = 0.0;
  double blur_standard_error_deg = 0.0;
  std::size_t count = 0;
};

// A missing estimate counts as none and as 180 degrees off. For the baseline only the frames where it was run
// count.
Confusion confusion(const std::vector<FrameResult>& results, Estimator estimator,
                    const std::vector<NearSymmetry>& symmetries);

}  // namespace tumblesight::sim
