#include "sim/inspection/likely_unit.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {

std::vector<Unit> likely_units(double radius) {
  constexpr Unit kUnits[] = {
      {"metres", 1.0}, {"millimetres", 1e-3}, {"centimetres", 1e-2}, {"inches", 0.0254}, {"feet", 0.3048}};
  constexpr double kUsualRadius_m = 3.0;
  std::vector<Unit> likely;
  for (const Unit& unit : kUnits) {
    const double radius_m = radius * unit.length_m;
    if (radius_m >= kSmallestPlausibleRadius_m && radius_m <= kLargestPlausibleRadius_m)
      likely.push_back(unit);
  }
  const auto unusual = [radius](const Unit& unit) {
    return std::abs(std::log(radius * unit.length_m / kUsualRadius_m));
  };
  std::stable_sort(likely.begin(), likely.end(),
                   [&](const Unit& a, const Unit& b) { return unusual(a) < unusual(b); });
  return likely;
}

}  // namespace tumblesight::sim
