#include "sim/cli/arguments.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "sim/model/model_file.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

// Frames. A simulated one takes about half a kilobyte until the report is written.
constexpr std::uint64_t kLongestRun = 1'000'000;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

CLI::Validator target_name() {
  const auto check = [](std::string& text) -> std::string {
    const bool plain = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
    if (plain && !text.empty() && text.size() < 32) return {};
    return fmt::format("must be 1 to 31 of a-z, 0-9 and _, not '{}'", text);
  };
  return CLI::Validator(check, "", "target name");
}

CLI::Validator existing_model_image() {
  const auto check = [](std::string& path) -> std::string {
    const std::string refusal = CLI::ExistingFile(path);
    return refusal.empty() ? refusal : refusal + remedy_for_missing_image(path);
  };
  return CLI::Validator(check, "", "model image");
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  const auto check = [names](std::string& text) -> std::string {
    for (const std::string& name : names) {
      if (name == text) return {};
    }
    return fmt::format("must be one of {}, not '{}'", joined(names), text);
  };
  return CLI::Validator(check, "", "choice");
}

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    const bool within = whole && value >= low && value <= high;
    if (within && text == std::to_string(value)) return {};
    return fmt::format("must be a whole number from {} to {}{}, not '{}'", low, high,
                       within ? " without leading zeros" : "", text);
  };
  return CLI::Validator(check, "", "whole number");
}

CLI::Validator number(double low, double high) {
  const auto check = [low, high](std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && value >= low && value <= high) return {};
    return fmt::format("must be a number from {:g} to {:g}, not '{}'", low, high, text);
  };
  return CLI::Validator(check, "", "number");
}

void add_target_options(CLI::App& command, ScenarioArguments& arguments) {
  command
      .add_option("--target", arguments.target,
                  "spacecraft: " + joined(target_names()) + "; with --mesh any name")
      ->check(target_name())
      ->type_name("NAME")
      ->capture_default_str();
  CLI::Option* mesh = command.add_option(
      "--mesh", arguments.mesh, "its surface from a file (STL, OBJ, glTF) instead of the shipped mesh");
  mesh->type_name("FILE");
  command.add_option("--mesh-up", arguments.mesh_up, "the file's axis that is the target frame's z")
      ->check(one_of({"y", "z"}))
      ->type_name("y|z")
      ->capture_default_str()
      ->needs(mesh);
  command.add_option("--mesh-scale", arguments.mesh_scale, "metres to a unit of the file")
      ->check(number(1e-6, 1e6))
      ->type_name("X")
      ->capture_default_str()
      ->needs(mesh);
  command
      .add_option("--inertia", arguments.inertia,
                  "its inertia Ixx,Iyy,Izz,Ixy,Ixz,Iyz in kg m2, to let a target of your own tumble")
      ->delimiter(',')
      ->expected(6)
      ->type_name("N,N,...");
}

std::string condition_help() {
  return joined(condition_names());
}

void add_condition_option(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("--condition", arguments.condition, condition_help())
      ->check(one_of(condition_names()))
      ->type_name("NAME")
      ->capture_default_str();
}

void add_sequence_options(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("--sequences", arguments.sequences, "sequences to run, 1 to 100000")
      ->check(whole_number(1, 100'000))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--frames", arguments.frames, "frames a sequence, 1 to 1000")
      ->check(whole_number(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "same seed, same attitudes, ranges, rates and noise")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("N")
      ->capture_default_str();
}

void add_file_options(CLI::App& command, ScenarioArguments& arguments) {
  CLI::Option* model =
      command.add_option("--model", arguments.model, "model image [the one that ships for the target]");
  model->type_name("FILE");
  command
      .add_option("--numerics", arguments.numerics,
                  "of the model that ships: fixed point, as it flies, or float32")
      ->check(one_of({"fixed", "float32"}))
      ->type_name("fixed|float32")
      ->capture_default_str()
      ->excludes(model);
  command.add_option("--json", arguments.json, "write the figures to this file")->type_name("FILE");
}

void require_bearable_length(const ScenarioArguments& arguments) {
  const std::uint64_t frames = std::uint64_t{arguments.sequences} * arguments.frames;
  if (frames <= kLongestRun) return;
  throw CLI::ValidationError("--sequences, --frames",
                             fmt::format("{} x {} are {} frames in all, at most {} fit a run",
                                         arguments.sequences, arguments.frames, frames, kLongestRun));
}

std::string full_path(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path full = fs::weakly_canonical(absolute, error);
  return (error ? absolute.lexically_normal() : full).string();
}

void require_different(const std::string& option, const std::string& path, const std::string& other_option,
                       const std::string& other_path) {
  if (path.empty() || other_path.empty() || full_path(path) != full_path(other_path)) return;
  throw CLI::ValidationError(option,
                             fmt::format("'{}' is the file of {} as well; give two", path, other_option));
}

void require_writable(const std::string& option, const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& reason) {
    throw std::runtime_error(fmt::format("{} {}: {}", option, path, reason));
  };
  std::error_code error;
  if (fs::is_directory(path, error)) refuse("is a folder; give a file name");
  const fs::path parent = fs::absolute(path).parent_path();
  fs::create_directories(parent, error);
  if (error) refuse("cannot create its folder: " + error.message());
  const std::string& checked = fs::exists(path, error) ? path : parent.string();
  if (access(checked.c_str(), W_OK) != 0) refuse(std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace tumblesight::sim
