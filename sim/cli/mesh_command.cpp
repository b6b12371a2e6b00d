#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/inspection/cleaned_mesh.hpp"
#include "sim/inspection/mesh_inspection.hpp"
#include "sim/inspection/six_views.hpp"
#include "sim/inspection/write_mesh.hpp"
#include "sim/report/mesh_report.hpp"
#include "sim/world/scenario/condition.hpp"
#include "sim/world/target/gltf_surface.hpp"
#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kPagePixels = 256;  // per side of a picture
constexpr int kSketchPixels = 128;

struct MeshCommandArguments {
  std::string file;
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
  Eigen::Vector3d moved_origin_trf_m = Eigen::Vector3d::Zero();  // of --mission
  std::string fix;
  std::vector<double> origin;  // empty: the centre of the surface
  bool keep_strays = false;
  std::string html;
  std::string json;
};

void require_usable(const MeshCommandArguments& arguments) {
  OptionFiles read{{"FILE", arguments.file}};
  for (const std::string& part : mesh_side_files(arguments.file)) read.push_back({"FILE (part of it)", part});
  OptionFiles written{{"--fix", arguments.fix}, {"--html", arguments.html}, {"--json", arguments.json}};
  if (std::filesystem::path(arguments.fix).extension() == ".obj")
    written.push_back({"--fix (its materials)", materials_of(arguments.fix)});
  require_usable_files(read, written);
}

// Farther away it is a typing error or a wrong unit: no spacecraft has its centre of mass there.
void require_origin_near(const MeshCommandArguments& arguments, const MeshInspection& found) {
  constexpr double kMost_radii = 10.0;
  if (arguments.origin.empty()) return;
  const Eigen::Vector3d origin_trf_m(arguments.origin[0], arguments.origin[1], arguments.origin[2]);
  const Eigen::Vector3d& centre_trf_m = found.symmetry.centre_trf_m;
  const double distance_m = (origin_trf_m - centre_trf_m).norm();
  if (distance_m <= kMost_radii * found.centred_radius_m) return;
  throw ArgumentFault(
      "--origin",
      fmt::format("is {:.4g} m from the middle of the surface, ({:.4g}, {:.4g}, {:.4g}) m, whose radius is "
                  "{:.3g} m; give a place within {:g} radii, best the centre of mass",
                  distance_m, centre_trf_m.x(), centre_trf_m.y(), centre_trf_m.z(), found.centred_radius_m,
                  kMost_radii));
}

void fix(const MeshCommandArguments& arguments, const TriangleMesh& mesh, const MeshInspection& found) {
  CleaningOptions options;
  options.keep_strays = arguments.keep_strays;
  if (!arguments.origin.empty())
    options.origin_trf_m = Eigen::Vector3d(arguments.origin[0], arguments.origin[1], arguments.origin[2]);
  const CleanedMesh result = cleaned(mesh, found, options);
  write_mesh(arguments.fix, result.mesh);
  fmt::print("  Cleaned copy: {}, {}, in metres, z up: use it with --mesh-up z.\n", full_path(arguments.fix),
             counted(result.mesh.triangles.size(), "triangle"));
  fmt::print("  Left out: {} without area, {} repeated, {} of a marker, {} of stray parts.\n", mesh.left_out,
             result.repeated, result.marker, result.strays);
  fmt::print("  Its origin is {} ({:.4f}, {:.4f}, {:.4f}) m of the original.\n\n",
             arguments.origin.empty() ? "the centre of the outer surface, at" : "at", -result.moved_m.x(),
             -result.moved_m.y(), -result.moved_m.z());
}

int show_mesh(const MeshCommandArguments& arguments, const std::string& command_line) {
  require_usable(arguments);
  MeshReport report;
  report.file = arguments.file;
  report.options = {mesh_up_from(arguments.mesh_up), arguments.mesh_scale, arguments.moved_origin_trf_m};
  report.command = command_line;
  report.generated = local_time_text();
  const TriangleMesh mesh = read_mesh_file(arguments.file, report.options);
  report.found = inspect(mesh, report.options);
  require_origin_near(arguments, report.found);
  const std::string remark = gltf_remark(arguments.file);
  if (!remark.empty()) report.found.findings.push_back({"file", Severity::kNote, remark, ""});
  fmt::print("{}", mesh_text(report, six_views(mesh, kSketchPixels)));
  if (!arguments.html.empty()) {
    write_file(arguments.html, mesh_page(report, six_views(mesh, kPagePixels)));
    fmt::print("  Page: {}\n\n", full_path(arguments.html));
  }
  if (!arguments.json.empty()) write_file(arguments.json, mesh_json(report).dump(2) + "\n");
  if (!arguments.fix.empty()) fix(arguments, mesh, report.found);
  const bool faulty =
      !report.found.findings.empty() && report.found.findings.front().severity == Severity::kFault;
  return faulty ? kOfNoUse : 0;
}

