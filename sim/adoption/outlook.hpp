// Outlook: what more training would bring, by the course of the validation error so far.
#pragma once

#include <optional>
#include <vector>

#include "sim/training/training_log.hpp"

namespace tumblesight::sim {

// The mean validation error of the CNN falls roughly as a power of the images seen: error ~ images^-exponent.
struct Outlook {
  double exponent = 0.0;  // 0..1
  // The factor by which the error changes with `times` as much training.
  double error_factor(double times) const;
};

// Least squares on the logarithms of the last three quarters of the points of the CNN's stage. Empty for
// fewer than four points. Assumption: the law goes on; the falling learning rate makes the last points a
// little too good.
std::optional<Outlook> outlook_of(const std::vector<TrainingPoint>& points);

}  // namespace tumblesight::sim
