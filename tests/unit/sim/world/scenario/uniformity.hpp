// Distance of a sample from a distribution, for tests of random draws.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumblesight::sim {

// Kolmogorov-Smirnov statistic times sqrt(count), from the cumulative probabilities of the values (uniform on
// 0..1 if they have the distribution). It exceeds 1.95 in one of a thousand samples of the right
// distribution.
inline double unlikeliness(std::vector<double> cumulative_probabilities) {
  std::sort(cumulative_probabilities.begin(), cumulative_probabilities.end());
  const auto count = static_cast<double>(cumulative_probabilities.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < cumulative_probabilities.size(); ++i) {
    const auto below = static_cast<double>(i);
    worst = std::max({worst, cumulative_probabilities[i] - below / count,
                      (below + 1.0) / count - cumulative_probabilities[i]});
  }
  return worst * std::sqrt(count);
}

inline constexpr double kUnlikely = 1.95;

}  // namespace tumblesight::sim
