// Draws that several parts of a scenario make.
#pragma once

#include <Eigen/Geometry>

#include "sim/world/math/random.hpp"

namespace tumblesight::sim {

// Uniform on SO(3).
inline Eigen::Quaterniond uniform_attitude(Random& random) {
  // One draw per statement: the evaluation order of arguments is unspecified.
  const double z = random.normal();
  const double y = random.normal();
  const double x = random.normal();
  const double w = random.normal();
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

}  // namespace tumblesight::sim
