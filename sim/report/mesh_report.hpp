// The report of an inspection of a mesh: text for a terminal, JSON, and a page.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/inspection/mesh_inspection.hpp"
#include "sim/inspection/six_views.hpp"
#include "sim/report/data_table.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {

struct MeshReport {
  std::string file;
  MeshFileOptions options;
  MeshInspection found;
  std::string command;    // that was run
  std::string generated;  // date and time, as text
};

// "fault", "warning", "note".
const char* severity_name(Severity severity);

// Facts, one line each, as name and value.
std::vector<std::pair<std::string, std::string>> mesh_facts(const MeshReport& report);
// The principal axes: how far parts of a turn move the surface, in % of the radius, and the least in
// millimetres.
DataTable symmetry_table(const MeshReport& report);

// Facts, axes, findings, and the six sides as characters.
std::string mesh_text(const MeshReport& report, const std::array<SideView, 6>& views);
nlohmann::json mesh_json(const MeshReport& report);
// One self-contained file, with pictures of the six sides and the axes of the target frame in them.
std::string mesh_page(const MeshReport& report, const std::array<SideView, 6>& views);

}  // namespace tumblesight::sim
