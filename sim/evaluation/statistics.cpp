#include "sim/evaluation/statistics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

namespace tumblesight::sim {

double mean_standard_error(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (count - 1.0) / count);
}

double share_standard_error(double share, std::size_t count) {
  if (count == 0) return 0.0;
  const auto n = static_cast<double>(count);
  const double p = (share * n + 0.5) / (n + 1.0);
  return std::sqrt(p * (1.0 - p) / n);
}

std::string degrees_text(double deg) {
  return fmt::format("{:.2f}°", deg);
}

std::string degrees_text(double deg, double error_deg) {
  return fmt::format("{:.2f} ± {:.2f}°", deg, error_deg);
}

std::string percent_text(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

std::string percent_text(double share, std::size_t count) {
  return fmt::format("{:.1f} ± {:.1f} %", 100.0 * share, 100.0 * share_standard_error(share, count));
}

}  // namespace tumblesight::sim
