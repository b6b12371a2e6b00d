#include "sim/mission/mission.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "sim/host/nearest_name.hpp"
#include "sim/mission/toml_fields.hpp"
#include "sim/mission/toml_text.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kNearest_m = 10.0;
constexpr double kFarthest_m = 500.0;
constexpr double kSlowest_deg_s = 0.1;
constexpr double kFastest_deg_s =
    20.0;  // the paper's limit; at more, a turn between two frames is not unique
const KnownKeys kKeys{{"name", "title", "mesh", "up", "scale", "unit", "origin", "inertia", "inertia_axes",
                       "symmetry", "accept", "sensor", "ranges_m", "largest_rate_deg_s", "minutes",
                       "paper_target", "quasi_symmetry_about_z"},
                      {"[panels]", "[conditions]", "[goals]"}};
const KnownKeys kGoalKeys{
    {"network_mean_deg", "pose_mean_deg", "pose_within_20deg", "verified", "verified_wrong"}};

// The goals of a mission that states none. What counts is the registered pose; the network alone must be good
// enough for registration to start from, as the networks that ship are.
std::map<std::string, MissionGoal> default_goals() {
  MissionGoal nominal, degraded, occluded, tumbling;
  nominal.network_mean_deg = 3.0;
  nominal.pose_mean_deg = 0.3;
  nominal.pose_within_20deg = 0.995;
  nominal.verified_wrong = 0.005;
  degraded = nominal;
  degraded.network_mean_deg = 4.0;
  degraded.pose_mean_deg = 0.6;
  occluded.network_mean_deg = 9.0;
  occluded.verified_wrong = 0.005;
  tumbling = nominal;
  tumbling.network_mean_deg = 3.5;
  return {{"nominal", nominal}, {"degraded", degraded}, {"occluded", occluded}, {"tumbling", tumbling}};
}

std::string relative_to(const std::string& file, const std::string& path) {
  const fs::path folder = fs::absolute(file).parent_path();
  return (folder / path).lexically_normal().string();
}

bool is_key_name(const std::string& text) {
  return !text.empty() && text.size() < 32 &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

double metres_of(const std::string& unit) {
  if (unit == "mm") return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "in") return 0.0254;
  if (unit == "ft") return 0.3048;
  return 1.0;
}

MissionMesh mesh_of(TomlFields& fields, const std::string& file) {
  MissionMesh mesh;
  const std::optional<std::string> path = fields.text("mesh");
  if (!path)
    fields.refuse("mesh", "the file of its surface (STL, OBJ, PLY, glTF), relative to the mission's folder");
  mesh.file = *path == kParametricMesh ? *path : relative_to(file, *path);
  std::error_code error;
  if (mesh.file != kParametricMesh && !fs::is_regular_file(mesh.file, error))
    fields.fail("mesh", fmt::format("mesh '{}': there is no file '{}'", *path, mesh.file));
  if (const auto up = fields.choice("up", {"y", "z"})) mesh.up = *up;
  if (const auto scale = fields.number("scale", 1e-6, 1e6)) mesh.scale = *scale;
  if (const auto unit = fields.choice("unit", {"m", "mm", "cm", "in", "ft"})) {
    if (fields.has("scale")) fields.fail("unit", "unit and scale say the same; leave one of them out");
    mesh.scale = metres_of(*unit);
  }
  if (const auto origin = fields.numbers("origin", -1e3, 1e3)) {
    if (origin->size() != 3) fields.refuse("origin", "a place [x, y, z] of the target frame in metres");
    std::copy(origin->begin(), origin->end(), mesh.origin_trf_m.begin());
  }
  if (mesh.file == kParametricMesh) {
    for (const char* of_files : {"up", "scale", "unit", "origin"}) {
      if (fields.has(of_files))
        fields.fail(of_files,
                    fmt::format("{} is for mesh files; leave it out with mesh = \"parametric\"", of_files));
    }
  }
  return mesh;
}

