#include "sim/evaluation/pose_goals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kMostWrongInARow = 0.01;
constexpr double kLeastValid = 0.97, kLeastValidInPaper = 0.995;
constexpr double kLeastBelow3Expected = 0.97;
constexpr double kLeastExpectedOverReal = 0.7, kMostExpectedOverReal = 1.5;
constexpr double kLeastNeverValid = 0.995;

struct ConditionGoals {
  const char* target;             // Mission::paper_target
  std::array<PoseGoal, 4> goals;  // nominal, degraded, occluded, tumbling
};
constexpr std::array kGoalConditions{Condition::kNominal, Condition::kDegraded, Condition::kOccluded,
                                     Condition::kTumbling};
constexpr ConditionGoals kGoals[] = {
    {"near_shoemaker", {{{0.10, kAllButOne}, {0.20, kAllButOne}, {0.3, 0.995}, {0.15, kAllButOne}}}},
    {"magellan", {{{0.12, kAllButOne}, {0.20, kAllButOne}, {0.35, 0.998}, {0.15, kAllButOne}}}},
    {"sacd_aquarius", {{{0.25, kAllButOne}, {0.45, kAllButOne}, {0.7, 0.998}, {0.3, kAllButOne}}}},
};

template <auto member, class Value>
Effects only(Value value) {
  Effects effects;
  effects.*member = value;
  return effects;
}

std::vector<SensorRun> make_sensor_runs() {
  constexpr PoseGoal kClutter{0.2, 0.998};
  const RangeLimits papers;
  return {
      {only<&Effects::false_returns>(0.01), papers, kClutter},
      {only<&Effects::hot_pixels>(0.01), papers, kClutter},
      {only<&Effects::background>(0.5), papers, kClutter},
      {only<&Effects::background>(1.0), papers, kClutter},
      {only<&Effects::plume>(0.01), papers, kClutter},
      {only<&Effects::plume>(0.05), papers, PoseGoal{0.5, 0.99}},
      {only<&Effects::debris>(1.5), papers, PoseGoal{0.5, 0.99}},
      {only<&Effects::panel_lobe>(40.0), papers, PoseGoal{0.5, 0.985}},
      {only<&Effects::panel_lobe>(20.0), papers, PoseGoal{1.2, 0.95}},
      {only<&Effects::lobe>(40.0), papers, PoseGoal{1.2, 0.95}},
      {only<&Effects::cosine>(3.0), papers, PoseGoal{0.4, 0.995}},
      {only<&Effects::panel_turn>(10.0), papers, PoseGoal{1.0, 0.998}},
      {only<&Effects::panel_turn>(30.0), papers, PoseGoal{2.0, 0.985}},
      {only<&Effects::noise>(5.0), papers, PoseGoal{0.6, 0.98}},
      {only<&Effects::fixed_fov>(1.0), {20.0, 60.0}, PoseGoal{0.3, 0.995}},
      {only<&Effects::fixed_fov>(1.0), {60.0, 100.0}, PoseGoal{1.5, 0.97}},
      {only<&Effects::rays>(64.0), papers, PoseGoal{0.3, 0.998}},
      {only<&Effects::rays>(32.0), papers, PoseGoal{1.0, 0.985}},
      {only<&Effects::part_missing>(1.0), papers, PoseGoal{0.3, 0.995}},
      {{}, {10.0, 12.0}, PoseGoal{0.5, 0.99}},
      {only<&Effects::wrong_object>(1.0), papers, {}},
      {only<&Effects::sphere>(1.0), papers, {}},
  };
}

bool is_of(const SensorRun& run, const CellResult& cell) {
  return cell.condition == Condition::kNominal && to_string(run.effects) == to_string(cell.effects) &&
         to_string(run.ranges) == to_string(cell.ranges);
}

bool has_pose_goal(const SubjectResult& subject, const CellResult& cell) {
  return pose_goal(subject.target, cell).has_value() && cell.pose.known > 0.0;
}

