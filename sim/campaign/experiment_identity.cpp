#include "sim/campaign/experiment_identity.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

std::uint32_t crc32_of(const TriangleMesh& mesh) {
  gnc::Crc32 crc;
  for (const Eigen::Vector3f& vertex : mesh.vertices_trf_m) crc.add_f32(vertex.data(), 3);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) crc.add_u32(index);
  if (!mesh.is_panel.empty()) crc.add(mesh.is_panel.data(), mesh.is_panel.size());
  return crc.value();
}

std::string crc_text(std::uint32_t crc) {
  return fmt::format("{:08x}", crc);
}

std::uint32_t crc_from(const Json& json) {
  return static_cast<std::uint32_t>(std::stoul(json.get<std::string>(), nullptr, 16));
}

Json inertia_json(const std::optional<Eigen::Matrix3d>& inertia_kg_m2) {
  if (!inertia_kg_m2) return nullptr;
  return std::vector<double>(inertia_kg_m2->data(), inertia_kg_m2->data() + 9);
}

std::optional<Eigen::Matrix3d> inertia_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  const auto elements = json.get<std::array<double, 9>>();
  return Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(elements.data()));
}

Json symmetry_json(const TargetSymmetry& symmetry) {
  Json json = Json::array();
  for (const TurnAxis& axis : symmetry.axes())
    json.push_back({axis.axis_trf.x(), axis.axis_trf.y(), axis.axis_trf.z(), axis.fold});
  return json;
}

TargetSymmetry symmetry_from(const Json& json) {
  std::vector<TurnAxis> axes;
  for (const Json& axis : json)
    axes.push_back({{axis.at(0).get<double>(), axis.at(1).get<double>(), axis.at(2).get<double>()},
                    axis.at(3).get<int>()});
  return axes.empty() ? TargetSymmetry() : TargetSymmetry(std::move(axes));
}

// All values, whether they disturb or not.
Json disturbances_json(const Disturbances& disturbances) {
  Json json = Json::object();
  for (const DisturbanceRow& row : kDisturbances) json[row.name] = row.get(disturbances);
  return json;
}

Disturbances disturbances_from(const Json& json) {
  Disturbances disturbances;
  for (const DisturbanceRow& row : kDisturbances) row.set(disturbances, json.at(row.name).get<double>());
  return disturbances;
}

Json effects_json(const Effects& effects) {
  Json json = Json::object();
  for (const EffectRow& row : effect_table())
    if (effects.*row.strength != 0.0) json[row.name] = effects.*row.strength;
  return json;
}

Effects effects_from_json(const Json& json) {
  Effects effects;
  for (const auto& [name, strength] : json.items())
    effects.*effect_named(name).strength = strength.get<double>();
  return effects;
}

Json sensor_json(const SensorDescription& sensor) {
  return Json::parse(to_json(sensor));
}

Json conditions_json(const std::vector<Condition>& conditions) {
  Json json = Json::array();
  for (const Condition condition : conditions) json.push_back(to_string(condition));
  return json;
}

std::vector<Condition> conditions_from(const Json& json) {
  std::vector<Condition> conditions;
  for (const Json& name : json) conditions.push_back(condition_from(name.get<std::string>()));
  return conditions;
}

SubjectDescription subject_from(const Json& json) {
  SubjectDescription subject;
  subject.target = json.at("target").get<std::string>();
  subject.mesh_name = json.at("mesh").get<std::string>();
  subject.swath_m = json.at("swath_m").get<double>();
  subject.model_name = json.at("model").get<std::string>();
  subject.model_crc32 = crc_from(json.at("model_crc32"));
  subject.inertia_kg_m2 = inertia_from(json.at("inertia_kg_m2"));
  subject.sensor = sensor_from_json(json.at("sensor").dump(), "sensor");
  const Json& ranges = json.at("ranges");
  subject.ranges = {ranges.at(0).get<double>(), ranges.at(1).get<double>(), ranges.at(2).get<double>()};
  subject.symmetry = symmetry_from(json.at("symmetry"));
  return subject;
}

