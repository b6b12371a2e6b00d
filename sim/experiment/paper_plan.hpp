// PaperPlan: what `tumblesight evaluate --paper` measures, given the models and meshes that exist.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// One network on one mesh.
struct PlannedSubject {
  std::string target;
  std::string model;     // path of the model image
  std::string mesh;      // path of a mesh file; empty: the mesh that ships for the target
  bool curves = false;   // once per target: on its mesh file if there is one, otherwise on the shipped mesh
  bool baseline = true;  // once per mesh, not for every network
  bool disturbed_runs = false;  // where the curves are, for the target of the disturbed runs
  bool sensor_runs = false;     // where the curves are, for the targets of the runs under real sensors
};

struct PaperPlan {
  std::vector<PlannedSubject> subjects;
  std::vector<std::string> notes;  // what is missing, and why
};

// Every shipped target with a model image <model_folder>/<target>.tsm, on <mesh_folder>/<target>.stl where
// that exists and on the shipped mesh; then the same for <target>_paper_rule.tsm. `mesh_folder` may be empty:
// shipped meshes only. Throws std::runtime_error if the mesh folder does not exist or there is no model.
PaperPlan plan_paper(const std::string& mesh_folder, const std::string& model_folder);

}  // namespace tumblesight::sim
