#include "sim/cli/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "sim/cli/mission_arguments.hpp"
#include "sim/host/nearest_name.hpp"
#include "sim/host/text.hpp"
#include "sim/model/model_file.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

// A simulated frame takes about half a kilobyte until the report is written.
constexpr std::uint64_t kMaxRunFrames = 1'000'000;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string condition_help() {
  return "sensor and motion: " + joined(condition_names());
}

bool has_a_file(const std::string& mesh) {
  return !mesh.empty() && mesh != kParametricMesh;
}
bool has_a_file(const std::vector<std::string>& meshes) {
  return std::any_of(meshes.begin(), meshes.end(), [](const std::string& mesh) { return has_a_file(mesh); });
}

// `mesh` is one file name or a list of them.
template <class Mesh>
void add_mesh_file_options(Command& command, Mesh& mesh, std::string& up, double& scale,
                           const std::string& help) {
  CommandOption option = command.add_option("--mesh", mesh, help);
  option->check(file_path())->type_name("FILE");
  CommandOption axis =
      command.add_option("--mesh-up", up, "axis of the mesh file that points along the target frame's z");
  axis->check(one_of({"y", "z"}))->type_name("y|z")->capture_default_str()->needs(option);
  CommandOption unit = command.add_option("--mesh-scale", scale, "metres per unit of the mesh file");
  limit_number(unit, 1e-6, 1e6)->type_name("X")->capture_default_str()->needs(option);
  command.parse_complete_callback([&mesh, axis, unit] {
    for (const CommandOption of_files : {axis, unit}) {
      if (of_files->count() > 0 && !has_a_file(mesh))
        throw ArgumentFault(of_files->get_name(),
                            "is for mesh files, and --mesh parametric has its axes and unit; leave " +
                                of_files->get_name() + " out, or give a file with --mesh");
    }
  });
}

// Before the default that stands in brackets at the end.
void describe_limits(CommandOption option, const std::string& limits) {
  std::string description = option.get_description();
  const std::size_t bracket = description.rfind(" [");
  option.description(description.insert(std::min(bracket, description.size()), limits));
}

MeshFileOptions mesh_file_options(const MeshArguments& arguments) {
  MeshFileOptions options;
  options.up = mesh_up_from(arguments.mesh_up);
  options.scale = arguments.mesh_scale;
  options.origin_trf_m = arguments.origin_trf_m;
  return options;
}

std::vector<std::string> divided_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0, end = 0;
  while ((end = text.find(',', begin)) != std::string::npos) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

// "none", or effects as after --effect, whose strengths may be ranges.
EffectRanges effect_set_from(const std::string& text) {
  if (text == "none") return {};
  try {
    return effect_ranges_from(divided_at_commas(text));
  } catch (const std::invalid_argument& error) {
    throw ArgumentFault("--effect-set", error.what());
  }
}

}  // namespace

ValueCheck target_name() {
  const auto check = [](std::string& text) -> std::string {
    const bool plain = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
    if (plain && !text.empty() && text.size() < 32) return {};
    return fmt::format("must be 1 to 31 characters of a-z, 0-9 and _, not '{}'", text);
  };
  return ValueCheck{check, "target name"};
}

ValueCheck existing_model_image() {
  const auto check = [](std::string& path) -> std::string { return fault_of_model_path(path); };
  return ValueCheck{check, "model image"};
}

ValueCheck file_path() {
  const auto check = [](std::string& text) -> std::string {
    return text.empty() ? "must be a path, not ''; leave the option out for its default" : "";
  };
  return ValueCheck{check, "path"};
}

namespace {

// Of what is not a regular file: what it is, and what to do.
const char* fault_of_type(std::filesystem::file_type type) {
  using Type = std::filesystem::file_type;
  if (type == Type::not_found || type == Type::none) return "does not exist";
  if (type == Type::directory) return "is a folder; give a file";
  if (type == Type::fifo) return "is a pipe, which cannot be read twice; write its content to a file first";
  if (type == Type::socket) return "is a socket; give a file";
  return "is a device; give a file";
}

}  // namespace

ValueCheck existing_file() {
  const auto check = [](std::string& text) -> std::string {
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::status(text, error).type();
    if (type == std::filesystem::file_type::regular) return {};
    return fmt::format("'{}' {}", text, fault_of_type(type));
  };
  return ValueCheck{check, "existing file"};
}

ValueCheck one_of(const std::vector<std::string>& names) {
  const auto check = [names](std::string& text) -> std::string {
    for (const std::string& name : names) {
      if (name == text) return {};
    }
    return fmt::format("must be one of {}, not '{}'{}", joined(names), text, did_you_mean(text, names));
  };
  return ValueCheck{check, "choice"};
}

