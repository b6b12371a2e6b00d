#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

// In the order in which they apply.
constexpr RayEffect kRayEffects[] = {drop_out, add_outlier, add_range_noise};

}  // namespace

double measured_range_m(double true_range_m, const SensorSettings& settings, Random random) {
  double range_m = true_range_m;
  for (const RayEffect effect : kRayEffects) {
    if (effect(settings, random, range_m) == AfterEffect::kFinal) break;
  }
  return range_m;
}

}  // namespace tumblesight::sim
