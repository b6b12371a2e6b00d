// The axes of a mesh file in those of the target.
#pragma once

#include <Eigen/Core>

#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {

// Rotation from the axes of the file to the TRF.
inline Eigen::Matrix3d axes_trf_file(MeshUp up) {
  if (up == MeshUp::kZ) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return axes;
}

}  // namespace tumblesight::sim