// Of the last frames of a run.
std::size_t count_of(const CellResult& cell, double share) {
  return static_cast<std::size_t>(std::lround(share * static_cast<double>(cell.rcnn.count)));
}

}  // namespace

const std::vector<SensorRun>& sensor_runs() {
  static const std::vector<SensorRun> runs = make_sensor_runs();
  return runs;
}

bool has_sensor_runs(const std::string& target) {
  return target == "near_shoemaker" || target == "magellan";
}

std::optional<PoseGoal> pose_goal(const std::string& target, const CellResult& cell) {
  if (!cell.sensor.is_the_papers() || !given_disturbances(cell.disturbances).empty()) return {};
  if (!differs_from_paper(cell)) {
    const Mission* mission = find_target(target);
    const auto* at = std::find(kGoalConditions.begin(), kGoalConditions.end(), cell.condition);
    if (mission == nullptr || at == kGoalConditions.end()) return {};
    for (const ConditionGoals& row : kGoals)
      if (row.target == mission->paper_target)
        return row.goals[static_cast<std::size_t>(std::distance(kGoalConditions.begin(), at))];
    return {};
  }
  if (!has_sensor_runs(target)) return {};
  for (const SensorRun& run : sensor_runs())
    if (is_of(run, cell)) return run.goal;
  return {};
}

bool meets(const PoseSummary& pose, const PoseGoal& goal) {
  // Written so that NaN does not meet a limit.
  return pose.known > 0.0 && pose.mean_within_20_deg <= goal.most_mean_within_20_deg &&
         pose.within_20deg >= goal.least_within_20deg;
}

std::string text_of(const PoseGoal& goal) {
  return fmt::format("{:.2f}°, {}", goal.most_mean_within_20_deg, percent_text(goal.least_within_20deg));
}

std::string missed_trust(const CellResult& cell) {
  const ErrorSummary& rcnn = cell.rcnn;
  if (!show_the_target(cell.effects))
    return cell.never_valid_from_fifth >= kLeastNeverValid ? std::string{} : "valid";
  const double least_valid = differs_from_paper(cell) ? kLeastValid : kLeastValidInPaper;
  std::vector<std::string> missed;
  if (!(rcnn.wrong_and_valid <= kMostWrongInARow)) missed.emplace_back("wrong and valid");
  if (!(rcnn.right_and_valid >= least_valid * rcnn.within_20deg)) missed.emplace_back("right and valid");
  if (!(rcnn.error_below_3_expected >= kLeastBelow3Expected)) missed.emplace_back("error below 3 expected");
  if (!(rcnn.expected_over_real >= kLeastExpectedOverReal &&
        rcnn.expected_over_real <= kMostExpectedOverReal))
    missed.emplace_back("expected error");
  return fmt::format("{}", fmt::join(missed, ", "));
}

WrongAndValid wrong_and_valid(const std::vector<SubjectResult>& subjects) {
  WrongAndValid sum;
  for (const SubjectResult& subject : subjects) {
    for (const auto* cells : {&subject.cells, &subject.sensor_runs}) {
      for (const CellResult& cell : *cells) {
        if (!has_pose_goal(subject, cell)) continue;
        sum.wrong += count_of(cell, cell.rcnn.wrong_and_valid);
        sum.frames += cell.rcnn.count;
      }
    }
  }
  return sum;
}

RightAndValid right_and_valid(const std::vector<SubjectResult>& subjects) {
  RightAndValid sum;
  for (const SubjectResult& subject : subjects) {
    for (const CellResult& cell : subject.cells) {
      if (!has_pose_goal(subject, cell)) continue;
      sum.valid += count_of(cell, cell.rcnn.right_and_valid);
      sum.right += count_of(cell, cell.rcnn.within_20deg);
    }
  }
  return sum;
}

}  // namespace tumblesight::sim
