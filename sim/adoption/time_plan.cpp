#include "sim/adoption/time_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr double kCalibration_s = 0.16;  // of a sequence for the scales, on a slow core
constexpr double kSurface_s = 2.0;
constexpr double kFlying_s = 5.0;
constexpr double kSecondsPerCalibration = 15.0;  // one sequence more
constexpr double kFewestCalibrations = 20.0, kMostCalibrations = 200.0;
constexpr double kShareForEvaluation = 0.08;
constexpr double kShareOfRecurrentPart = 0.15;  // of the training; as `train --minutes`
constexpr double kMargin = 1.15;
constexpr std::uint32_t kFewest = 20, kMost = 900;

}  // namespace

TimePlan time_plan(double seconds, std::uint32_t rows, double sequence_s, std::uint32_t sequences) {
  TimePlan plan;
  const double affordable = kShareForEvaluation * seconds / (std::max(1U, rows) * std::max(1e-4, sequence_s));
  plan.sequences = sequences > 0
                       ? sequences
                       : static_cast<std::uint32_t>(std::clamp(affordable, double{kFewest}, double{kMost}));
  plan.calibration_sequences =
      static_cast<int>(std::clamp(seconds / kSecondsPerCalibration, kFewestCalibrations, kMostCalibrations));
  plan.after_s = kMargin * (kSurface_s + kCalibration_s * plan.calibration_sequences + kFlying_s +
                            rows * plan.sequences * sequence_s);
  const double training_s = seconds - plan.after_s;
  if (training_s < 0.5 * seconds)
    throw std::invalid_argument(
        fmt::format("there are {:.0f} s left, and {:.0f} s of them are needed after the training; give at "
                    "least --minutes "
                    "{:.0f}, or fewer --sequences",
                    seconds, plan.after_s, std::ceil(2.0 * plan.after_s / 60.0) + 1.0));
  plan.rcnn_s = kShareOfRecurrentPart * training_s;
  plan.cnn_s = training_s - plan.rcnn_s;
  return plan;
}

}  // namespace tumblesight::sim