ValueCheck whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    const bool within = whole && value >= low && value <= high;
    if (within && text == std::to_string(value)) return {};
    return fmt::format("must be a whole number from {} to {}{}, not '{}'", low, high,
                       within ? " without leading zeros" : "", text);
  };
  return ValueCheck{check, "whole number"};
}

ValueCheck number(double low, double high) {
  const auto check = [low, high](std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && value >= low && value <= high) return {};
    return fmt::format("must be a number from {:g} to {:g}, not '{}'", low, high, text);
  };
  return ValueCheck{check, "number"};
}

CommandOption limit_whole_number(CommandOption option, std::uint64_t low, std::uint64_t high) {
  describe_limits(option, fmt::format(" ({} to {})", low, high));
  return option->check(whole_number(low, high));
}

CommandOption limit_number(CommandOption option, double low, double high) {
  describe_limits(option, fmt::format(" ({:g} to {:g})", low, high));
  return option->check(number(low, high));
}

void add_target_option(Command& command, std::string& target, TargetChoice choice) {
  const std::string shipped = "spacecraft: " + joined(target_names());
  const bool any = choice != TargetChoice::kShipped;
  const std::string own = std::string(", or with ") + (choice == TargetChoice::kAny ? "--mesh" : "--model") +
                          " a name of your own";
  command.add_option("--target", target, any ? shipped + own : shipped)
      ->check(any ? target_name() : one_of(target_names()))
      ->type_name("NAME")
      ->capture_default_str();
}

void add_condition_option(Command& command, std::string& condition) {
  command.add_option("--condition", condition, condition_help())
      ->check(one_of(condition_names()))
      ->type_name("NAME")
      ->capture_default_str();
}

void add_condition_option(Command& command, std::vector<std::string>& conditions) {
  command.add_option("--condition", conditions, condition_help() + "; several: a,b")
      ->delimiter(',')
      ->check(one_of(condition_names()))
      ->type_name("NAMES")
      ->capture_default_str();
}

void add_seed_option(Command& command, std::uint64_t& seed) {
  limit_whole_number(
      command.add_option("--seed", seed, "seed of all random numbers; the same seed gives the same run"), 0,
      std::numeric_limits<std::uint64_t>::max())
      ->type_name("N")
      ->capture_default_str();
}

void add_float32_model_option(Command& command, std::string& model) {
  command.add_option("--model", model, "model image in float32, as `tumblesight train` writes it")
      ->required()
      ->check(existing_model_image())
      ->type_name("FILE");
}

