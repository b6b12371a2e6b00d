#include "sim/report/error_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/report/error_columns.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

nlohmann::ordered_json disturbances_json(const Disturbances& disturbances) {
  Json json = Json::object();
  for (const DisturbanceRow* row : given_disturbances(disturbances)) {
    const double value = row->get(disturbances);
    switch (row->kind) {
      case DisturbanceKind::kFlag:
        json[row->name] = value != 0.0;
        break;
      case DisturbanceKind::kWholeNumber:
        json[row->name] = static_cast<std::uint32_t>(value);
        break;
      case DisturbanceKind::kNumber:
        json[row->name] = value;
        break;
    }
  }
  return json;
}

nlohmann::ordered_json effect_json(const Effects& effects) {
  const std::string text = to_string(effects);
  return text.empty() ? Json(nullptr) : Json(text);
}

nlohmann::ordered_json sensor_json(const SensorDescription& sensor) {
  return {{"name", sensor.name}, {"crc32", fmt::format("{:08x}", crc32_of(sensor))}};
}

Json summary_json(const ErrorSummary& summary) {
  const auto figure_or_null = [&](double value) { return summary.count == 0 ? Json(nullptr) : Json(value); };
  Json json = Json::object();
  for (const SummaryFigure& figure : summary_figures())
    json[figure.key] = figure_or_null(summary.*figure.value);
  for (const SummaryFigure& figure : summary_figures()) {
    if (figure.in_degrees && figure.error_key != nullptr)
      json[figure.error_key] = figure_or_null(figure.error(summary));
  }
  return json;
}

nlohmann::ordered_json pose_json(const PoseSummary& pose) {
  if (!(pose.known > 0.0)) return nullptr;
  Json json = Json::object();
  for (const PoseFigure& figure : pose_figures()) {
    const double value = pose.*figure.value;
    json[figure.key] = std::isnan(value) ? Json(nullptr) : Json(value);
  }
  return json;
}

nlohmann::ordered_json estimator_json(const ErrorSummary& summary) {
  const auto figure_or_null = [&](double value) {
    return summary.count == 0 || std::isnan(value) ? Json(nullptr) : Json(value);
  };
  Json json = summary_json(summary);
  json["error_below_3_expected"] = figure_or_null(summary.error_below_3_expected);
  json["expected_over_real"] = figure_or_null(summary.expected_over_real);
  return json;
}

}  // namespace tumblesight::sim
