#include "sim/world/sensor/ray_effects.hpp"

#include <algorithm>
#include <cmath>

#include "gnc/lidar/depth_image.hpp"

namespace tumblesight::sim {
namespace {

// Rounded to the sensor's Q9.7 counts; 0 (no return) outside (0, gnc::kMaxRange_m].
std::uint16_t to_counts(double range_m) {
  if (!(range_m > 0.0) || range_m > gnc::kMaxRange_m) return 0;
  return static_cast<std::uint16_t>(std::max(1L, std::lround(range_m / gnc::RangeImage::kMetresPerCount)));
}

// Every ray draws from a stream of its own, so that order and threads do not matter.
Random stream_of_ray(std::uint64_t noise_seed, std::size_t ray) {
  return Random(mix(noise_seed, static_cast<std::uint64_t>(ray)));
}

double measured_range_m(double true_range_m, const std::vector<RayEffect>& effects,
                        const SensorSettings& settings, Random random) {
  const bool hits = std::isfinite(true_range_m);
  const ActsOn not_for_this_ray = hits ? ActsOn::kMisses : ActsOn::kHits;
  double range_m = hits ? true_range_m : kNoReturn_m;
  for (const RayEffect& effect : effects) {
    if (effect.acts_on == not_for_this_ray) continue;
    if (effect.apply(settings, random, range_m) == AfterEffect::kFinal) break;
  }
  return range_m;
}

}  // namespace

const std::vector<RayEffect>& ray_effects() {
  static const std::vector<RayEffect> kEffects{
      {drop_out, ActsOn::kHits}, {add_outlier, ActsOn::kHits}, {add_range_noise, ActsOn::kHits}};
  return kEffects;
}

std::vector<double> measured_ranges_m(const RangeGrid& grid, const std::vector<RayEffect>& effects,
                                      const SensorSettings& settings, std::uint64_t noise_seed) {
  std::vector<double> ranges_m(grid.range_m.size());
  for (std::size_t ray = 0; ray < grid.range_m.size(); ++ray) {
    const Random random = stream_of_ray(noise_seed, ray);
    ranges_m[ray] = measured_range_m(grid.range_m[ray], effects, settings, random);
  }
  return ranges_m;
}

void report_ranges(const std::vector<double>& ranges_m, gnc::RangeImage& frame) {
  frame.ranges.fill(0);
  std::transform(ranges_m.begin(), ranges_m.end(), frame.ranges.begin(), to_counts);
}

}  // namespace tumblesight::sim
