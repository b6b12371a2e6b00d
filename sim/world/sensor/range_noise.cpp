#include "sim/world/sensor/range_noise.hpp"

#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {

double range_sigma_m(double range_m) {
  return 0.1 + 0.01 * range_m;
}

AfterEffect add_range_noise(const SensorSettings& settings, Random& random, double& range_m) {
  if (settings.noise) range_m += settings.noise_factor * range_sigma_m(range_m) * random.normal();
  return AfterEffect::kContinue;
}

}  // namespace tumblesight::sim
