#include "sim/adoption/mesh_gate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

bool is_accepted(const Mission& mission, const std::string& key) {
  if (key == "symmetry" || key == "revolution") return !mission.symmetry.empty();
  return std::find(mission.accept.begin(), mission.accept.end(), key) != mission.accept.end();
}

bool is_likely_mistake(const Finding& finding, const MeshInspection& found) {
  if (finding.severity == Severity::kNote) return false;
  if (finding.key == "origin")
    return found.centred_radius_m < (1.0 - kLargestLossByOrigin) * found.core_radius_m;
  return finding.key == "unit" || finding.key == "up" || finding.key == "strays" || finding.key == "marker" ||
         finding.key == "hidden";
}

std::string how_to_accept(const std::string& key) {
  return fmt::format(" If it is as it should be, write accept = [\"{}\"] in the mission.", key);
}

std::string panels_remark(const MeshInspection& found) {
  return fmt::format(
      "The mesh has {}, and the mission does not say whether they turn: the network learns them as they "
      "stand in "
      "the mesh. [panels] turn_deg = [-180, 180] lets them turn, [0, 0] says that they are fixed.",
      counted(found.panels, "solar panel"));
}

}  // namespace

MeshGate mesh_gate(const Mission& mission, const MeshInspection& found) {
  MeshGate gate;
  for (const Finding& finding : found.findings) {
    const std::string text = finding.remedy.empty() ? finding.text : finding.text + " " + finding.remedy;
    if (is_accepted(mission, finding.key)) {
      gate.remarks.push_back("Accepted by the mission: " + finding.text);
    } else if (finding.severity == Severity::kFault) {
      const bool symmetric = finding.key == "symmetry" || finding.key == "revolution";
      gate.faults.push_back(text + (symmetric
                                        ? " If attitudes that look the same are all right for you, state "
                                          "the symmetry in the mission, for example symmetry = [\"z:2\"]."
                                        : ""));
    } else if (is_likely_mistake(finding, found)) {
      gate.doubts.push_back(text + how_to_accept(finding.key));
    } else {
      gate.remarks.push_back(text);
    }
  }
  const bool turn = mission.panels && mission.panels->lowest_deg < mission.panels->highest_deg;
  if (turn && found.panels == 0)
    gate.faults.push_back(
        "The mission has panels that turn, and none is found in the mesh: name their material solar or panel "
        "(OBJ, glTF), "
        "separate them from the body, or leave [panels] out.");
  if (mission.inertia) {
    const std::string fault = fault_of_inertia_in_mesh(tensor_of(*mission.inertia), found.radius_m);
    if (!fault.empty()) gate.faults.push_back("In the mission " + fault + ".");
  }
  if (found.panels > 0 && !mission.panels) gate.remarks.push_back(panels_remark(found));
  return gate;
}

}  // namespace tumblesight::sim