ValueCheck mesh_to_write() {
  const auto check = [](std::string& path) -> std::string {
    for (const char* ending : {".stl", ".obj"}) {
      if (path.size() > 4 && path.compare(path.size() - 4, 4, ending) == 0) return {};
    }
    return fmt::format("must end in .stl or .obj, not '{}'", path);
  };
  return ValueCheck{check, "mesh file"};
}

void add_mesh_of_mission_option(Command& command, MeshCommandArguments& arguments) {
  const auto take = [&arguments](const std::string& text) {
    try {
      const Mission mission = mission_named(text, condition_names());
      if (mission.mesh.file == kParametricMesh)
        throw std::invalid_argument("the mesh of '" + mission.name +
                                    "' ships and is in no file; give one of your own");
      arguments.file = mission.mesh.file;
      arguments.mesh_up = mission.mesh.up;
      arguments.mesh_scale = mission.mesh.scale;
      arguments.moved_origin_trf_m = mesh_file_options(mission.mesh).origin_trf_m;
    } catch (const std::invalid_argument& error) {
      throw ArgumentFault("--mission", error.what());
    }
  };
  CommandOption option = command.add_option_function<std::string>(
      "--mission", take, "the mesh of this mission file, as the mission reads it");
  option->type_name("FILE");
  for (const char* same : {"FILE", "--mesh-up", "--mesh-scale"}) option->excludes(command.get_option(same));
}

}  // namespace

void add_mesh_command(Command& app, const std::string& command_line) {
  auto arguments = std::make_shared<MeshCommandArguments>();
  Command command = add_verb(app, "mesh");
  command.footer(
      "\nReads STL, OBJ, PLY, glTF and GLB, also compressed with Draco. Exits with 0, or\n"
      "with 4 if the mesh is of no use as it is. docs/own_spacecraft.md explains each\n"
      "finding.\n\n"
      "Example: a mesh in millimetres, looked at, and written about its centre of mass\n"
      "  tumblesight mesh craft.glb --mesh-scale 0.001 --html craft.html\n"
      "  tumblesight mesh craft.glb --mesh-scale 0.001 --fix craft.stl --origin 0,0,0.8\n");
  command.add_option("FILE", arguments->file, "mesh file, unless --mission names one")->check(file_path());
  command
      .add_option("--mesh-up", arguments->mesh_up,
                  "axis of the mesh file that points along the target frame's z")
      ->check(one_of({"y", "z"}))
      ->type_name("y|z")
      ->capture_default_str();
  limit_number(command.add_option("--mesh-scale", arguments->mesh_scale, "metres per unit of the mesh file"),
               1e-6, 1e6)
      ->type_name("X")
      ->capture_default_str();
  add_mesh_of_mission_option(command, *arguments);
  CommandOption fix_option = command.add_option(
      "--fix", arguments->fix,
      "write a cleaned copy to this file (.stl or .obj): in metres, z up, about a new origin");
  fix_option->check(mesh_to_write())->type_name("FILE");
  command
      .add_option(
          "--origin", arguments->origin,
          "of the cleaned copy: a place in the target frame in metres, best the centre of mass; 0,0,0 leaves "
          "it [the centre of the outer surface]")
      ->delimiter(',')
      ->expected(3)
      ->check(number(-1e9, 1e9))
      ->type_name("X,Y,Z")
      ->needs(fix_option);
  command.add_flag("--keep-strays", arguments->keep_strays, "leave parts that lie apart in the cleaned copy")
      ->needs(fix_option);
  command.add_option("--html", arguments->html, "write a page with pictures of the six sides to this file")
      ->check(file_path())
      ->type_name("FILE");
  add_json_option(command, arguments->json);
  command.callback([arguments, command_line] {
    if (arguments->file.empty()) throw ArgumentFault("FILE (or --mission) is required");
    throw Exit(show_mesh(*arguments, command_line));
  });
}

}  // namespace tumblesight::sim
