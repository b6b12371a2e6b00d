// The findings of an inspection: likely mistakes in a mesh, in words, with their figures and remedies.
#pragma once

#include <string>
#include <vector>

#include "sim/inspection/mesh_inspection.hpp"

namespace tumblesight::sim {

// `file`: its ending tells the format. `found`: complete but for its findings. The gravest come first.
std::vector<Finding> findings_of(const std::string& file, const MeshInspection& found,
                                 const MeshFileOptions& options);

// "x", "-y", or "(0.50, 0.10, 0.86)".
std::string axis_name(const Eigen::Vector3d& axis);

}  // namespace tumblesight::sim
