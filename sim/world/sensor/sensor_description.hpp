// SensorDescription: a LiDAR that a file describes, in place of the paper's. It is the sensor on which the
// conditions and the effects act. The files that ship are in sim/world/sensor/descriptions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/sensor/sensor_settings.hpp"

namespace tumblesight::sim {

// The default is the paper's sensor.
struct SensorDescription {
  std::string name = "paper";  // 1 to 31 characters of a-z, 0-9 and _
  // Where the figures come from.
  std::string source = "DOI 10.1016/j.conengprac.2026.107134, sensor table";
  SensorSettings settings{};  // those of a description: without noise factor, fixed_fov, losses and effects
  double period_s = 2.7;      // between two frames

  bool is_the_papers() const;  // whatever its name
};

// Reads the text of a description, JSON. `file`: named in messages. Every field must be there, and no other.
// Throws std::invalid_argument that names file, field, value and limits if something is wrong.
SensorDescription sensor_from_json(const std::string& text, const std::string& file);
// The text of a description; sensor_from_json() reads it back as the same sensor.
std::string to_json(const SensorDescription& sensor);
// Identifies what the sensor does: CRC-32 of to_json() without name and source.
std::uint32_t crc32_of(const SensorDescription& sensor);
// "flash_256 (CRC-32 1a2b3c4d)", for messages and results.
std::string to_string(const SensorDescription& sensor);

// The names of those that ship.
const std::vector<std::string>& sensor_names();
// The file of a description that ships, by its name; any other text is a file itself.
std::string sensor_path(const std::string& name_or_file);
// A description that ships, by its name, or a file. Throws std::invalid_argument as above, or that lists the
// names if there is no such file.
SensorDescription sensor_named(const std::string& name_or_file);
// Of each description that ships: its name, what it is like and its source; then the fields of a description.
std::string sensor_explanations();

// The range at which a target that needs this swath fills the widest field of view of the sensor [m].
double filling_range_m(const SensorSettings& sensor, double swath_m);

}  // namespace tumblesight::sim
