#include "sim/world/sensor/ray_effects.hpp"

#include <algorithm>
#include <cmath>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/frame_rays.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kMinError_sigma = 5.0;
constexpr double kMaxError_m = 20.0;

constexpr double kMicro = 1e-6;

// Rounded to the frame's Q9.7 counts; 0 (no return) outside the range gate.
std::uint16_t to_counts(double range_m, const SensorSettings& settings) {
  if (!(range_m > 0.0) || range_m < settings.nearest_m || range_m > settings.farthest_m) return 0;
  return static_cast<std::uint16_t>(std::max(1L, std::lround(range_m / gnc::RangeImage::kMetresPerCount)));
}

// The field of view of the middle `rays` rays of a side.
std::uint32_t fov_urad_of(const RangeGrid& grid, int rays) {
  const double half_rad = std::atan(grid.slope_at(static_cast<double>(rays) / grid.rays));
  return static_cast<std::uint32_t>(std::lround(2.0 * half_rad / kMicro));
}

// The smallest window in the middle of the view that holds every return, has at least as many rays as the
// frame and is wide enough for one.
gnc::FrameWindow window_of(const std::vector<std::uint16_t>& counts, const RangeGrid& grid) {
  const int frame_rays = std::min(grid.rays, gnc::RangeImage::kMaxRays);
  int rays = std::max(gnc::rays_with_returns(counts.data(), grid.rays), grid.rays % 2);
  while (rays < grid.rays && (rays < frame_rays || fov_urad_of(grid, rays) < gnc::kMinFov_urad)) rays += 2;
  const std::uint32_t fov_urad = fov_urad_of(grid, rays);
  return {frame_rays, static_cast<float>(std::tan(0.5 * kMicro * fov_urad)), fov_urad};
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

// A return that the receiver misses, at random and independent from ray to ray.
AfterEffect drop_out(const SensorSettings& settings, Random& random, double& range_m) {
  if (!(settings.dropout_share > 0.0) || random.uniform() >= settings.dropout_share) {
    return AfterEffect::kContinue;
  }
  range_m = kNoReturn_m;
  return AfterEffect::kFinal;
}

// A return whose range is wrong by 5 sigma to 20 m (uniform), nearer or farther with equal probability. It
// replaces the range noise of its ray.
AfterEffect add_outlier(const SensorSettings& settings, Random& random, double& range_m) {
  if (!(settings.outlier_share > 0.0) || random.uniform() >= settings.outlier_share) {
    return AfterEffect::kContinue;
  }
  const double sigma_m = settings.noise ? settings.noise_factor * range_sigma_m(range_m, settings) : 0.0;
  const double error_m = random.uniform(std::min(kMinError_sigma * sigma_m, kMaxError_m), kMaxError_m);
  range_m += random.uniform() < 0.5 ? -error_m : error_m;
  return AfterEffect::kFinal;
}

double range_sigma_m(double range_m) {
  constexpr SensorSettings kPaper{};
  return range_sigma_m(range_m, kPaper);
}

double range_sigma_m(double range_m, const SensorSettings& settings) {
  return settings.noise_constant_m + settings.noise_per_range * range_m;
}

AfterEffect add_range_noise(const SensorSettings& settings, Random& random, double& range_m) {
  if (settings.noise) range_m += settings.noise_factor * range_sigma_m(range_m, settings) * random.normal();
  return AfterEffect::kContinue;
}

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

int frame_rays(const SensorSettings& settings) {
  return std::min(settings.rays, gnc::RangeImage::kMaxRays);
}

void report_ranges(const std::vector<double>& ranges_m, const SensorSettings& settings,
                   std::uint32_t fov_urad, gnc::RangeImage& frame) {
  std::vector<std::uint16_t> counts(ranges_m.size());
  std::transform(ranges_m.begin(), ranges_m.end(), counts.begin(),
                 [&](double range_m) { return to_counts(range_m, settings); });
  if (settings.spacing == RaySpacing::kTangent && settings.rays <= gnc::RangeImage::kMaxRays) {
    frame.rays = static_cast<std::uint16_t>(settings.rays);
    frame.fov_urad = fov_urad;
    frame.ranges.fill(0);
    std::copy(counts.begin(), counts.end(), frame.ranges.begin());
    return;
  }
  const RangeGrid grid{settings.rays, std::tan(0.5 * kMicro * fov_urad), {}, {}, settings.spacing};
  std::vector<float> slopes;
  for (int i = 0; i < settings.rays; ++i) slopes.push_back(static_cast<float>(grid.slope(i)));
  gnc::make_frame(counts.data(), {settings.rays, slopes.data()}, window_of(counts, grid), frame);
}

}  // namespace tumblesight::sim
