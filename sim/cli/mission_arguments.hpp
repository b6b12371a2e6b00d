// The option --mission, which stands for those that say the same.
#pragma once

#include <optional>
#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/sensor_arguments.hpp"
#include "sim/mission/mission.hpp"

namespace tumblesight::sim {

// --mission, which excludes the options that say the same; they must have been added before. The target of
// the mission is then known by its name. Sensor and ranges of the mission count unless their options are
// given.
void add_mission_option(Command& command, ScenarioArguments& arguments);
// The same for verbs that make a network.
void add_mission_option(Command& command, std::string& target, MeshArguments& meshes, SensorArguments& sensor,
                        std::optional<Mission>& mission);

// Sensor, ranges and rates of a mission. Throws as sensor_named() does.
SensorArguments sensor_arguments_of(const Mission& mission);

}  // namespace tumblesight::sim
