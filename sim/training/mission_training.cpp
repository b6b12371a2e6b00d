#include "sim/training/mission_training.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {

std::vector<Condition> training_conditions(const Mission& mission) {
  if (mission.conditions.empty()) return all_training_conditions();
  int divisor = 0, total = 0;
  for (const auto& [name, weight] : mission.conditions) {
    if (row_of(condition_from(name)).training == kNotTrained)
      throw std::invalid_argument(mission.file + ": conditions." + name +
                                  ": this condition is for tests only; leave it out of [conditions]");
    divisor = std::gcd(divisor, weight);
  }
  for (const auto& [name, weight] : mission.conditions) total += weight / divisor;
  // At every place the condition that is furthest behind its share.
  std::vector<Condition> conditions;
  std::map<std::string, int> given;
  for (int place = 1; place <= total; ++place) {
    const auto behind = [&](const auto& entry) {
      return static_cast<double>(entry.second / divisor) * place / total - given[entry.first];
    };
    const auto next = std::max_element(mission.conditions.begin(), mission.conditions.end(),
                                       [&](const auto& a, const auto& b) { return behind(a) < behind(b); });
    ++given[next->first];
    conditions.push_back(condition_from(next->first));
  }
  return conditions;
}

bool panels_turn(const Mission& mission) {
  return mission.panels && mission.panels->lowest_deg < mission.panels->highest_deg;
}

std::vector<EffectRanges> training_effect_sets(const Mission& mission) {
  std::vector<EffectRanges> sets{{}};
  if (!panels_turn(mission)) return sets;
  Effects joints;
  joints.joints = 1.0;
  sets.emplace_back(joints);
  return sets;
}

}  // namespace tumblesight::sim
