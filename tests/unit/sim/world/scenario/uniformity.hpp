// How far a sample is from a distribution, for tests of what is drawn at random.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumblesight::sim {

// Kolmogorov-Smirnov's statistic of values whose cumulative probabilities are given (uniform on 0..1 if the
// values have the distribution), times sqrt(count): above 1.95 in one of a thousand honest samples.
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
