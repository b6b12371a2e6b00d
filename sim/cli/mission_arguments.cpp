#include "sim/cli/mission_arguments.hpp"

#include <functional>
#include <stdexcept>

#include "sim/world/scenario/condition.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

bool is_given(const Command& command, const char* option) {
  const CommandOption found = command.get_option_no_throw(option);
  return found && found->count() > 0;
}

void take_sensor_of(const Mission& mission, const Command& command, SensorArguments& sensor) {
  const SensorArguments wanted = sensor_arguments_of(mission);
  if (!is_given(command, "--sensor")) {
    sensor.sensor = wanted.sensor;
    sensor.file = wanted.file;
  }
  if (!is_given(command, "--range") && wanted.ranges) sensor.ranges = wanted.ranges;
  sensor.largest_rate_deg_s = wanted.largest_rate_deg_s;
}

void add_mission(Command& command, const std::function<void(const Mission&)>& take) {
  const auto read = [take](const std::string& text) {
    try {
      const Mission mission = mission_named(text, condition_names());
      use_mission(mission);
      take(mission);
    } catch (const std::invalid_argument& error) {
      throw ArgumentFault("--mission", error.what());
    }
  };
  CommandOption option =
      command.add_option_function<std::string>("--mission", read,
                                               "a TOML file that says all this at once: target, mesh, axes, "
                                               "unit, inertia, sensor, ranges; or the name of "
                                               "a target that ships");
  option->type_name("FILE|NAME");
  for (const char* same : {"--target", "--mesh", "--mesh-up", "--mesh-scale", "--inertia"}) {
    if (CommandOption other = command.get_option_no_throw(same)) option->excludes(other);
  }
}

}  // namespace

SensorArguments sensor_arguments_of(const Mission& mission) {
  SensorArguments sensor;
  sensor.sensor = sensor_named(mission.sensor);
  sensor.file = sensor_path(mission.sensor);
  if (mission.ranges_m)
    sensor.ranges = RangeLimits{mission.ranges_m->nearest_m, mission.ranges_m->farthest_m};
  sensor.largest_rate_deg_s = mission.largest_rate_deg_s;
  return sensor;
}

void add_mission_option(Command& command, ScenarioArguments& arguments) {
  add_mission(command, [command, &arguments](const Mission& mission) {
    arguments.mission = mission;
    arguments.target = mission.name;
    arguments.mesh = mission.mesh.file;
    arguments.mesh_up = mission.mesh.up;
    arguments.mesh_scale = mission.mesh.scale;
    arguments.mesh_origin_trf_m = mesh_file_options(mission.mesh).origin_trf_m;
    take_sensor_of(mission, command, arguments.sensor);
    arguments.symmetry = target_symmetry_from(mission.symmetry);
  });
}

void add_mission_option(Command& command, std::string& target, MeshArguments& meshes, SensorArguments& sensor,
                        std::optional<Mission>& known) {
  add_mission(command, [command, &target, &meshes, &sensor, &known](const Mission& mission) {
    known = mission;
    target = mission.name;
    meshes.meshes = {mission.mesh.file};
    meshes.mesh_up = mission.mesh.up;
    meshes.mesh_scale = mission.mesh.scale;
    meshes.origin_trf_m = mesh_file_options(mission.mesh).origin_trf_m;
    take_sensor_of(mission, command, sensor);
  });
}

}  // namespace tumblesight::sim
