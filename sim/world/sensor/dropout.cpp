// Dropout: a return that the receiver misses, at random and independent from ray to ray.
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {

AfterEffect drop_out(const SensorSettings& settings, Random& random, double& range_m) {
  if (!(settings.dropout_share > 0.0) || random.uniform() >= settings.dropout_share) {
    return AfterEffect::kContinue;
  }
  range_m = kNoReturn_m;
  return AfterEffect::kFinal;
}

}  // namespace tumblesight::sim
