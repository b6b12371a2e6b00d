// TargetSetup: the mesh and the model image that a scenario's arguments name, and the swath of the frames.
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
  std::string mesh_name;                         // "parametric" or the file's name
  std::optional<Eigen::Matrix3d> inertia_kg_m2;  // in the TRF; empty if not known
  std::string model_path;
  std::vector<std::uint8_t> model;
  gnc::ModelHeader header;
  // The model's, so that the target fills the image as in training. The mesh's without a model.
  gnc::DepthProjection projection;
  RangeLimits ranges;  // to draw from
  std::vector<std::string> warnings;
};

// <name>.tsm in the folder of the models that ship.
std::string shipped_model_path(const std::string& name);

// Mesh, model image, the description of the sensor beside it, and that of --sensor.
OptionFiles files_read(const ScenarioArguments& arguments);

// Throws std::runtime_error or std::invalid_argument that names what is missing or wrong: target, mesh,
// inertia, model image. An image that the flight program would refuse is refused here as well.
TargetSetup set_up_target(const ScenarioArguments& arguments);

// The same without a body, for verbs that see frames of others: mesh and inertia stay empty.
TargetSetup set_up_model_alone(const ScenarioArguments& arguments);

// The same for verbs that run no network. The model is that of --model, or the image that ships for the
// target. Without either the fields of the model stay empty, and the swath is that of the mesh.
TargetSetup set_up_target_without_model(const ScenarioArguments& arguments);

// The sequences that the arguments ask for. Throws as scenario_settings() of a condition.
ScenarioSettings scenario_settings(const ScenarioArguments& arguments, const TargetSetup& target);

}  // namespace tumblesight::sim
