// Which findings of a mesh's inspection speak against a network for it.
#pragma once

#include <string>
#include <vector>

#include "sim/inspection/mesh_inspection.hpp"
#include "sim/mission/mission.hpp"

namespace tumblesight::sim {

// An origin so far from the middle that a third of the image's resolution is lost is a mistake; a smaller
// loss is common, since the centre of mass is rarely that of the surface.
inline constexpr double kLargestLossByOrigin = 1.0 / 3.0;

struct MeshGate {
  std::vector<std::string> faults;   // no network can be right: the mesh has to be mended first
  std::vector<std::string> doubts;   // likely mistakes: the verdict is NO-GO because of each
  std::vector<std::string> remarks;  // of no consequence for the verdict
};

// Findings that the mission accepts are remarks, and so is a symmetry that it states.
MeshGate mesh_gate(const Mission& mission, const MeshInspection& found);

}  // namespace tumblesight::sim
