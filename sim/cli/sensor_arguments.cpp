#include "sim/cli/sensor_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "gnc/lidar/depth_image.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/host/write_file.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kNearest_m = gnc::kMinRange_m;
constexpr double kFarthest_m = gnc::kMaxRange_m;

std::optional<double> range_from(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc{} && end == text.data() + text.size();
  if (!number || !(value >= kNearest_m && value <= kFarthest_m)) return std::nullopt;
  return value;
}

RangeLimits ranges_from(const std::vector<std::string>& texts) {
  std::string text;
  for (const std::string& one : texts) text += (text.empty() ? "" : ",") + one;
  const auto nearest = texts.size() == 2 ? range_from(texts[0]) : std::nullopt;
  const auto farthest = texts.size() == 2 ? range_from(texts[1]) : std::nullopt;
  if (nearest && farthest && *nearest <= *farthest) return {*nearest, *farthest};
  throw ArgumentFault("--range",
                      fmt::format("must be NEAREST,FARTHEST, two ascending ranges from {:g} to {:g} "
                                  "m, not '{}'",
                                  kNearest_m, kFarthest_m, text));
}

SensorDescription sensor_from_option(const std::string& text) {
  if (text == "list") {
    fmt::print("Sensors that ship\n\n{}", sensor_explanations());
    throw Exit(0);
  }
  try {
    return sensor_named(text);
  } catch (const std::invalid_argument& error) {
    throw ArgumentFault("--sensor", error.what());
  }
}

}  // namespace

void add_sensor_options(Command& command, SensorArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--sensor",
          [&arguments](const std::string& text) {
            arguments.sensor = sensor_from_option(text);
            arguments.file = sensor_path(text);
          },
          "sensor: the name of one that ships, or a file that describes one; --sensor list explains both "
          "[paper]")
      ->type_name("NAME|FILE");
  command
      .add_option_function<std::vector<std::string>>(
          "--range",
          [&arguments](const std::vector<std::string>& texts) { arguments.ranges = ranges_from(texts); },
          fmt::format("ranges to draw from in metres ({:g} to {:g}) [20,100, from where the target fits into "
                      "the view]",
                      kNearest_m, kFarthest_m))
      ->delimiter(',')
      ->type_name("NEAREST,FARTHEST");
}

void take_period_of_sensor(const Command& command, ScenarioArguments& arguments) {
  Disturbances& disturbances = arguments.disturbances;
  if (command.get_option("--period")->count() == 0) disturbances.period_s = arguments.sensor.sensor.period_s;
  const double of_effect_s = arguments.effects.scan_time;
  const double scan_s = of_effect_s != 0.0 ? of_effect_s : arguments.sensor.sensor.settings.scan_time_s;
  if (scan_s <= disturbances.period_s) return;
  throw ArgumentFault("--period",
                      fmt::format("{:g} s is shorter than a scan of {:g} s ({}); give at least --period {:g}",
                                  disturbances.period_s, scan_s,
                                  of_effect_s != 0.0 ? "--effect scan_time" : "--sensor", scan_s));
}

void require_whole_scans(const std::string& option, const Effects& effects, const SensorDescription& sensor) {
  if (effects.scan_time <= sensor.period_s) return;
  throw ArgumentFault(
      option, fmt::format("scan_time={:g} is longer than the period of sensor {}, {:g} s; give at most "
                          "scan_time={:g}, or a --sensor with a longer period",
                          effects.scan_time, sensor.name, sensor.period_s, sensor.period_s));
}

namespace {

// Those of --range, else the paper's from where the target fits into the view.
RangeLimits wanted_ranges(const SensorArguments& arguments, double swath_m,
                          std::vector<std::string>& warnings) {
  const RangeLimits paper;
  // Up to 0.1 m, as the messages name it.
  const double filling_m = std::ceil(10.0 * filling_range_m(arguments.sensor.settings, swath_m)) / 10.0;
  if (!arguments.ranges && filling_m <= paper.nearest_m) return paper;
  if (!arguments.ranges && filling_m >= paper.farthest_m) {
    throw std::invalid_argument(
        fmt::format("sensor {}: the target fills its view at {:.1f} m, farther than {:g} m; give the ranges, "
                    "for example --range {:.0f},{:g}",
                    arguments.sensor.name, filling_m, paper.farthest_m,
                    std::min(kFarthest_m, std::ceil(filling_m)), kFarthest_m));
  }
  const RangeLimits ranges = arguments.ranges.value_or(RangeLimits{filling_m, paper.farthest_m});
  if (ranges.nearest_m < filling_m) {
    warnings.push_back(
        fmt::format("The target fills the view of sensor {} at {:.1f} m. Nearer than that, "
                    "parts of it are not seen.",
                    arguments.sensor.name, filling_m));
  }
  return ranges;
}

}  // namespace

RangeLimits ranges_of(const SensorArguments& arguments, double swath_m, std::vector<std::string>& warnings) {
  RangeLimits ranges = wanted_ranges(arguments, swath_m, warnings);
  ranges.largest_rate_deg_s = arguments.largest_rate_deg_s;
  const SensorSettings& sensor = arguments.sensor.settings;
  if (ranges.nearest_m >= sensor.nearest_m && ranges.farthest_m <= sensor.farthest_m) return ranges;
  const double nearest_m = std::max(ranges.nearest_m, sensor.nearest_m);
  const double farthest_m = std::min(ranges.farthest_m, sensor.farthest_m);
  throw std::invalid_argument(fmt::format(
      "sensor {}: its range gate is {}, and the ranges to draw from are {}; {}", arguments.sensor.name,
      to_string(RangeLimits{sensor.nearest_m, sensor.farthest_m}), to_string(ranges),
      nearest_m <= farthest_m ? fmt::format("give ranges inside it, for example --range {:g},{:g}",
                                            std::max(kNearest_m, nearest_m), farthest_m)
                              : "give ranges inside it with --range"));
}

ScenarioSettings seen_by(const SensorArguments& arguments, double swath_m,
                         std::vector<std::string>& warnings) {
  ScenarioSettings seen;
  seen.sensor = arguments.sensor.settings;
  seen.ranges = ranges_of(arguments, swath_m, warnings);
  seen.disturbances.period_s = arguments.sensor.period_s;
  return seen;
}

void print_sensor(const SensorDescription& sensor, const RangeLimits& ranges) {
  if (!sensor.is_the_papers()) fmt::print("  sensor: {}\n\n", to_string(sensor));
  if (!ranges.are_the_papers()) fmt::print("  ranges: {}\n\n", to_string(ranges));
}

std::string sensor_file_of(const std::string& model_path) {
  return model_stem(model_path) + ".sensor.json";
}

void write_sensor_file(const std::string& model_path, const SensorDescription& sensor) {
  write_file(sensor_file_of(model_path), to_json(sensor));
}

std::string check_sensor_of_model(const std::string& model_path, const SensorDescription& sensor) {
  const std::string file = sensor_file_of(model_path);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    if (sensor.is_the_papers()) return {};
    return fmt::format(
        "No {} says for which sensor the network was trained. The shipped ones were trained "
        "for the paper's sensor.",
        std::filesystem::path(file).filename().string());
  }
  const SensorDescription trained = sensor_named(file);
  if (crc32_of(trained) == crc32_of(sensor)) return {};
  throw std::invalid_argument(
      fmt::format("the network of '{}' is for sensor {}, and the run is with sensor {}; give --sensor {}, or "
                  "train a network for {} into another folder",
                  model_path, to_string(trained), to_string(sensor), file, sensor.name));
}

}  // namespace tumblesight::sim
