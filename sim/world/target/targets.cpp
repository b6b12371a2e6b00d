#include "sim/world/target/targets.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"
#include "sim/host/input_file.hpp"
#include "sim/host/nearest_name.hpp"
#include "sim/host/program_files.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr JointLimits kWholeTurn = {-180.0, 180.0};

std::vector<Mission> read_shipped_missions() {
  std::vector<std::string> files;
  const std::string& folder = program_files().missions;
  if (!fs::is_directory(folder))
    throw std::runtime_error("the folder '" + folder +
                             "' is missing, which belongs to tumblesight: install the package, or run the "
                             "program where it was built");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::vector<Mission> missions;
  for (const std::string& file : files) missions.push_back(read_mission(file, {}));
  return missions;
}

const Mission* shipped_mission(const std::string& name) {
  const std::vector<Mission>& missions = shipped_missions();
  const auto found = std::find_if(missions.begin(), missions.end(),
                                  [&](const Mission& mission) { return mission.name == name; });
  return found == missions.end() ? nullptr : &*found;
}

std::optional<Mission>& users_mission() {
  static std::optional<Mission> mission;
  return mission;
}

std::string list_of_names() {
  std::string known;
  for (const std::string& name : target_names()) known += (known.empty() ? "" : ", ") + name;
  return known;
}

void add_text(gnc::Crc32& crc, const std::string& text) {
  crc.add_u32(static_cast<std::uint32_t>(text.size()));
  crc.add(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

void add_number(gnc::Crc32& crc, double number) {
  const auto value = static_cast<float>(number);
  crc.add_f32(&value, 1);
}

void add_file(gnc::Crc32& crc, const std::string& path) {
  const InputFile file(path, {"mesh", std::numeric_limits<std::uint32_t>::max()});
  crc.add_u32(static_cast<std::uint32_t>(file.size()));
  std::vector<std::uint8_t> block(1U << 20);
  for (std::uint64_t at = 0; at < file.size();) {
    const std::size_t count = file.read_at(at, block.data(), block.size());
    if (count == 0) return;  // it has become shorter
    crc.add(block.data(), count);
    at += count;
  }
}

void add_mesh(gnc::Crc32& crc, const Mission& mission) {
  const MissionMesh& mesh = mission.mesh;
  if (mesh.file == kParametricMesh) return add_text(crc, mesh.file + " " + mission.name);
  add_file(crc, mesh.file);
  std::error_code error;
  for (const std::string& part : mesh_side_files(mesh.file)) {
    const std::string ending = fs::path(part).extension().string();
    const bool shapes = ending == ".bin" || ending == ".mtl";  // not textures
    if (shapes && fs::is_regular_file(part, error)) add_file(crc, part);
  }
  add_text(crc, mesh.up);
  add_number(crc, mesh.scale);
  for (const double place_m : mesh.origin_trf_m) add_number(crc, place_m);
}

}  // namespace

const std::vector<Mission>& shipped_missions() {
  static const std::vector<Mission> missions = read_shipped_missions();
  return missions;
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const Mission& mission : shipped_missions()) names.push_back(mission.name);
  return names;
}

const std::string& default_target() {
  if (shipped_missions().empty())
    throw std::runtime_error("there is no mission in " + program_files().missions);
  return shipped_missions().front().name;
}

std::string mission_path(const std::string& name_or_file) {
  const Mission* shipped = shipped_mission(name_or_file);
  return shipped != nullptr ? shipped->file : name_or_file;
}

Mission mission_named(const std::string& name_or_file, const std::vector<std::string>& conditions) {
  const std::string path = mission_path(name_or_file);
  std::error_code error;
  if (!fs::exists(path, error))
    throw std::invalid_argument("there is no mission '" + name_or_file + "'; give a TOML file, or one of " +
                                list_of_names());
  return read_mission(path, conditions);
}

void use_mission(const Mission& mission) {
  users_mission() = mission;
}

const Mission* find_target(const std::string& name) {
  const std::optional<Mission>& own = users_mission();
  return own && own->name == name ? &*own : shipped_mission(name);
}

std::string display_name(const std::string& target) {
  const Mission* mission = find_target(target);
  return mission != nullptr ? mission->title : target;
}

TriangleMesh target_by_name(const std::string& name) {
  if (std::optional<TriangleMesh> mesh = shipped_mesh(name)) return std::move(*mesh);
  throw std::invalid_argument("target '" + name + "' is unknown; the targets are: " + list_of_names() +
                              did_you_mean(name, target_names()));
}

std::optional<Eigen::Matrix3d> known_inertia_kg_m2(const std::string& target) {
  const Mission* mission = find_target(target);
  if (mission == nullptr || !mission->inertia) return std::nullopt;
  return tensor_of(*mission->inertia);
}

Eigen::Matrix3d inertia_kg_m2(const std::string& target) {
  if (const std::optional<Eigen::Matrix3d> inertia = known_inertia_kg_m2(target)) return *inertia;
  throw std::invalid_argument(
      "target '" + target +
      "' is unknown or its mission has no inertia; the targets are: " + list_of_names());
}

JointLimits joint_limits(const std::string& target) {
  const Mission* mission = find_target(target);
  return mission != nullptr ? mission->panels.value_or(kWholeTurn) : kWholeTurn;
}

TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options) {
  if (source != kParametricMesh) return load_mesh_file(source, options);
  if (find_target(target) == nullptr)
    throw std::invalid_argument("target '" + target +
                                "' does not ship, so there is no mesh of it here; give its file with --mesh, "
                                "or one of the targets that ship: " +
                                list_of_names() + did_you_mean(target, target_names()));
  return target_by_name(target);
}

MeshFileOptions mesh_file_options(const MissionMesh& mesh) {
  MeshFileOptions options;
  options.up = mesh_up_from(mesh.up);
  options.scale = mesh.scale;
  options.origin_trf_m = {mesh.origin_trf_m[0], mesh.origin_trf_m[1], mesh.origin_trf_m[2]};
  return options;
}

std::uint32_t mission_crc32(const Mission& mission) {
  gnc::Crc32 crc;
  add_text(crc, mission.name);
  add_mesh(crc, mission);
  if (mission.inertia) {
    const InertiaElements& i = *mission.inertia;
    for (const double element : {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz}) add_number(crc, element);
  }
  const JointLimits panels = mission.panels.value_or(JointLimits{});
  add_number(crc, panels.lowest_deg);
  add_number(crc, panels.highest_deg);
  return crc.value();
}

}  // namespace tumblesight::sim
