#include "sim/report/mesh_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/host/text.hpp"
#include "sim/inspection/findings.hpp"

namespace tumblesight::sim {
namespace {

using nlohmann::json;

constexpr std::size_t kWidth = 98;  // columns of the report
constexpr int kSketchColumns = 32;  // of a side
constexpr int kSketchRows = 16;     // a character is twice as high as wide
constexpr std::size_t kSketchesInARow = 3;
constexpr const char* kShades = " .:-=+*#%@";
constexpr int kLastShade = 9;
constexpr float kFarthest = 0.5F;  // brightness of the farthest surface over that of the nearest

double percent(double part, double whole) {
  return 100.0 * part / whole;
}

// Three digits, without an exponent.
std::string metres(double length_m) {
  return std::abs(length_m) < 100.0 ? fmt::format("{:.3g}", length_m) : fmt::format("{:.0f}", length_m);
}

std::string place_text(const Eigen::Vector3d& place) {
  return fmt::format("({}, {}, {})", metres(place.x()), metres(place.y()), metres(place.z()));
}

std::string units_text(const MeshReport& report) {
  const double radius_m = report.found.centred_radius_m;
  if (radius_m >= kSmallestPlausibleRadius_m && radius_m <= kLargestPlausibleRadius_m) return "plausible";
  const double radius = radius_m / report.options.scale;
  std::string text;
  for (const Unit& unit : report.found.likely_units)
    text +=
        fmt::format("{}{} (radius {:.3g} m)", text.empty() ? "" : ", or ", unit.name, unit.length_m * radius);
  return text.empty() ? "no usual unit makes a spacecraft of it" : "more likely " + text;
}

std::string closed_text(const MeshEdges& edges) {
  if (edges.open == 0 && edges.crowded == 0) return "yes";
  return fmt::format("no: of {} edges {} are open, {} belong to more than two triangles", edges.edges,
                     edges.open, edges.crowded);
}

std::string panels_text(const MeshInspection& found) {
  if (found.panels == 0) return "none found";
  return fmt::format("{}, found by {}", found.panels,
                     found.panels_are_named ? "the names of their materials" : "their shape");
}

// The character at a place of a side's sketch: the mean brightness of its pixels, less for what is farther
// away.
char shade_at(const SideView& view, int row, int column) {
  const int high = view.pixels / kSketchRows, wide = view.pixels / kSketchColumns;
  float sum = 0.0F;
  for (int y = row * high; y < (row + 1) * high; ++y) {
    for (int x = column * wide; x < (column + 1) * wide; ++x) {
      const int pixel = y * view.pixels + x;
      sum += view.brightness[pixel] * (kFarthest + (1.0F - kFarthest) * view.nearness[pixel]);
    }
  }
  const float mean = sum / static_cast<float>(high * wide);
  if (mean <= 0.0F) return kShades[0];
  return kShades[std::clamp(static_cast<int>(mean * (kLastShade + 1)), 1, kLastShade)];
}

std::string middle_text(const SideView& view) {
  return view.middle_trf_m.isZero() ? "the origin" : place_text(view.middle_trf_m) + " m";
}

std::string title_of(const ViewSide& side) {
  return fmt::format("from {}: {} right, {} up", side.from, side.right, side.up);
}

std::string without_end_spaces(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string sketches(const std::array<SideView, 6>& views) {
  std::string text;
  for (std::size_t first = 0; first < views.size(); first += kSketchesInARow) {
    std::string titles = "  ";
    for (std::size_t i = first; i < first + kSketchesInARow; ++i)
      titles += fmt::format("{:<{}}", title_of(views[i].side), kSketchColumns + 1);
    text += without_end_spaces(titles);
    for (int row = 0; row < kSketchRows; ++row) {
      std::string line;
      for (std::size_t i = first; i < first + kSketchesInARow; ++i) {
        for (int column = 0; column < kSketchColumns; ++column) line += shade_at(views[i], row, column);
        line += ' ';
      }
      const bool is_empty = line.find_first_not_of(' ') == std::string::npos;
      if (!is_empty) text += without_end_spaces("  " + line);
    }
    text += "\n";
  }
  return text;
}

std::string indented(const std::string& text, const std::string& first, const std::string& further) {
  std::string result = first;
  for (const char c : wrapped(text, kWidth - further.size())) {
    result += c;
    if (c == '\n') result += further;
  }
  return result + "\n";
}

std::string findings_text(const MeshInspection& found) {
  if (found.findings.empty()) return "  Nothing was found that a network would suffer from.\n";
  std::string text;
  for (const Finding& finding : found.findings) {
    const std::string whole = finding.text + (finding.remedy.empty() ? "" : " " + finding.remedy);
    text += indented(whole, fmt::format("  {:<9}", severity_name(finding.severity)), "           ");
  }
  return text;
}

json axis_json(const SymmetryAxis& axis, double radius_m) {
  json moved = json::array();
  for (std::size_t i = 0; i < kFolds.size(); ++i)
    moved.push_back({{"fold", kFolds[i]},
                     {"moved_m", axis.moved_m[i]},
                     {"moved_share_of_radius", axis.moved_m[i] / radius_m}});
  return {{"axis_trf", {axis.axis_trf.x(), axis.axis_trf.y(), axis.axis_trf.z()}},
          {"turns", moved},
          {"any_turn_moved_m", axis.any_turn_m}};
}

json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::kFault:
      return "fault";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      break;
  }
  return "note";
}

std::vector<std::pair<std::string, std::string>> mesh_facts(const MeshReport& report) {
  const MeshInspection& found = report.found;
  const Eigen::Vector3d size_m = found.box_trf_m.sizes();
  const bool y_up = report.options.up == MeshUp::kY;
  return {
      {"triangles", fmt::format("{}, {} m2, in {}; {} left out", found.triangles, metres(found.area_m2),
                                counted(found.shells, "shell"), found.left_out)},
      {"axes", y_up ? "--mesh-up y: x is the file's x, y its -z, z its y" : "--mesh-up z: those of the file"},
      {"size", fmt::format("{} x {} x {} m along x, y, z", metres(size_m.x()), metres(size_m.y()),
                           metres(size_m.z()))},
      {"radius", fmt::format("{} m about the origin, {} m about the centre", metres(found.radius_m),
                             metres(found.centred_radius_m))},
      {"centre of surface", fmt::format("{} m, {:.3g} m from the origin",
                                        place_text(found.symmetry.centre_trf_m), found.centre_distance_m())},
      {"unit", fmt::format("{:g} m (--mesh-scale): {}", report.options.scale, units_text(report))},
      {"parts apart", found.parts.size() < 2 ? "none"
                                             : fmt::format("{}, of which {} enlarge the radius",
                                                           found.parts.size() - 1, found.strays.size())},
      {"closed", closed_text(found.edges)},
      {"solar panels", panels_text(found)},
  };
}

DataTable symmetry_table(const MeshReport& report) {
  DataTable table;
  table.header = {"principal axis", "extent"};
  for (const int fold : kFolds) table.header.push_back(fmt::format("1/{}", fold));
  for (const char* heading : {"others", "least"}) table.header.emplace_back(heading);
  const SurfaceSymmetry& symmetry = report.found.symmetry;
  const auto cell = [&report](double moved_m) {
    return TableCell{fmt::format("{:.2f}", percent(moved_m, report.found.centred_radius_m))};
  };
  for (int i = 0; i < 3; ++i) {
    const SymmetryAxis& axis = symmetry.axes[i];
    std::vector<TableCell> row{{axis_name(axis.axis_trf)}, {metres(symmetry.extent_m[i]) + " m"}};
    for (const double moved_m : axis.moved_m) row.push_back(cell(moved_m));
    row.push_back(cell(axis.any_turn_m));
    row.push_back({fmt::format("{:.0f} mm", 1e3 * axis.moved_m[best_fold(axis)])});
    table.rows.push_back(row);
  }
  return table;
}

std::string mesh_text(const MeshReport& report, const std::array<SideView, 6>& views) {
  std::string text = fmt::format("\n  Mesh {}\n\n", report.file);
  for (const auto& [name, value] : mesh_facts(report))
    text += indented(value, fmt::format("  {:<18}", name), "                    ");
  text +=
      "\n  How far parts of a turn move the outer surface on average, in % of the radius and at least:\n\n";
  text += terminal_text(symmetry_table(report));
  text += fmt::format("\n  The six sides in axes of the target frame, {} m wide, {} in the middle:\n\n",
                      metres(views.front().swath_m), middle_text(views.front()));
  return text + sketches(views) + findings_text(report.found) + "\n";
}

json mesh_json(const MeshReport& report) {
  const MeshInspection& found = report.found;
  json axes = json::array();
  for (const SymmetryAxis& axis : found.symmetry.axes)
    axes.push_back(axis_json(axis, found.centred_radius_m));
  json findings = json::array();
  for (const Finding& finding : found.findings)
    findings.push_back({{"key", finding.key},
                        {"severity", severity_name(finding.severity)},
                        {"text", finding.text},
                        {"remedy", finding.remedy}});
  json units = json::array();
  for (const Unit& unit : found.likely_units)
    units.push_back({{"name", unit.name}, {"mesh_scale", unit.length_m}});
  return {{"file", report.file},
          {"mesh_up", report.options.up == MeshUp::kY ? "y" : "z"},
          {"mesh_scale", report.options.scale},
          {"triangles", found.triangles},
          {"left_out", found.left_out},
          {"repeated", found.repeated},
          {"shells", found.shells},
          {"edges",
           {{"all", found.edges.edges},
            {"open", found.edges.open},
            {"crowded", found.edges.crowded},
            {"turned", found.edges.turned}}},
          {"area_m2", found.area_m2},
          {"box_trf_m", {vector_json(found.box_trf_m.min()), vector_json(found.box_trf_m.max())}},
          {"radius_m", found.radius_m},
          {"radius_without_strays_m", found.core_radius_m},
          {"radius_about_centre_m", found.centred_radius_m},
          {"centre_trf_m", vector_json(found.symmetry.centre_trf_m)},
          {"parts", found.parts.size()},
          {"strays", found.strays.size()},
          {"panels", found.panels},
          {"likely_units", units},
          {"extent_m", vector_json(found.symmetry.extent_m)},
          {"axes", axes},
          {"findings", findings}};
}

}  // namespace tumblesight::sim
