// Mission: a spacecraft, how it is seen, and what is asked of its network, in one TOML file. The targets that
// ship are such files too: sim/world/target/missions.
//
// To add a key: its field below, its line in mission.cpp, its row in docs/own_spacecraft.md.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/mission/inertia.hpp"

namespace tumblesight::sim {

// Stands for the mesh that ships for a target, wherever a mesh file may be named.
inline constexpr const char* kParametricMesh = "parametric";

// How far a solar panel turns from where it stands in the mesh, about its hinge (panels.hpp), right-handed
// about the direction outwards. Both 0: it is fixed.
struct JointLimits {
  double lowest_deg = 0.0, highest_deg = 0.0;
};

struct MissionMesh {
  std::string file;                      // full path, or "parametric": the mesh of this name that ships
  std::string up = "y";                  // "y" or "z": axis of the file that is the TRF's z
  double scale = 1.0;                    // metres per unit of the file
  std::array<double, 3> origin_trf_m{};  // the place that becomes the origin of the TRF: the centre of mass
};

// What is asked of a condition. Empty: the figure is reported, and the verdict does not depend on it.
struct MissionGoal {
  std::optional<double> network_mean_deg{};   // at most: mean error of the last frames, network alone
  std::optional<double> pose_mean_deg{};      // at most: the same of the registered poses within 20 degrees
  std::optional<double> pose_within_20deg{};  // at least, 0..1
  std::optional<double> verified{};           // at least, 0..1: share of the poses that are verified
  std::optional<double> verified_wrong{};     // at most, 0..1: verified and more than 5 degrees off
};

struct MissionRanges {
  double nearest_m = 20.0, farthest_m = 100.0;
};

struct Mission {
  std::string file;   // that it was read from
  std::string name;   // 1 to 31 of a-z, 0-9 and _: of model images and files
  std::string title;  // in reports
  MissionMesh mesh;
  std::optional<InertiaElements> inertia;  // about the centre of mass, in the TRF's directions
  std::optional<JointLimits> panels;       // of every panel; empty: the file does not say
  std::vector<std::string> symmetry;       // "z:4": see TargetSymmetry
  std::vector<std::string> accept;  // findings of the mesh that are no mistakes: "origin", "strays", ...
  std::string sensor = "paper";     // name of one that ships, or full path of a description
  std::optional<MissionRanges> ranges_m;
  double largest_rate_deg_s = 20.0;
  std::map<std::string, int> conditions;     // weight by name; empty: those of `tumblesight train`
  std::map<std::string, MissionGoal> goals;  // by condition; those of the file over the defaults
  double minutes = 60.0;
  std::string paper_target;        // whose figures in the paper it is compared with; empty: none
  int quasi_symmetry_about_z = 1;  // it looks nearly the same after 1/n of a turn about z
};

// Reads the text of a mission. `file`: named in messages; paths in the text are relative to its folder.
// `conditions`: the names that [conditions] and [goals] may have. Throws std::invalid_argument that names
// file, line, key, value, limits and remedy for anything that is wrong, and for keys that do not exist.
Mission mission_from_toml(const std::string& text, const std::string& file,
                          const std::vector<std::string>& conditions);
// The same from a file. Throws also if it cannot be read.
Mission read_mission(const std::string& path, const std::vector<std::string>& conditions);

// A first file, for --help and documents.
extern const char* const kFirstMission;

}  // namespace tumblesight::sim
