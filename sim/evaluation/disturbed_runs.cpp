#include "sim/evaluation/disturbed_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

DisturbedBar accuracy(double times_the_mean, double fewer_within_20deg) {
  DisturbedBar bar;
  bar.most_times_the_mean = times_the_mean;
  bar.most_fewer_within_20deg = fewer_within_20deg;
  return bar;
}

// `recovered`: the sensor has been well for two frames.
DisturbedBar trust(bool recovered) {
  DisturbedBar bar;
  bar.not_more_wrong_and_valid = true;
  if (recovered) bar.least_right_and_valid = 0.97;
  return bar;
}

template <auto member, class Value>
Disturbances with(Value value, Disturbances others = {}) {
  others.*member = value;
  return others;
}

Disturbances recovered(Disturbances disturbances) {
  disturbances.well_frames = 2;
  return disturbances;
}

void add_gaps(std::vector<DisturbedRun>& runs) {
  const auto lost = [](std::uint32_t frames) { return with<&Disturbances::lost_frames>(frames); };
  const Disturbances every_second = with<&Disturbances::loss_every>(2U);
  runs.push_back({Condition::kNominal, lost(1), accuracy(1.15, 0.002)});
  runs.push_back({Condition::kOccluded, lost(1), accuracy(1.44, 0.011)});
  runs.push_back({Condition::kTumbling, lost(1), {}});
  runs.push_back({Condition::kNominal, lost(2), {}});
  runs.push_back({Condition::kOccluded, lost(2), {}});
  runs.push_back({Condition::kNominal, lost(6), {}});
  runs.push_back({Condition::kNominal, every_second, {}});
  runs.push_back({Condition::kNominal, recovered(every_second), trust(true)});
}

void add_freezes(std::vector<DisturbedRun>& runs) {
  for (std::uint32_t frames = 1; frames <= 3; ++frames) {
    const Disturbances frozen = with<&Disturbances::frozen>(frames);
    runs.push_back({Condition::kNominal, frozen, trust(false)});
    runs.push_back({Condition::kNominal, recovered(frozen), trust(true)});
  }
  const Disturbances with_gaps = with<&Disturbances::frozen>(5U, with<&Disturbances::loss_every>(2U));
  runs.push_back({Condition::kNominal, with_gaps, {}});
  runs.push_back({Condition::kNominal, recovered(with_gaps), {}});
}

void add_clocks(std::vector<DisturbedRun>& runs) {
  runs.push_back({Condition::kNominal, with<&Disturbances::period_s>(0.2), {}});
  DisturbedBar mean_only;
  mean_only.most_times_the_mean = 1.15;
  for (const double period_s : {1.0, 5.4}) {
    runs.push_back({Condition::kNominal, with<&Disturbances::period_s>(period_s), mean_only});
  }
  runs.push_back({Condition::kNominal, with<&Disturbances::period_jitter>(0.2), {}});
}

void add_chaser(std::vector<DisturbedRun>& runs) {
  const Disturbances turning = with<&Disturbances::chaser_rate_deg_s>(5.0);
  runs.push_back({Condition::kNominal, turning, accuracy(1.1, 0.002)});
  runs.push_back({Condition::kTumbling, turning, accuracy(1.1, 0.002)});
  runs.push_back({Condition::kNominal, with<&Disturbances::no_ego_motion>(true, turning), {}});
}

std::vector<DisturbedRun> make_disturbed_runs() {
  std::vector<DisturbedRun> runs;
  add_gaps(runs);
  add_freezes(runs);
  add_clocks(runs);
  add_chaser(runs);
  return runs;
}

}  // namespace

const std::vector<DisturbedRun>& disturbed_runs() {
  static const std::vector<DisturbedRun> runs = make_disturbed_runs();
  return runs;
}

const DisturbedRun* disturbed_run_of(const CellResult& cell) {
  for (const DisturbedRun& run : disturbed_runs()) {
    if (run.condition == cell.condition && to_string(run.disturbances) == to_string(cell.disturbances)) {
      return &run;
    }
  }
  return nullptr;
}

bool meets(const DisturbedBar& bar, const CellResult& cell, const CellResult* undisturbed) {
  const ErrorSummary& rcnn = cell.rcnn;
  if (rcnn.count == 0) return false;
  if (bar.least_right_and_valid && !(rcnn.right_and_valid >= *bar.least_right_and_valid)) return false;
  if (!bar.most_times_the_mean && !bar.most_fewer_within_20deg && !bar.not_more_wrong_and_valid) return true;
  if (undisturbed == nullptr) return false;
  const ErrorSummary& before = undisturbed->rcnn;
  // Written so that NaN does not meet a limit.
  if (bar.most_times_the_mean &&
      !(rcnn.mean_within_20_deg <= *bar.most_times_the_mean * before.mean_within_20_deg))
    return false;
  if (bar.most_fewer_within_20deg &&
      !(rcnn.within_20deg >= before.within_20deg - *bar.most_fewer_within_20deg))
    return false;
  return !bar.not_more_wrong_and_valid || rcnn.wrong_and_valid <= before.wrong_and_valid;
}

std::string text_of(const DisturbedBar& bar) {
  std::vector<std::string> parts;
  if (bar.most_times_the_mean) parts.push_back(fmt::format("{} times the mean", *bar.most_times_the_mean));
  if (bar.most_fewer_within_20deg)
    parts.push_back(percent_text(*bar.most_fewer_within_20deg) + " fewer within 20°");
  if (bar.not_more_wrong_and_valid) parts.emplace_back("not more wrong and valid");
  if (bar.least_right_and_valid)
    parts.push_back(percent_text(*bar.least_right_and_valid) + " right and valid");
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace tumblesight::sim
