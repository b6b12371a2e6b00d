#include "sim/evaluation/checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tumblesight::sim {
namespace {

constexpr double kMaxFlatness = 1.5;
constexpr double kMaxOffsetCost_percent = 10.0;

void add_flatness(std::vector<Check>& checks, const std::string& what, const Curve& curve) {
  const double value = flatness(curve);
  if (value > 0.0) checks.push_back({what, value, kMaxFlatness, "×"});
}

// Uses the mean of the second half: the error of a single late frame is as uncertain as that of the 10th, and
// the largest of many is biased upwards.
void add_drift(std::vector<Check>& checks, const Curve& long_run) {
  if (long_run.size() < 2 * kFramesPerSequence) return;
  const double tenth_deg = long_run[kFramesPerSequence - 1].rcnn.mean_deg;
  if (tenth_deg <= 0.0) return;
  const std::size_t middle = long_run.size() / 2;
  double sum_deg = 0.0;
  for (std::size_t i = middle; i < long_run.size(); ++i) sum_deg += long_run[i].rcnn.mean_deg;
  const double late_deg = sum_deg / static_cast<double>(long_run.size() - middle);
  checks.push_back(
      {fmt::format("error in the second half of {} frames over that of the 10th", long_run.size()),
       late_deg / tenth_deg, 1.0, "×"});
}

}  // namespace

std::vector<Check> checks_of(const SubjectResult& subject) {
  std::vector<Check> checks;
  const CellResult* nominal = cell_of(subject, Condition::kNominal);
  const CellResult* offset = cell_of(subject, Condition::kOffset);
  if (nominal != nullptr) {
    add_flatness(checks, "largest over smallest error by range", nominal->by_range);
    add_flatness(checks, "largest over smallest error by rate, components drawn", nominal->by_rate);
  }
  if (subject.sweeps) {
    add_flatness(checks, "largest over smallest error by rate, norm drawn", subject.sweeps->by_rate_norm);
    add_drift(checks, subject.sweeps->long_run);
  }
  if (nominal != nullptr && offset != nullptr && nominal->rcnn.mean_deg > 0.0) {
    checks.push_back({"increase of the error off the boresight",
                      100.0 * (offset->rcnn.mean_deg / nominal->rcnn.mean_deg - 1.0), kMaxOffsetCost_percent,
                      " %"});
  }
  return checks;
}

std::string text_of(const Check& check) {
  return fmt::format("{:.{}f}{}, at most {:g}{}", check.value, check.unit == "×" ? 2 : 1, check.unit,
                     check.limit, check.unit);
}

}  // namespace tumblesight::sim
