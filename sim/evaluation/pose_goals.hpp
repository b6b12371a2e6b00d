// Pose goals: what the registered pose has to reach, by target and condition, and under the effects of real
// sensors; and what the report has to know of itself in each of these runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

struct PoseGoal {
  double most_mean_within_20_deg = 0.0;
  double least_within_20deg = 0.0;  // share 0..1
};

// "100 %": one of the 900 sequences of a run may be lost.
inline constexpr double kAllButOne = 899.0 / 900.0;

// A run under effects of real sensors, nominal otherwise.
struct SensorRun {
  Effects effects;
  RangeLimits ranges;
  std::optional<PoseGoal> goal;  // none: the frames do not show the target
};
// In the order of tables and files. The panels of the target must be known (panels_for_effect()).
const std::vector<SensorRun>& sensor_runs();
// The targets that `evaluate --paper` runs them for.
bool has_sensor_runs(const std::string& target);

// The goal of the run that `cell` is of; none: there is no goal for it.
std::optional<PoseGoal> pose_goal(const std::string& target, const CellResult& cell);
// False without poses.
bool meets(const PoseSummary& pose, const PoseGoal& goal);
// "0.10°, 99.9 %"
std::string text_of(const PoseGoal& goal);

// What of the trust in a run is missed, "wrong and valid, expected error"; empty: nothing is.
// - More than 20° off and valid: at most 1 % of the last frames.
// - Valid: at least 97 % of the last frames within 20°; 99.5 % under the paper's conditions.
// - Error below three times the expected one: at least 97 %. Mean expected error: 0.7 to 1.5 of the real one.
// - Frames that do not show the target: at least 99.5 % of the sequences not valid from the fifth frame on.
std::string missed_trust(const CellResult& cell);

// Last frames that are more than 20° off and called valid, over all runs in which the frames show the target.
struct WrongAndValid {
  std::size_t wrong = 0;
  std::size_t frames = 0;
  double share() const {
    return frames == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(frames);
  }
};
inline constexpr double kMostWrongAndValid = 0.002;
WrongAndValid wrong_and_valid(const std::vector<SubjectResult>& subjects);

// Last frames that are within 20° and called valid, over the runs under the paper's conditions.
struct RightAndValid {
  std::size_t valid = 0;
  std::size_t right = 0;  // within 20°, valid or not
  double share() const { return right == 0 ? 0.0 : static_cast<double>(valid) / static_cast<double>(right); }
};
inline constexpr double kLeastRightAndValid = 0.99;
RightAndValid right_and_valid(const std::vector<SubjectResult>& subjects);

}  // namespace tumblesight::sim
