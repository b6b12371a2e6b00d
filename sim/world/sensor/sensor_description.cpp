#include "sim/world/sensor/sensor_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/frame_rays.hpp"
#include "gnc/numerics/crc.hpp"
#include "sim/host/input_file.hpp"
#include "sim/host/nearest_name.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/text.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

// Those of gnc::kMinFov_urad and kMaxFov_urad.
constexpr double kMinFov_deg = 1.0;
constexpr double kMaxFov_deg = 40.0;

constexpr std::size_t kMaxDepth = 4;    // of a description; a good one has 2
constexpr std::size_t kMaxFault = 200;  // characters of a fault that the parser found

constexpr const char* kFields =
    "  name             1 to 31 characters of a-z, 0-9 and _\n"
    "  source           where the figures come from\n"
    "  rays_per_side    16 to 256; frames have at most 128, windowed or binned from these\n"
    "  fov              {\"kind\": \"fitted\"}: the target fills it at every range, 1 to 40 deg;\n"
    "                   {\"kind\": \"fixed\", \"deg\": D}: D from 1 to 40\n"
    "  spacing          \"tangent\": rays in equal steps of the tangent; \"angle\": of the angle\n"
    "  range_gate_m     [nearest, farthest], 0 to 500: no returns from outside\n"
    "  noise            {\"constant_m\": 0 to 10, \"per_range\": 0 to 0.1}: one standard\n"
    "                   deviation of a range is constant_m + per_range * range\n"
    "  footprint_rays   0 to 4: width of the beam in the distance of two rays; 0: a line\n"
    "  detection        {\"kind\": \"every_return\"}, or {\"kind\": \"link_budget\",\n"
    "                   \"photoelectrons_at_100_m\": 0.01 to 1000}: mean signal of a diffuse\n"
    "                   surface that faces the sensor there; less light, fewer detections\n"
    "  scan_time_s      0 to 2: from the first to the last row; 0: all at once; at most the\n"
    "                   period\n"
    "  period_s         0.1 to 60: between two frames, unless --period is given\n"
    "\nNothing says where the sensor is mounted: frames and attitudes are in its own frame,\n"
    "the LRF. docs/icd.md says what a driver makes of the attitude of the chaser's body.\n";

// One object of a description. Takes the fields one by one and refuses what is not as it must be.
class Fields {
 public:
  // `path`: of the object in the file, empty for the whole. `known`: every field that it must have.
  Fields(const Json& object, std::string file, std::string path, const std::vector<std::string>& known)
      : object_(object), file_(std::move(file)), path_(std::move(path)) {
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    const std::string whole = path_.empty() ? "the description" : fmt::format("field '{}'", path_);
    if (!object.is_object()) fail(fmt::format("{} must be an object with {}", whole, names));
    for (const auto& [name, value] : object.items()) {
      if (std::find(known.begin(), known.end(), name) == known.end())
        fail(fmt::format("field '{}' is unknown; {} has {}{}", full(shortened(name)), whole, names,
                         did_you_mean(name, known)));
    }
    for (const std::string& name : known) {
      if (!object.contains(name))
        fail(fmt::format("field '{}' is missing; {} has {}", full(name), whole, names));
    }
  }

  double number(const char* name, double lowest, double highest) const {
    const Json& value = object_.at(name);
    return number_of(value, full(name), lowest, highest);
  }
  int whole_number(const char* name, int lowest, int highest) const {
    const Json& value = object_.at(name);
    const bool fits = value.is_number_integer() && value >= lowest && value <= highest;
    if (!fits) refuse(full(name), value, fmt::format("a whole number from {} to {}", lowest, highest));
    return value.get<int>();
  }
  std::string text(const char* name) const {
    const Json& value = object_.at(name);
    if (!value.is_string() || value.get<std::string>().empty())
      refuse(full(name), value, "a text, not empty");
    return value.get<std::string>();
  }
  std::string choice(const char* name, const std::vector<std::string>& choices) const {
    const Json& value = object_.at(name);
    std::string names;
    for (const std::string& one : choices) {
      if (value == one) return one;
      names += fmt::format("{}\"{}\"", names.empty() ? "" : " or ", one);
    }
    refuse(full(name), value, names);
  }
  // Two numbers, the second above the first.
  std::array<double, 2> interval(const char* name, double lowest, double highest) const {
    const Json& value = object_.at(name);
    const std::string limits = fmt::format("two ascending numbers from {:g} to {:g}", lowest, highest);
    if (!value.is_array() || value.size() != 2) refuse(full(name), value, limits);
    const std::array<double, 2> ends{number_of(value[0], full(name) + "[0]", lowest, highest),
                                     number_of(value[1], full(name) + "[1]", lowest, highest)};
    if (ends[0] >= ends[1]) refuse(full(name), value, limits);
    return ends;
  }
  // The object of a field whose "kind" decides which other fields it has.
  Fields object(const char* name, const std::vector<std::string>& known) const {
    return {object_.at(name), file_, full(name), known};
  }
  bool has_kind(const char* name, const std::string& kind) const {
    const Json& value = object_.at(name);
    return value.is_object() && value.contains("kind") && value.at("kind") == kind;
  }
  [[noreturn]] void refuse(const std::string& field, const Json& value, const std::string& limits) const {
    fail(fmt::format("field '{}' is {}; it must be {}", field, shortened(value.dump()), limits));
  }

