// The options that choose the sensor and the ranges of a run, and the sensor for which a network was trained.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/cli/command.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/sensor_description.hpp"

namespace tumblesight::sim {

struct ScenarioArguments;

struct SensorArguments {
  SensorDescription sensor;
  std::optional<RangeLimits> ranges{};  // those of --range or of --mission
  double largest_rate_deg_s = RangeLimits{}.largest_rate_deg_s;
  std::string file{};  // that describes the sensor; empty: none was given
};

// --sensor and --range. `--sensor list` prints the descriptions that ship and ends the program. `arguments`
// must outlive the parsing.
void add_sensor_options(Command& command, SensorArguments& arguments);
// Frames come with the period of the sensor unless --period was given. Throws ArgumentFault if a scan
// takes longer than that.
void take_period_of_sensor(const Command& command, ScenarioArguments& arguments);

// For verbs that make a network, whose frames come with the period of the sensor. Throws ArgumentFault
// that names `option` if a scan of the effects takes longer.
void require_whole_scans(const std::string& option, const Effects& effects, const SensorDescription& sensor);

// The ranges to draw for a target that needs this swath: those of --range, else the paper's from where the
// target fits into the view. Adds a warning if it does not fit at the nearest range. Throws
// std::invalid_argument that names a range if it does not fit at any of the paper's, or if the sensor's range
// gate excludes some of the ranges.
RangeLimits ranges_of(const SensorArguments& arguments, double swath_m, std::vector<std::string>& warnings);

// A scenario with the sensor, its period, and ranges_of().
ScenarioSettings seen_by(const SensorArguments& arguments, double swath_m,
                         std::vector<std::string>& warnings);

// A line each for a sensor and for ranges other than the paper's.
void print_sensor(const SensorDescription& sensor, const RangeLimits& ranges);

// The file beside a model image that describes the sensor for which its network was trained:
// "near.sensor.json" for near.tsm and near.float32.tsm.
std::string sensor_file_of(const std::string& model_path);
// Writes it. Throws std::runtime_error if that fails.
void write_sensor_file(const std::string& model_path, const SensorDescription& sensor);
// Throws std::invalid_argument that names both sensors and what to do if the file is there and describes
// another sensor, or as sensor_from_json() does. Without the file, returns a warning for a sensor other than
// the paper's, and nothing for the paper's.
std::string check_sensor_of_model(const std::string& model_path, const SensorDescription& sensor);

}  // namespace tumblesight::sim
