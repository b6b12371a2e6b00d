// TargetSetup: the mesh and the model image that the arguments of a scenario name, and the swath of the
// frames.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gnc/rcnn/model_image.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct TargetSetup {
  TriangleMesh mesh;
  std::string mesh_name;                         // "parametric" or the name of the file
  std::optional<Eigen::Matrix3d> inertia_kg_m2;  // in the TRF; empty if not known
  std::string model_path;
  std::vector<std::uint8_t> model;
  gnc::ModelStatus model_status = gnc::ModelStatus::kTooShort;  // of the check on the host
  gnc::ModelHeader header;                                      // valid if kOk
  // That of the model, so that the frames fill the image as in training; that of the mesh if the model is
  // refused.
  gnc::DepthProjection projection;
  std::vector<std::string> warnings;
};

// fsw/models/<name>.tsm of the source tree.
std::string shipped_model_path(const std::string& name);

// Throws std::runtime_error or std::invalid_argument that names what is missing or wrong: target, mesh,
// inertia or model file. A model file that exists but is refused is only a warning, because the flight
// program checks it itself.
TargetSetup set_up_target(const ScenarioArguments& arguments);

}  // namespace tumblesight::sim
