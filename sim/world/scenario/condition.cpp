#include "sim/world/scenario/condition.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr int kFewestRays = 16;  // of a frame

template <typename Predicate>
std::vector<Condition> conditions_where(Predicate&& holds) {
  std::vector<Condition> found;
  for (const ConditionRow& row : kConditions) {
    if (holds(row)) found.push_back(row.condition);
  }
  return found;
}

}  // namespace

const ConditionRow& row_of(Condition condition) {
  const auto* row = std::find_if(std::begin(kConditions), std::end(kConditions),
                                 [=](const ConditionRow& r) { return r.condition == condition; });
  if (row == std::end(kConditions)) throw std::logic_error("a condition without a row in kConditions");
  return *row;
}

std::string to_string(Condition condition) {
  return row_of(condition).name;
}

std::vector<std::string> condition_names() {
  std::vector<std::string> names;
  for (const ConditionRow& row : kConditions) names.emplace_back(row.name);
  return names;
}

std::string condition_explanations() {
  constexpr std::size_t kNameWidth = 10;
  std::string text;
  for (const ConditionRow& row : kConditions) {
    std::string name = row.name;
    name.resize(std::max(name.size() + 1, kNameWidth), ' ');
    text += "  " + name + row.explanation + "\n";
  }
  return text;
}

Condition condition_from(const std::string& name) {
  std::string known;
  for (const ConditionRow& row : kConditions) {
    if (name == row.name) return row.condition;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw std::invalid_argument("condition '" + name + "' is unknown; the conditions are: " + known);
}

SensorSettings sensor_settings(Condition condition, const Effects& effects, const SensorSettings& base) {
  const SensorSettings& of_paper = row_of(condition).sensor;
  SensorSettings settings = base;
  const double rays = static_cast<double>(of_paper.rays) / kPaperSensor.rays * base.rays;
  settings.rays = std::max(kFewestRays, static_cast<int>(std::lround(rays)));
  settings.dropout_share = of_paper.dropout_share;
  settings.outlier_share = of_paper.outlier_share;
  Effects all = effects;
  if (all.link_budget == 0.0) all.link_budget = base.photoelectrons;
  return with_effects(settings, all);
}

bool needs_inertia(Condition condition) {
  return row_of(condition).rotation == RotationModel::kTorqueFree;
}

std::vector<Condition> all_training_conditions() {
  std::vector<Condition> all;
  for (std::size_t round = 0; round < TrainingRounds{}.size(); ++round) {
    const auto of_round = conditions_where([=](const ConditionRow& row) { return row.training[round]; });
    all.insert(all.end(), of_round.begin(), of_round.end());
  }
  return all;
}

std::vector<Condition> paper_training_conditions() {
  return conditions_where([](const ConditionRow& row) { return row.trained_in_paper; });
}

std::vector<Condition> calibration_conditions() {
  return conditions_where([](const ConditionRow& row) { return row.calibrates; });
}

std::vector<Condition> evaluated_conditions(const std::string& target) {
  return conditions_where([&](const ConditionRow& row) {
    return row.evaluated_for == kEveryTarget || target == row.evaluated_for;
  });
}

}  // namespace tumblesight::sim