 private:
  std::string full(const std::string& name) const { return path_.empty() ? name : path_ + "." + name; }
  double number_of(const Json& value, const std::string& field, double lowest, double highest) const {
    const bool fits = value.is_number() && value >= lowest && value <= highest;
    if (!fits) refuse(field, value, fmt::format("a number from {:g} to {:g}", lowest, highest));
    return value.get<double>();
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(fmt::format("sensor description {}: {}", file_, what));
  }

  const Json& object_;
  std::string file_;
  std::string path_;
};

std::string name_of(const Fields& fields) {
  const std::string name = fields.text("name");
  const bool plain = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!plain || name.size() > 31) fields.refuse("name", name, "1 to 31 characters of a-z, 0-9 and _");
  return name;
}

double fov_deg_of(const Fields& fields) {
  if (fields.has_kind("fov", "fixed"))
    return fields.object("fov", {"kind", "deg"}).number("deg", kMinFov_deg, kMaxFov_deg);
  (void)fields.object("fov", {"kind"}).choice("kind", {"fitted", "fixed"});
  return 0.0;
}

double photoelectrons_of(const Fields& fields) {
  if (fields.has_kind("detection", "link_budget")) {
    return fields.object("detection", {"kind", "photoelectrons_at_100_m"})
        .number("photoelectrons_at_100_m", 0.01, 1000.0);
  }
  (void)fields.object("detection", {"kind"}).choice("kind", {"every_return", "link_budget"});
  return 0.0;
}

SensorSettings settings_of(const Fields& fields) {
  SensorSettings settings;
  settings.rays = fields.whole_number("rays_per_side", 16, gnc::kMaxSensorRays);
  settings.fov_deg = fov_deg_of(fields);
  const bool angle = fields.choice("spacing", {"tangent", "angle"}) == "angle";
  settings.spacing = angle ? RaySpacing::kAngle : RaySpacing::kTangent;
  const auto [nearest_m, farthest_m] = fields.interval("range_gate_m", 0.0, gnc::kMaxRange_m);
  settings.nearest_m = nearest_m;
  settings.farthest_m = farthest_m;
  const Fields noise = fields.object("noise", {"constant_m", "per_range"});
  settings.noise_constant_m = noise.number("constant_m", 0.0, 10.0);
  settings.noise_per_range = noise.number("per_range", 0.0, 0.1);
  settings.footprint_rays = fields.number("footprint_rays", 0.0, 4.0);
  settings.photoelectrons = photoelectrons_of(fields);
  settings.scan_time_s = fields.number("scan_time_s", 0.0, 2.0);
  return settings;
}

// Without name and source.
Json behaviour_json(const SensorDescription& sensor) {
  const SensorSettings& s = sensor.settings;
  Json json;
  json["rays_per_side"] = s.rays;
  json["fov"] = s.fov_deg > 0.0 ? Json{{"kind", "fixed"}, {"deg", s.fov_deg}} : Json{{"kind", "fitted"}};
  json["spacing"] = s.spacing == RaySpacing::kAngle ? "angle" : "tangent";
  json["range_gate_m"] = {s.nearest_m, s.farthest_m};
  json["noise"] = {{"constant_m", s.noise_constant_m}, {"per_range", s.noise_per_range}};
  json["footprint_rays"] = s.footprint_rays;
  json["detection"] = s.photoelectrons > 0.0
                          ? Json{{"kind", "link_budget"}, {"photoelectrons_at_100_m", s.photoelectrons}}
                          : Json{{"kind", "every_return"}};
  json["scan_time_s"] = s.scan_time_s;
  json["period_s"] = sensor.period_s;
  return json;
}

std::string path_of_shipped(const std::string& name) {
  return program_files().sensors + "/" + name + ".json";
}

SensorDescription read_sensor(const std::string& path) {
  constexpr InputKind kDescription{"sensor description", 1'000'000};
  try {
    return sensor_from_json(read_text(path, kDescription), path);
  } catch (const InputRefused& refusal) {
    throw std::invalid_argument(refusal.what());
  }
}

