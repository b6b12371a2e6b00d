#include "sim/cli/simulate_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <filesystem>
#include <utility>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMaxStemLength = 40;   // characters
constexpr std::size_t kMaxNameLength = 200;  // a file system takes 255

std::string plain_stem(const std::string& path) {
  std::string stem = std::filesystem::path(path).stem().string().substr(0, kMaxStemLength);
  for (char& c : stem) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '-';
  }
  return stem;
}

// "lost-frames 1, period 1.5" -> "lost-frames1-period1.5"
std::string plain_words(const std::string& text) {
  std::string words;
  for (const char c : text) {
    if (c != ' ') words += c == ',' ? '-' : c;
  }
  return words;
}

std::uint32_t crc32_of(const std::string& text) {
  return gnc::crc32(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

// "_mesh-near_model-best_1a2b3c4d"
std::string files_part(const SimulateArguments& arguments) {
  const std::pair<const char*, const std::string&> files[] = {
      {"mesh", arguments.scenario.mesh}, {"model", arguments.scenario.model}, {"flight", arguments.flight}};
  std::string part;
  std::string paths;
  for (const auto& [option, path] : files) {
    if (path.empty()) continue;
    part += fmt::format("_{}-{}", option, plain_stem(path));
    paths += full_path(path) + '\n';
  }
  if (part.empty()) return {};
  return fmt::format("{}_{:08x}", part, crc32_of(paths));
}

// The CRC-32 keeps the names of different runs different.
std::string with_limited_length(const std::string& name) {
  if (name.size() <= kMaxNameLength) return name;
  return fmt::format("{}_{:08x}", name.substr(0, kMaxNameLength), crc32_of(name));
}

}  // namespace

std::string default_report_name(const SimulateArguments& arguments) {
  const ScenarioArguments& scenario = arguments.scenario;
  const SimulateArguments usual;
  std::string name = fmt::format("{}_{}_seed{}", scenario.target, scenario.condition, scenario.seed);
  if (scenario.sequences != usual.scenario.sequences || scenario.frames != usual.scenario.frames) {
    name += fmt::format("_{}x{}", scenario.sequences, scenario.frames);
  }
  if (!arguments.only.empty()) name += fmt::format("_only-{}", fmt::join(arguments.only, "-"));
  if (scenario.numerics != usual.scenario.numerics) name += "_" + scenario.numerics;
  name += files_part(arguments);
  if (scenario.mesh_up != usual.scenario.mesh_up) name += "_up-" + scenario.mesh_up;
  if (scenario.mesh_scale != usual.scenario.mesh_scale) name += fmt::format("_scale{}", scenario.mesh_scale);
  if (!scenario.inertia.empty()) name += fmt::format("_inertia{}", fmt::join(scenario.inertia, "-"));
  const std::string disturbances = to_string(scenario.disturbances);
  if (!disturbances.empty()) name += "_" + plain_words(disturbances);
  const std::string effects = to_string(scenario.effects);
  if (!effects.empty()) name += "_" + plain_words(effects);
  if (!scenario.symmetry.is_none())
    name += fmt::format("_symmetry-{:08x}", crc32_of(to_string(scenario.symmetry)));
  const SensorDescription& sensor = scenario.sensor.sensor;
  if (!sensor.is_the_papers()) name += fmt::format("_{}-{:08x}", sensor.name, crc32_of(sensor));
  if (scenario.sensor.ranges) {
    name += fmt::format("_{}-{}m", scenario.sensor.ranges->nearest_m, scenario.sensor.ranges->farthest_m);
  }
  if (arguments.speed != usual.speed) name += "_speed" + arguments.speed;
  if (arguments.free_running) name += "_free-running";
  return with_limited_length(name) + ".html";
}

}  // namespace tumblesight::sim