// Three rows of three numbers.
std::optional<InertiaElements> inertia_from_rows(const toml::array& rows) {
  double m[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    const toml::array* row = rows[i].as_array();
    if (row == nullptr || row->size() != 3) return std::nullopt;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<double> value = (*row)[j].value<double>();
      if (!value) return std::nullopt;
      m[i][j] = *value;
    }
  }
  const bool symmetric = m[0][1] == m[1][0] && m[0][2] == m[2][0] && m[1][2] == m[2][1];
  if (!symmetric) return std::nullopt;
  return InertiaElements{m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]};
}

// From the axes of a file with y up to the TRF's: x = X, y = -Z, z = Y.
InertiaElements turned_from_y_up(const InertiaElements& i) {
  return {i.xx, i.zz, i.yy, -i.xz, i.xy, -i.yz};
}

std::optional<InertiaElements> inertia_of(TomlFields& fields, const MissionMesh& mesh) {
  const std::string axes = fields.choice("inertia_axes", {"target", "file"}).value_or("target");
  const toml::node* node = fields.node("inertia");
  if (node == nullptr) return std::nullopt;
  const std::string limits =
      "[Ixx, Iyy, Izz, Ixy, Ixz, Iyz] in kg m2, or three rows of the symmetric tensor, about the centre of "
      "mass";
  const toml::array* list = node->as_array();
  if (list == nullptr) fields.refuse("inertia", limits);
  std::optional<InertiaElements> found;
  if (list->size() == 3 && (*list)[0].is_array()) {
    found = inertia_from_rows(*list);
  } else if (list->size() == 6) {
    const std::vector<double> i = *fields.numbers("inertia", -1e12, 1e12);
    found = InertiaElements{i[0], i[1], i[2], i[3], i[4], i[5]};
  }
  if (!found) fields.refuse("inertia", limits);
  if (axes == "file" && mesh.up == "y") found = turned_from_y_up(*found);
  const std::string fault = fault_of_inertia(tensor_of(*found));
  if (!fault.empty()) fields.fail("inertia", "inertia: " + fault);
  return found;
}

std::optional<JointLimits> panels_of(TomlFields& fields) {
  std::optional<TomlFields> panels = fields.table("panels");
  if (!panels) return std::nullopt;
  panels->require_known({{"turn_deg"}});
  const std::string limits =
      "[lowest, highest] in degrees, from -180 to 180, with 0 (as in the mesh) between";
  const auto turn = panels->numbers("turn_deg", -180.0, 180.0);
  if (!turn || turn->size() != 2 || !((*turn)[0] <= 0.0 && (*turn)[1] >= 0.0))
    panels->refuse("turn_deg", limits);
  return JointLimits{(*turn)[0], (*turn)[1]};
}

void require_condition(const TomlFields& fields, const std::string& name,
                       const std::vector<std::string>& conditions) {
  if (std::find(conditions.begin(), conditions.end(), name) != conditions.end()) return;
  fields.fail(name, fmt::format("{}: the conditions are {}{}", fields.full(name), fmt::join(conditions, ", "),
                                did_you_mean(name, conditions)));
}

std::map<std::string, int> conditions_of(TomlFields& fields, const std::vector<std::string>& known) {
  std::map<std::string, int> weights;
  std::optional<TomlFields> table = fields.table("conditions");
  if (!table) return weights;
  for (const std::string& name : table->keys()) {
    require_condition(*table, name, known);
    const int weight = *table->whole_number(name, 0, 100);
    if (weight > 0) weights[name] = weight;
  }
  if (weights.empty()) fields.fail("conditions", "[conditions] needs one with a weight above 0");
  return weights;
}

std::map<std::string, MissionGoal> goals_of(TomlFields& fields, const std::vector<std::string>& known) {
  std::map<std::string, MissionGoal> goals = default_goals();
  std::optional<TomlFields> table = fields.table("goals");
  if (!table) return goals;
  for (const std::string& name : table->keys()) {
    require_condition(*table, name, known);
    TomlFields of_one = *table->table(name);
    of_one.require_known(kGoalKeys);
    MissionGoal& goal = goals[name];
    const auto take = [&of_one](const char* key, double highest, std::optional<double>& value) {
      if (const auto given = of_one.number(key, 0.0, highest)) value = given;
    };
    take("network_mean_deg", 180.0, goal.network_mean_deg);
    take("pose_mean_deg", 180.0, goal.pose_mean_deg);
    take("pose_within_20deg", 1.0, goal.pose_within_20deg);
    take("verified", 1.0, goal.verified);
    take("verified_wrong", 1.0, goal.verified_wrong);
  }
  return goals;
}

