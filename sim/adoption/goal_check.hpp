// The figures of an evaluation against the goals of a mission.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/mission/mission.hpp"

namespace tumblesight::sim {

// One goal of one condition.
struct GoalCheck {
  Condition condition = Condition::kNominal;
  std::string figure;  // in words: "network, mean error"
  std::string limit;   // "at most 2.00°"
  std::string value;   // "1.52°", or "-" where the figure does not exist
  bool met = false;
};

// Of the conditions that were run, in their order. A figure that does not exist does not meet its goal.
std::vector<GoalCheck> goal_checks(const Mission& mission, const SubjectResult& result);

// "occluded: network, mean error is 7.20°, at most 6.00° is asked".
std::string to_string(const GoalCheck& check);

// Conditions in which more than half of the attitudes of the network are wrong, whatever the goals.
std::vector<std::string> failing_conditions(const SubjectResult& result);

}  // namespace tumblesight::sim
