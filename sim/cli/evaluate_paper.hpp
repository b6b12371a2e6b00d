// tumblesight evaluate --paper: every table and figure of the paper, for every target that has a model.
#pragma once

#include <string>
#include <vector>

#include "sim/cli/evaluate_arguments.hpp"

namespace tumblesight::sim {

// One network on one mesh, as it will be measured.
struct PlannedSubject {
  ScenarioArguments scenario;
  bool curves =
      false;  // on one mesh of each target: a brought one where there is one, else the parametric one
  bool baseline = true;  // once for each mesh, not for each network
};

struct PaperPlan {
  std::vector<PlannedSubject> subjects;
  std::vector<std::string> notes;  // what will be missing, and why
};

// Every target whose model image lies in `model_folder`, on <mesh_folder>/<target>.stl where that exists and
// on the parametric mesh; then the same for <target>_paper_rule.tsm. Throws std::runtime_error if the mesh
// folder does not exist or no model does.
PaperPlan plan_paper(const EvaluateArguments& arguments, const std::string& model_folder);

// Writes results.md, results.csv, results.json and report.html after every subject, so that nothing measured
// is lost.
void evaluate_paper(const EvaluateArguments& arguments);

}  // namespace tumblesight::sim
