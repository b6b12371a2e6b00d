#include "sim/adoption/outlook.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr std::size_t kFewest = 4;

}  // namespace

double Outlook::error_factor(double times) const {
  return std::pow(times, -exponent);
}

std::optional<Outlook> outlook_of(const std::vector<TrainingPoint>& points) {
  std::vector<TrainingPoint> cnn;
  for (const TrainingPoint& point : points)
    if (point.stage == "cnn" && point.samples > 0 && point.mean_deg > 0.0) cnn.push_back(point);
  cnn.erase(cnn.begin(), cnn.begin() + static_cast<std::ptrdiff_t>(cnn.size() / 4));
  if (cnn.size() < kFewest) return std::nullopt;
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const TrainingPoint& point : cnn) {
    const double u = std::log(static_cast<double>(point.samples)), v = std::log(point.mean_deg);
    n += 1.0;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const double spread = n * xx - x * x;
  if (!(spread > 0.0)) return std::nullopt;
  return Outlook{std::clamp(-(n * xy - x * y) / spread, 0.0, 1.0)};
}

}  // namespace tumblesight::sim