// Whoever wrote the header has checked it, so anything else is damage or deceit.
void require_possible(const ExperimentSettings& settings) {
  constexpr std::uint32_t kMostFrames = 1000;
  constexpr std::uint32_t kMostSequences = 10'000'000;
  const bool possible = !settings.conditions.empty() && settings.frames >= 1 &&
                        settings.frames <= kMostFrames && settings.sequences >= 1 &&
                        settings.sequences <= kMostSequences;
  if (!possible) throw std::invalid_argument("conditions, frames or sequences are out of their limits");
}

ExperimentSettings settings_from(const Json& json) {
  ExperimentSettings settings;
  settings.conditions = conditions_from(json.at("conditions"));
  settings.seed = json.at("seed").get<std::uint64_t>();
  settings.sequences = json.at("sequences").get<std::uint32_t>();
  settings.tumbling_sequences = settings.sequences;
  settings.frames = json.at("frames").get<std::uint32_t>();
  settings.disturbances = disturbances_from(json.at("disturbances"));
  settings.effects = effects_from_json(json.at("effects"));
  settings.baseline_sequences = json.at("baseline_sequences").get<std::uint32_t>();
  settings.curves = json.at("curves").get<bool>();
  require_possible(settings);
  return settings;
}

}  // namespace

ExperimentIdentity identity_of(const Subject& subject, const ExperimentSettings& settings,
                               const std::string& version) {
  return {subject, crc32_of(subject.mesh), settings, version};
}

nlohmann::ordered_json to_json(const ExperimentIdentity& identity) {
  const SubjectDescription& subject = identity.subject;
  const ExperimentSettings& settings = identity.settings;
  return {
      {"version", identity.version},
      {"target", subject.target},
      {"mesh", subject.mesh_name},
      {"mesh_crc32", crc_text(identity.mesh_crc32)},
      {"swath_m", subject.swath_m},
      {"model", subject.model_name},
      {"model_crc32", crc_text(subject.model_crc32)},
      {"inertia_kg_m2", inertia_json(subject.inertia_kg_m2)},
      {"sensor", sensor_json(subject.sensor)},
      {"ranges", {subject.ranges.nearest_m, subject.ranges.farthest_m, subject.ranges.largest_rate_deg_s}},
      {"symmetry", symmetry_json(subject.symmetry)},
      {"conditions", conditions_json(settings.conditions)},
      {"seed", settings.seed},
      {"sequences", settings.sequences},
      {"frames", settings.frames},
      {"disturbances", disturbances_json(settings.disturbances)},
      {"effects", effects_json(settings.effects)},
      {"baseline_sequences", settings.baseline_sequences},
      {"curves", settings.curves}};
}

ExperimentIdentity identity_from(const nlohmann::ordered_json& json) {
  return {subject_from(json), crc_from(json.at("mesh_crc32")), settings_from(json),
          json.at("version").get<std::string>()};
}

bool has_same_sequences(const ExperimentIdentity& one, const ExperimentIdentity& other) {
  const auto without_names = [](const ExperimentIdentity& identity) {
    Json json = to_json(identity);
    for (const char* key : {"sequences", "mesh", "model"}) json.erase(key);
    for (const char* key : {"name", "source"}) json["sensor"].erase(key);
    return json;
  };
  return without_names(one) == without_names(other);
}

std::string difference(const ExperimentIdentity& other, const ExperimentIdentity& first) {
  const Json of_other = to_json(other);
  const Json of_first = to_json(first);
  for (const auto& [key, value] : of_first.items()) {
    if (of_other.at(key) == value) continue;
    return fmt::format("{} is {}, not {}", key, of_other.at(key).dump(), value.dump());
  }
  return {};
}

}  // namespace tumblesight::sim
