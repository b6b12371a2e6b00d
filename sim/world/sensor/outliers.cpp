// Outlier: a return whose range is wrong by 5 sigma to 20 m (uniform), nearer or farther with equal
// probability. It replaces the range noise of its ray.
#include <algorithm>

#include "sim/world/sensor/range_noise.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kMinError_sigma = 5.0;
constexpr double kMaxError_m = 20.0;

}  // namespace

AfterEffect add_outlier(const SensorSettings& settings, Random& random, double& range_m) {
  if (!(settings.outlier_share > 0.0) || random.uniform() >= settings.outlier_share) {
    return AfterEffect::kContinue;
  }
  const double sigma_m = settings.noise ? settings.noise_factor * range_sigma_m(range_m) : 0.0;
  const double error_m = random.uniform(std::min(kMinError_sigma * sigma_m, kMaxError_m), kMaxError_m);
  range_m += random.uniform() < 0.5 ? -error_m : error_m;
  return AfterEffect::kFinal;
}

}  // namespace tumblesight::sim
