// Standard errors of the figures, and the figures as text: every one is quoted with its own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tumblesight::sim {

// s / sqrt(n) with the sample's own standard deviation; 0 of fewer than two values.
double mean_standard_error(const std::vector<double>& values);

// Binomial, of a share 0..1 observed in `count` trials: sqrt(p (1 - p) / n) at p = (k + 1/2) / (n + 1), so
// that 100 % of a few is not quoted as certain. 0 when count is 0.
double share_standard_error(double share, std::size_t count);

std::string degrees_text(double deg);                       // "2.39°"
std::string degrees_text(double deg, double error_deg);     // "2.39 ± 0.03°"
std::string percent_text(double share);                     // "99.8 %"
std::string percent_text(double share, std::size_t count);  // "99.8 ± 0.2 %", of `count` trials

}  // namespace tumblesight::sim
