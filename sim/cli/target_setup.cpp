#include "sim/cli/target_setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/text.hpp"
#include "sim/model/model_file.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwathTolerance = 0.02;  // relative to the model's swath: half an image cell on either side

TriangleMesh load_mesh(const ScenarioArguments& arguments) {
  MeshFileOptions options;
  options.up = mesh_up_from(arguments.mesh_up);
  options.scale = arguments.mesh_scale;
  options.origin_trf_m = arguments.mesh_origin_trf_m;
  return target_mesh(arguments.target, arguments.mesh.empty() ? kParametricMesh : arguments.mesh, options);
}

std::string model_path(const ScenarioArguments& arguments) {
  if (!arguments.model.empty()) return arguments.model;
  return shipped_model_path(arguments.target + (arguments.numerics == "float32" ? ".float32" : ""));
}

std::optional<Eigen::Matrix3d> inertia_of(const ScenarioArguments& arguments) {
  if (arguments.inertia.empty()) return known_inertia_kg_m2(arguments.target);
  return checked_inertia(arguments.inertia);
}

std::vector<std::uint8_t> read_model(const ScenarioArguments& arguments, const std::string& path) {
  const std::string fault = fault_of_model_path(path);
  if (fault.empty()) return read_model_bytes(path);
  const bool trainable = arguments.model.empty() && remedy_for_missing_image(path).empty();
  throw std::runtime_error(
      fault + (trainable ? "; train one for this target (docs/training.md), or give one with --model" : ""));
}

void compare_swaths(TargetSetup& setup) {
  const double of_model = 1e-3 * setup.projection.swath_mm;
  const double of_mesh = swath_m(setup.mesh);
  if (std::abs(of_mesh - of_model) <= kSwathTolerance * of_model) return;
  setup.warnings.push_back(
      fmt::format("The mesh needs a swath of {:.2f} m. The network was trained for {:.2f} m, which is used: "
                  "{}",
                  of_mesh, of_model,
                  of_mesh > of_model ? "parts of the target may lie outside the image."
                                     : "the target looks smaller than the network expects."));
}

TargetSetup set_up_body(const ScenarioArguments& arguments) {
  TargetSetup setup;
  setup.mesh = load_mesh(arguments);
  const std::string left_out = left_out_note(setup.mesh);
  if (!left_out.empty()) setup.warnings.push_back(fmt::format("Mesh '{}': {}.", arguments.mesh, left_out));
  setup.mesh_name =
      arguments.mesh.empty() ? kParametricMesh : std::filesystem::path(arguments.mesh).filename().string();
  setup.inertia_kg_m2 = inertia_of(arguments);
  if (setup.inertia_kg_m2) require_possible_inertia(*setup.inertia_kg_m2, setup.mesh.radius_m());
  return setup;
}

void set_up_ranges(const ScenarioArguments& arguments, TargetSetup& setup) {
  setup.ranges = ranges_of(arguments.sensor, 1e-3 * setup.projection.swath_mm, setup.warnings);
}

// Of an image that is refused.
std::string fault_of_image(const TargetSetup& setup, const std::string& target, gnc::ModelStatus status) {
  const std::string refused =
      fmt::format("model image '{}' is refused: {}", setup.model_path, gnc::to_string(status));
  if (status != gnc::ModelStatus::kBadTarget) return refused;
  const HostEstimator other(setup.model);
  if (other.status() != gnc::ModelStatus::kOk) return refused;
  return fmt::format(
      "{}: it is for {}, and the run is for {}; give --target {}, or the model of {}, which `tumblesight "
      "train --target {}` makes",
      refused, other.model().target.data(), target, other.model().target.data(), target, target);
}

void load_model(const ScenarioArguments& arguments, TargetSetup& setup) {
  setup.model_path = model_path(arguments);
  setup.model = read_model(arguments, setup.model_path);
  const HostEstimator estimator(setup.model, arguments.target.c_str());
  if (estimator.status() != gnc::ModelStatus::kOk)
    throw std::runtime_error(fault_of_image(setup, arguments.target, estimator.status()));
  setup.header = estimator.model();
  setup.projection = setup.header.projection;
}

// An image that does not know its mission, as those from before there were any, is taken as it is.
void compare_missions(const ScenarioArguments& arguments, TargetSetup& setup) {
  if (!arguments.mission || setup.header.mission_crc32 == 0) return;
  const std::uint32_t wanted = mission_crc32(*arguments.mission);
  if (wanted == setup.header.mission_crc32) return;
  setup.warnings.push_back(
      fmt::format("Model image '{}' was trained for another mission ({:08x}) than {} ({:08x}): the mesh "
                  "file, its axes, unit or "
                  "origin, the inertia or the panels differ. Give the mission that it was trained for, or "
                  "adopt this one.",
                  setup.model_path, setup.header.mission_crc32, arguments.mission->file, wanted));
}

void set_up_model(const ScenarioArguments& arguments, TargetSetup& setup) {
  load_model(arguments, setup);
  compare_missions(arguments, setup);
  compare_swaths(setup);
}

}  // namespace

std::string shipped_model_path(const std::string& name) {
  return program_files().models + "/" + name + ".tsm";
}

OptionFiles files_read(const ScenarioArguments& arguments) {
  const std::string model = model_path(arguments);
  OptionFiles files = mesh_files_read("--mesh", arguments.mesh);
  files.insert(files.end(), {{"--model", model},
                             {"--model (its sensor)", sensor_file_of(model)},
                             {"--model (its float32 image)", model_stem(model) + ".float32.tsm"},
                             {"--sensor", arguments.sensor.file}});
  return files;
}

TargetSetup set_up_target(const ScenarioArguments& arguments) {
  TargetSetup setup = set_up_body(arguments);
  set_up_model(arguments, setup);
  const std::string warning = check_sensor_of_model(setup.model_path, arguments.sensor.sensor);
  if (!warning.empty()) setup.warnings.push_back(warning);
  set_up_ranges(arguments, setup);
  return setup;
}

TargetSetup set_up_model_alone(const ScenarioArguments& arguments) {
  TargetSetup setup;
  load_model(arguments, setup);
  return setup;
}

TargetSetup set_up_target_without_model(const ScenarioArguments& arguments) {
  TargetSetup setup = set_up_body(arguments);
  const bool given = !arguments.model.empty();
  const bool ships = find_target(arguments.target) && fault_of_model_path(model_path(arguments)).empty();
  if (given || ships) {
    set_up_model(arguments, setup);
    const std::string warning =
        given ? check_sensor_of_model(setup.model_path, arguments.sensor.sensor) : std::string{};
    if (!warning.empty()) setup.warnings.push_back(warning);
  } else {
    setup.projection = projection_of(setup.mesh);
  }
  set_up_ranges(arguments, setup);
  return setup;
}

ScenarioSettings scenario_settings(const ScenarioArguments& arguments, const TargetSetup& target) {
  ScenarioSettings settings = scenario_settings(condition_from(arguments.condition), arguments.frames,
                                                arguments.target, target.inertia_kg_m2);
  settings.disturbances = arguments.disturbances;
  settings.effects = arguments.effects;
  settings.sensor = arguments.sensor.sensor.settings;
  settings.ranges = target.ranges;
  settings.swath_m = 1e-3 * target.projection.swath_mm;
  return settings;
}

}  // namespace tumblesight::sim