std::string summary_of(const SensorDescription& sensor) {
  const SensorSettings& s = sensor.settings;
  const std::string fov = s.fov_deg > 0.0 ? fmt::format("{:g} deg", s.fov_deg) : "the fitted field of view";
  return fmt::format("{0} x {0} rays over {1}{2}, noise {3:g} m + {4:g} %, {5}, every {6:g} s", s.rays, fov,
                     s.spacing == RaySpacing::kAngle ? ", uniform in angle" : "", s.noise_constant_m,
                     100.0 * s.noise_per_range,
                     s.scan_time_s > 0.0 ? fmt::format("scanned in {:g} s", s.scan_time_s) : "one flash",
                     sensor.period_s);
}

}  // namespace

bool SensorDescription::is_the_papers() const {
  return crc32_of(*this) == crc32_of(SensorDescription{});
}

SensorDescription sensor_from_json(const std::string& text, const std::string& file) {
  const auto refuse = [&file](const std::string& what) {
    throw std::invalid_argument(fmt::format("sensor description {}: {}", file, what));
  };
  // Names of the fields so far, of the object at each depth.
  std::array<std::set<std::string>, kMaxDepth + 1> names;
  const auto check = [&](int depth, Json::parse_event_t event, Json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    using Event = Json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (level >= kMaxDepth) refuse(fmt::format("objects or lists are nested more than {} deep", kMaxDepth));
      names[level + 1].clear();
    }
    if (event == Event::key && !names[level].insert(parsed.get<std::string>()).second)
      refuse(fmt::format("field {} is given twice", shortened(parsed.dump())));
    return true;
  };
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) refuse("the file is empty");
  Json json;
  try {
    json = Json::parse(text, check);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    refuse(fmt::format("not JSON in line {}; correct it, or give the file of a sensor",
                       1 + std::count(text.begin(), end, '\n')));
  } catch (const Json::out_of_range& error) {
    refuse("a number is too large: " + shortened(error.what(), kMaxFault));
  } catch (const Json::exception& error) {
    refuse("not JSON: " + shortened(error.what(), kMaxFault));
  }
  const Fields fields(json, file, "",
                      {"name", "source", "rays_per_side", "fov", "spacing", "range_gate_m", "noise",
                       "footprint_rays", "detection", "scan_time_s", "period_s"});
  const double period_s = fields.number("period_s", 0.1, 60.0);
  const SensorDescription sensor{name_of(fields), fields.text("source"), settings_of(fields), period_s};
  if (sensor.settings.scan_time_s > period_s)
    fields.refuse("scan_time_s", json.at("scan_time_s"), fmt::format("at most period_s, {:g}", period_s));
  return sensor;
}

std::string to_json(const SensorDescription& sensor) {
  Json json{{"name", sensor.name}, {"source", sensor.source}};
  json.update(behaviour_json(sensor));
  return json.dump(2) + "\n";
}

std::uint32_t crc32_of(const SensorDescription& sensor) {
  const std::string text = behaviour_json(sensor).dump();
  return gnc::crc32(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::string to_string(const SensorDescription& sensor) {
  return fmt::format("{} (CRC-32 {:08x})", sensor.name, crc32_of(sensor));
}

const std::vector<std::string>& sensor_names() {
  static const std::vector<std::string> kShipped{"paper", "flash_256", "scan_128"};
  return kShipped;
}

std::string sensor_path(const std::string& name_or_file) {
  const std::vector<std::string>& shipped = sensor_names();
  const bool ships = std::find(shipped.begin(), shipped.end(), name_or_file) != shipped.end();
  return ships ? path_of_shipped(name_or_file) : name_or_file;
}

SensorDescription sensor_named(const std::string& name_or_file) {
  const std::string path = sensor_path(name_or_file);
  std::error_code error;
  if (std::filesystem::exists(path, error)) return read_sensor(path);
  throw std::invalid_argument(fmt::format("'{}' is neither a file nor a sensor that ships; those are: {}{}",
                                          name_or_file, fmt::join(sensor_names(), ", "),
                                          did_you_mean(name_or_file, sensor_names())));
}

std::string sensor_explanations() {
  std::string text;
  for (const std::string& name : sensor_names()) {
    const SensorDescription sensor = sensor_named(name);
    text += fmt::format("  {:<16} {}\n  {:<16} source: {}\n  {:<16} {}\n", name, summary_of(sensor), "",
                        sensor.source, "", path_of_shipped(name));
  }
  return text + "\nThe fields of a description, all of them required\n\n" + kFields;
}

double filling_range_m(const SensorSettings& sensor, double swath_m) {
  const double fov_deg = sensor.fov_deg > 0.0 ? sensor.fov_deg : kMaxFov_deg;
  return 0.5 * swath_m / std::tan(0.5 * kRadPerDeg * fov_deg);
}

}  // namespace tumblesight::sim
