// What guessing gives, and whether the attitudes of a run are any better.
#pragma once

#include <string>

#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/target_symmetry.hpp"

namespace tumblesight::sim {

// Mean error of attitudes drawn uniformly: 90 degrees + 2/pi rad = 126.5 degrees without a symmetry, less
// with one. To 0.2 degrees.
double chance_mean_deg(const TargetSymmetry& symmetry = {});

// More than half of the attitudes are wrong (kWrong_deg). False without any.
bool is_mostly_wrong(const ErrorSummary& errors);

// What a reader must know of such errors, "100 % of the attitudes are more than 20° off, and their mean error
// of 120.1° is what guessing gives: an attitude drawn at random is off by 126.5° on average." Empty if they
// are not mostly wrong.
std::string mostly_wrong_text(const ErrorSummary& errors, const TargetSymmetry& symmetry = {});

}  // namespace tumblesight::sim
