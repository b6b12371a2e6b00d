// The options that several verbs share, each defined once so that it means the same everywhere, and the
// checks of their values. A refused value is reported with its limits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/cli/command.hpp"
#include "sim/cli/option_files.hpp"
#include "sim/cli/sensor_arguments.hpp"
#include "sim/evaluation/target_symmetry.hpp"
#include "sim/mission/mission.hpp"
#include "sim/world/scenario/disturbance.hpp"
#include "sim/world/sensor/effects.hpp"
#include "sim/world/target/targets.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The observed target and motion, and the network.
struct ScenarioArguments {
  std::string target = default_target();
  std::string mesh;  // a file, or "parametric"; empty: the same
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
  Eigen::Vector3d mesh_origin_trf_m = Eigen::Vector3d::Zero();  // of --mission
  std::vector<double> inertia;  // Ixx, Iyy, Izz, Ixy, Ixz, Iyz [kg m2]; empty: the shipped target's
  std::string condition = "nominal";
  std::uint32_t sequences = 30;
  std::uint32_t frames = 10;  // per sequence
  std::uint64_t seed = 1;
  Disturbances disturbances;
  Effects effects;
  TargetSymmetry symmetry;
  SensorArguments sensor;
  std::string numerics = "fixed";  // or "float32": which of the shipped models
  std::string model;               // empty: the shipped <target>.tsm or <target>.float32.tsm
  std::string json;                // empty: none
  std::optional<Mission> mission;  // of --mission
};

// The surfaces that a network is made for.
struct MeshArguments {
  std::vector<std::string> meshes{"parametric"};  // files, or "parametric" for the mesh that ships
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
  Eigen::Vector3d origin_trf_m = Eigen::Vector3d::Zero();  // of --mission
};

enum class TargetChoice {
  kShipped,    // only targets that ship
  kAny,        // with --mesh, targets of the user's own as well
  kWithModel,  // with --model, targets of the user's own as well
};

// One option each. The default shown in the help is the value of the variable at the time of the call.
void add_target_option(Command& command, std::string& target, TargetChoice choice);
void add_condition_option(Command& command, std::string& condition);  // --condition, one
void add_condition_option(Command& command,
                          std::vector<std::string>& conditions);  // --condition, one or more
void add_seed_option(Command& command, std::uint64_t& seed);
void add_float32_model_option(Command& command, std::string& model);  // --model, required
// --effect; `--effect list` prints the effects and ends the program. `effects` must outlive the parsing.
void add_effect_option(Command& command, Effects& effects);
// --effect-set, in place of --effect.
void add_effect_set_option(Command& command, std::vector<EffectRanges>& effect_sets);
// Throws ArgumentFault if --mesh names a file and --target is not given: the default would give a
// spacecraft of the user's own the name, the inertia and the published figures of another. `meshes`: of
// --mesh.
void require_a_name(const Command& command, const std::vector<std::string>& meshes);
// For verbs that make a network. Throws ArgumentFault if the effects put another body in the target's
// place: the network would learn that body under the target's name.
void require_the_target(const Effects& effects);
void add_json_option(Command& command, std::string& json);
void add_report_option(Command& command, std::string& report, const std::string& default_text);

// Groups of options.
void add_target_options(Command& command, ScenarioArguments& arguments);  // --target, --mesh…, --inertia
void add_mesh_options(Command& command,
                      MeshArguments& arguments);          // --mesh (repeated), --mesh-up, --mesh-scale
inline constexpr std::uint64_t kMostSequences = 100'000;  // of a run that keeps them in memory
// --sequences, --frames, --seed
void add_sequence_options(Command& command, ScenarioArguments& arguments,
                          std::uint64_t most_sequences = kMostSequences);
void add_model_options(Command& command, ScenarioArguments& arguments);  // --model, --numerics

// The tensor of --inertia's six elements. Throws std::invalid_argument that names the limits if no rigid body
// has it.
Eigen::Matrix3d checked_inertia(const std::vector<double>& elements);
// Throws std::invalid_argument if no body within this radius can have it.
void require_possible_inertia(const Eigen::Matrix3d& inertia_kg_m2, double radius_m);
void add_inertia_option(Command& command, std::vector<double>& inertia);

// A mesh file and the files that belong to it; none for the mesh that ships.
OptionFiles mesh_files_read(const std::string& option, const std::string& mesh);
// The mesh files and the description of the sensor.
OptionFiles files_read(const MeshArguments& meshes, const SensorArguments& sensor);

// Notes on the standard error stream what is left out of a file. Throws as target_mesh does.
std::vector<TriangleMesh> load_meshes(const MeshArguments& arguments, const std::string& target);

// Throws ArgumentFault if sequences times frames is more than a run can hold in memory. `remedy`: what
// to do then, "; divide it".
void require_supported_length(const ScenarioArguments& arguments, const std::string& remedy = {});

// Validators whose message names the limits, for example "must be a whole number from 1 to 100000, not
// 'many'". Leading zeros are refused, because CLI11 would read an octal number.
ValueCheck whole_number(std::uint64_t low, std::uint64_t high);
ValueCheck number(double low, double high);
// The same for an option, whose help then ends with the limits.
CommandOption limit_whole_number(CommandOption option, std::uint64_t low, std::uint64_t high);
CommandOption limit_number(CommandOption option, double low, double high);
// An existing file. The message about a missing image of fsw/models names the command that gets it.
ValueCheck existing_model_image();
ValueCheck file_path();      // not empty
ValueCheck existing_file();  // a regular one: a pipe gives its content once, and both programs read the file
ValueCheck one_of(const std::vector<std::string>& names);
// 1 to 31 characters of a-z, 0-9 and _: the name becomes part of a file name and of the model image.
ValueCheck target_name();

}  // namespace tumblesight::sim