void add_effect_option(Command& command, Effects& effects) {
  const auto take = [&effects](const std::vector<std::string>& texts) {
    if (texts == std::vector<std::string>{"list"}) {
      fmt::print("Effects, each as NAME=STRENGTH\n\n{}", effect_explanations());
      throw Exit(0);
    }
    try {
      effects = effects_from(texts);
    } catch (const std::invalid_argument& error) {
      throw ArgumentFault("--effect", error.what());
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--effect", take, "what a real sensor and scene add, all at once; --effect list explains each")
      ->delimiter(',')
      ->type_name("NAME=STRENGTH,...");
}

void add_effect_set_option(Command& command, std::vector<EffectRanges>& effect_sets) {
  const auto take = [&effect_sets](const std::vector<std::string>& texts) {
    effect_sets.clear();
    for (const std::string& text : texts) effect_sets.push_back(effect_set_from(text));
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--effect-set", take,
          "effects that act together, or none; give it once per set: frames and sequences take turns "
          "among the sets. A strength LOW:HIGH is drawn anew for each of them")
      ->excludes(command.get_option("--effect"))
      ->type_name("none|NAME=STRENGTH,...");
}

void require_a_name(const Command& command, const std::vector<std::string>& meshes) {
  const bool named =
      command.get_option("--target")->count() > 0 || command.get_option("--mission")->count() > 0;
  if (named || !has_a_file(meshes)) return;
  throw ArgumentFault(
      "--mesh",
      "name the spacecraft of the file with --target: a name of your own, or that of a shipped target if the "
      "file is a mesh of it; or give a --mission instead of both");
}

void require_the_target(const Effects& effects) {
  if (show_the_target(effects)) return;
  throw ArgumentFault("--effect",
                      "wrong_object and sphere are for tests only: a network cannot learn "
                      "the target's attitude from another body");
}

void add_json_option(Command& command, std::string& json) {
  command.add_option("--json", json, "write the figures to this file")->check(file_path())->type_name("FILE");
}

void add_report_option(Command& command, std::string& report, const std::string& default_text) {
  command
      .add_option("--report", report,
                  "write an HTML page with figures and tables to this file" + default_text)
      ->check(file_path())
      ->type_name("FILE");
}

Eigen::Matrix3d checked_inertia(const std::vector<double>& i) {
  const Eigen::Matrix3d inertia = tensor_of({i[0], i[1], i[2], i[3], i[4], i[5]});
  const std::string fault = fault_of_inertia(inertia);
  if (!fault.empty()) throw std::invalid_argument(fmt::format("--inertia {}: {}", fmt::join(i, ","), fault));
  return inertia;
}

void require_possible_inertia(const Eigen::Matrix3d& inertia_kg_m2, double radius_m) {
  const std::string fault = fault_of_inertia_in_mesh(inertia_kg_m2, radius_m);
  if (!fault.empty()) throw std::invalid_argument(fault);
}

void add_inertia_option(Command& command, std::vector<double>& inertia) {
  command
      .add_option(
          "--inertia", inertia,
          "inertia Ixx,Iyy,Izz,Ixy,Ixz,Iyz of the target in kg m2 about its centre of mass, in the axes of "
          "the target frame, products with their minus sign; for a tumbling target of your own")
      ->delimiter(',')
      ->expected(6)
      ->type_name("N,N,...");
}

void add_target_options(Command& command, ScenarioArguments& arguments) {
  add_target_option(command, arguments.target, TargetChoice::kAny);
  add_mesh_file_options(command, arguments.mesh, arguments.mesh_up, arguments.mesh_scale,
                        "surface of the target: a file (STL, OBJ, PLY, glTF), or parametric for the mesh "
                        "that ships [parametric]");
  add_inertia_option(command, arguments.inertia);
  add_mission_option(command, arguments);
}

void add_mesh_options(Command& command, MeshArguments& arguments) {
  add_mesh_file_options(
      command, arguments.meshes, arguments.mesh_up, arguments.mesh_scale,
      "surface of the target: a file (STL, OBJ, PLY, glTF), or parametric for the mesh that ships; "
      "may be repeated [parametric]");
}

void add_sequence_options(Command& command, ScenarioArguments& arguments, std::uint64_t most_sequences) {
  limit_whole_number(command.add_option("--sequences", arguments.sequences, "sequences to run"), 1,
                     most_sequences)
      ->type_name("N")
      ->capture_default_str();
  limit_whole_number(command.add_option("--frames", arguments.frames, "frames per sequence"), 1, 1000)
      ->type_name("N")
      ->capture_default_str();
  add_seed_option(command, arguments.seed);
}

void add_model_options(Command& command, ScenarioArguments& arguments) {
  CommandOption model =
      command.add_option("--model", arguments.model, "model image [the one that ships for the target]");
  model->check(file_path())->type_name("FILE");
  command
      .add_option("--numerics", arguments.numerics,
                  "which of the shipped models: fixed point, as it flies, or float32")
      ->check(one_of({"fixed", "float32"}))
      ->type_name("fixed|float32")
      ->capture_default_str()
      ->excludes(model);
}

OptionFiles mesh_files_read(const std::string& option, const std::string& mesh) {
  if (mesh.empty() || mesh == kParametricMesh) return {};
  OptionFiles files{{option, mesh}};
  for (const std::string& part : mesh_side_files(mesh))
    files.push_back({option + " (part of its mesh)", part});
  return files;
}

OptionFiles files_read(const MeshArguments& meshes, const SensorArguments& sensor) {
  OptionFiles files{{"--sensor", sensor.file}};
  for (const std::string& mesh : meshes.meshes) {
    for (const OptionFile& file : mesh_files_read("--mesh", mesh)) files.push_back(file);
  }
  return files;
}

std::vector<TriangleMesh> load_meshes(const MeshArguments& arguments, const std::string& target) {
  std::vector<TriangleMesh> meshes;
  for (const std::string& mesh : arguments.meshes) {
    meshes.push_back(target_mesh(target, mesh, mesh_file_options(arguments)));
    const std::string left_out = left_out_note(meshes.back());
    if (!left_out.empty()) print_note(fmt::format("mesh '{}': {}", mesh, left_out));
  }
  return meshes;
}

void require_supported_length(const ScenarioArguments& arguments, const std::string& remedy) {
  const std::uint64_t frames = std::uint64_t{arguments.sequences} * arguments.frames;
  if (frames <= kMaxRunFrames) return;
  throw ArgumentFault("--sequences, --frames",
                      fmt::format("{} x {} are {} frames in all; a run has at most {}{}", arguments.sequences,
                                  arguments.frames, frames, kMaxRunFrames, remedy));
}

}  // namespace tumblesight::sim
