// The options that several subcommands share, defined once so that they mean the same everywhere, and the
// checks of their values: what is refused is refused with the limits that hold.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

// What is observed, and by which network.
struct ScenarioArguments {
  std::string target = "near_shoemaker";
  std::string mesh;  // empty: the mesh that ships for the target
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
  std::vector<double> inertia;  // Ixx, Iyy, Izz, Ixy, Ixz, Iyz [kg m2]; empty: the shipped target's own
  std::string condition = "nominal";
  std::uint32_t sequences = 30;
  std::uint32_t frames = 10;
  std::uint64_t seed = 1;
  std::string numerics = "fixed";  // or "float32": of the model that ships
  std::string model;  // empty: fsw/models/<target>.tsm or <target>.float32.tsm of the source tree
  std::string json;   // empty: none
};

// Defaults are what `arguments` holds when called.
void add_target_options(CLI::App& command, ScenarioArguments& arguments);    // --target, --mesh…, --inertia
void add_condition_option(CLI::App& command, ScenarioArguments& arguments);  // --condition, a single one
void add_sequence_options(CLI::App& command, ScenarioArguments& arguments);  // --sequences, --frames, --seed
void add_file_options(CLI::App& command, ScenarioArguments& arguments);      // --model, --numerics, --json

// What --condition says of itself, wherever it stands.
std::string condition_help();

// Throws CLI::ValidationError if sequences times frames is more than a run can hold in memory.
void require_bearable_length(const ScenarioArguments& arguments);

// Validators whose message names the limits, for instance "must be a whole number from 1 to 100000, not
// 'many'". Leading zeros are refused: CLI11 would read an octal number.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);
CLI::Validator number(double low, double high);
// An existing file. The message about a missing image of fsw/models names the command that gets it.
CLI::Validator existing_model_image();
CLI::Validator one_of(const std::vector<std::string>& names);
// It becomes part of a file name and of the model image: 1 to 31 of a-z, 0-9 and _.
CLI::Validator target_name();

// Absolute, with links, "." and ".." resolved as far as the path exists.
std::string full_path(const std::string& path);

// Throws CLI::ValidationError if both options name the same file, in whatever spelling.
void require_different(const std::string& option, const std::string& path, const std::string& other_option,
                       const std::string& other_path);

// Throws std::runtime_error that names option, file and reason if `path` could not be written. Leaves no file
// behind.
void require_writable(const std::string& option, const std::string& path);

}  // namespace tumblesight::sim
