// Statistics: standard errors of the figures, and figures as text.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tumblesight::sim {

// s / sqrt(n) with the standard deviation of the sample; 0 for fewer than two values.
double mean_standard_error(const std::vector<double>& values);

// Binomial standard error of a share 0..1 observed in `count` trials: sqrt(p (1 - p) / n) at p = (k + 1/2) /
// (n + 1), so that 100 % of a few trials is not reported as certain. 0 if count is 0.
double share_standard_error(double share, std::size_t count);

std::string degrees_text(double deg);                       // "2.39°"
std::string degrees_text(double deg, double error_deg);     // "2.39 ± 0.03°"
std::string percent_text(double share);                     // "99.8 %"
std::string percent_text(double share, std::size_t count);  // "99.8 ± 0.2 %", for `count` trials

}  // namespace tumblesight::sim
