#include "sim/adoption/goal_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

namespace tumblesight::sim {
namespace {

std::string degrees(double value) {
  return fmt::format("{:.2f}°", value);
}
std::string share(double value) {
  return fmt::format("{:.1f} %", 100.0 * value);
}

struct GoalRow {
  std::optional<double> MissionGoal::*limit;
  const char* figure;
  bool at_most;
  std::string (*text)(double);
  double (*value)(const CellResult&);
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const GoalRow kGoals[] = {
    {&MissionGoal::network_mean_deg, "network alone, mean error", true, degrees,
     [](const CellResult& cell) { return cell.rcnn.count > 0 ? cell.rcnn.mean_deg : kNone; }},
    {&MissionGoal::pose_mean_deg, "registered pose, mean error of those within 20°", true, degrees,
     [](const CellResult& cell) { return cell.pose.known > 0.0 ? cell.pose.mean_within_20_deg : kNone; }},
    {&MissionGoal::pose_within_20deg, "registered pose, share within 20°", false, share,
     [](const CellResult& cell) { return cell.pose.known > 0.0 ? cell.pose.within_20deg : kNone; }},
    {&MissionGoal::verified, "registered pose, share verified", false, share,
     [](const CellResult& cell) { return cell.pose.known > 0.0 ? cell.pose.verified : kNone; }},
    {&MissionGoal::verified_wrong, "registered pose, share verified and more than 5° off", true, share,
     [](const CellResult& cell) { return cell.pose.known > 0.0 ? cell.pose.verified_wrong : kNone; }},
};

GoalCheck checked(const GoalRow& row, double limit, const CellResult& cell) {
  const double value = row.value(cell);
  GoalCheck check;
  check.condition = cell.condition;
  check.figure = row.figure;
  check.limit = fmt::format("{} {}", row.at_most ? "at most" : "at least", row.text(limit));
  check.value = std::isnan(value) ? "-" : row.text(value);
  check.met = row.at_most ? value <= limit : value >= limit;
  return check;
}

}  // namespace

std::vector<GoalCheck> goal_checks(const Mission& mission, const SubjectResult& result) {
  std::vector<GoalCheck> checks;
  for (const CellResult& cell : result.cells) {
    const auto goal = mission.goals.find(to_string(cell.condition));
    if (goal == mission.goals.end()) continue;
    for (const GoalRow& row : kGoals) {
      if (const std::optional<double>& limit = goal->second.*row.limit)
        checks.push_back(checked(row, *limit, cell));
    }
  }
  return checks;
}

std::string to_string(const GoalCheck& check) {
  return fmt::format("{}: {}: {}, and {} is asked", to_string(check.condition), check.figure, check.value,
                     check.limit);
}

std::vector<std::string> failing_conditions(const SubjectResult& result) {
  std::vector<std::string> reasons;
  for (const CellResult& cell : result.cells) {
    if (cell.rcnn.count == 0 || cell.rcnn.within_20deg >= 0.5) continue;
    reasons.push_back(fmt::format("{}: {} of the network's attitudes are more than 20° off",
                                  to_string(cell.condition), share(1.0 - cell.rcnn.within_20deg)));
  }
  return reasons;
}

}  // namespace tumblesight::sim