// Warnings of `tumblesight mesh` that may be as they should be. A fault cannot be accepted.
std::vector<std::string> accepted_findings(TomlFields& fields) {
  const std::vector<std::string> known{"unit",  "up",        "origin", "strays",
                                       "reach", "triangles", "marker", "hidden"};
  const std::vector<std::string> keys = fields.texts("accept");
  for (const std::string& key : keys) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      fields.refuse("accept", fmt::format("a list of findings of the mesh: {}", fmt::join(known, ", ")));
  }
  return keys;
}

void take_sensor(TomlFields& fields, Mission& mission) {
  if (const auto sensor = fields.text("sensor")) {
    const bool is_file = sensor->find('/') != std::string::npos || sensor->find('.') != std::string::npos;
    mission.sensor = is_file ? relative_to(mission.file, *sensor) : *sensor;
  }
  if (const auto ranges = fields.numbers("ranges_m", kNearest_m, kFarthest_m)) {
    if (ranges->size() != 2 || (*ranges)[0] > (*ranges)[1])
      fields.refuse("ranges_m",
                    fmt::format("[nearest, farthest], from {:g} to {:g} m", kNearest_m, kFarthest_m));
    mission.ranges_m = MissionRanges{(*ranges)[0], (*ranges)[1]};
  }
  mission.largest_rate_deg_s =
      fields.number("largest_rate_deg_s", kSlowest_deg_s, kFastest_deg_s).value_or(kFastest_deg_s);
}

Mission mission_of(const toml::table& root, const std::string& file, const std::vector<std::string>& known) {
  TomlFields fields(root, file, "");
  fields.require_known(kKeys);
  Mission mission;
  mission.file = file;
  mission.name = fields.text("name").value_or("");
  if (!is_key_name(mission.name)) fields.refuse("name", "1 to 31 characters of a-z, 0-9 and _");
  mission.title = fields.text("title").value_or(mission.name);
  mission.mesh = mesh_of(fields, file);
  mission.inertia = inertia_of(fields, mission.mesh);
  mission.panels = panels_of(fields);
  mission.symmetry = fields.texts("symmetry");
  mission.accept = accepted_findings(fields);
  take_sensor(fields, mission);
  mission.conditions = conditions_of(fields, known);
  mission.goals = goals_of(fields, known);
  mission.minutes = fields.number("minutes", 0.5, 10'000.0).value_or(mission.minutes);
  mission.paper_target = fields.text("paper_target").value_or("");
  mission.quasi_symmetry_about_z = fields.whole_number("quasi_symmetry_about_z", 1, 12).value_or(1);
  return mission;
}

}  // namespace

const char* const kFirstMission =
    "name    = \"craft\"          # 1 to 31 characters of a-z, 0-9 and _\n"
    "mesh    = \"craft.glb\"      # STL, OBJ, PLY or glTF, beside this file\n"
    "up      = \"y\"              # axis of the file that becomes z of the target frame\n"
    "unit    = \"m\"              # or mm, cm, in, ft; or scale = metres per unit\n"
    "inertia = [410, 380, 300, 0, -2, 5]  # Ixx, Iyy, Izz, Ixy, Ixz, Iyz in kg m2\n";

Mission mission_from_toml(const std::string& text, const std::string& file,
                          const std::vector<std::string>& conditions) {
  return mission_of(parse_toml(text, file), file, conditions);
}

Mission read_mission(const std::string& path, const std::vector<std::string>& conditions) {
  return mission_from_toml(read_toml(path, "mission"), path, conditions);
}

}  // namespace tumblesight::sim
