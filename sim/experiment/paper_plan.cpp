#include "sim/experiment/paper_plan.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/model/model_file.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

// The hardest target: four of its attitudes look nearly alike.
constexpr const char* kDisturbedTarget = "near_shoemaker";

// Empty when there is no such file.
std::string file_in(const std::string& folder, const std::string& name) {
  if (folder.empty()) return {};
  const fs::path path = fs::path(folder) / name;
  std::error_code error;
  return fs::is_regular_file(path, error) ? path.string() : std::string{};
}

// Empty when there is no such image. An image that the repository's history has is not left out: the error
// says how to get it.
std::string model_in(const std::string& folder, const std::string& name) {
  const std::string model = file_in(folder, name + ".tsm");
  const std::string expected = (fs::path(folder) / (name + ".tsm")).string();
  const std::string remedy = remedy_for_missing_image(expected);
  if (model.empty() && !remedy.empty() && !file_in(folder, name + ".json").empty()) {
    throw std::runtime_error(fmt::format("model image '{}' does not exist{}", expected, remedy));
  }
  return model;
}

// The curves are drawn on the first of the meshes.
std::vector<PlannedSubject> on_each_mesh(const std::string& target, const std::string& model,
                                         const std::string& mesh) {
  if (model.empty()) return {};
  std::vector<PlannedSubject> subjects;
  if (!mesh.empty()) subjects.push_back({target, model, mesh});
  subjects.push_back({target, model, {}});
  subjects.front().curves = true;
  subjects.front().disturbed_runs = target == kDisturbedTarget;
  subjects.front().sensor_runs = has_sensor_runs(target);
  return subjects;
}

}  // namespace

PaperPlan plan_paper(const std::string& mesh_folder, const std::string& model_folder) {
  std::error_code error;
  if (!mesh_folder.empty() && !fs::is_directory(mesh_folder, error)) {
    throw std::runtime_error(fmt::format(
        "--mesh-folder '{}' is not a folder; give one that holds <target>.stl, y up", mesh_folder));
  }
  PaperPlan plan;
  std::vector<PlannedSubject> by_paper_rule;
  for (const std::string& target : target_names()) {
    const std::string mesh = file_in(mesh_folder, target + ".stl");
    const std::string model = model_in(model_folder, target);
    const std::string rule_model = model_in(model_folder, target + "_paper_rule");
    if (model.empty()) {
      plan.notes.push_back(fmt::format("{} is left out: no model {}.tsm ships yet.", target, target));
    } else if (mesh.empty() && !mesh_folder.empty()) {
      plan.notes.push_back(
          fmt::format("{}: no {}.stl in the mesh folder, parametric mesh only.", target, target));
    }
    for (const PlannedSubject& planned : on_each_mesh(target, model, mesh)) plan.subjects.push_back(planned);
    for (PlannedSubject planned : on_each_mesh(target, rule_model, mesh)) {
      planned.curves = false;
      planned.disturbed_runs = false;
      planned.sensor_runs = false;
      planned.baseline = model.empty();
      by_paper_rule.push_back(planned);
    }
  }
  plan.subjects.insert(plan.subjects.end(), by_paper_rule.begin(), by_paper_rule.end());
  if (plan.subjects.empty()) {
    throw std::runtime_error(fmt::format(
        "no model image <target>.tsm in '{}': train one, see tumblesight train --help", model_folder));
  }
  return plan;
}

}  // namespace tumblesight::sim
