// Ray effects: the losses and the noise of the paper's sensor and of the conditions, ray by ray. Everything
// else that a real sensor adds is in effects.hpp.
//
// Each ray draws from a stream of its own. With its parameters at their defaults a ray effect must not draw
// from `random`: recordings, traces and results would change for every existing seed.
#pragma once

#include <cstdint>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/sensor/range_grid.hpp"
#include "sim/world/sensor/sensor_settings.hpp"

namespace tumblesight::sim {

inline constexpr double kNoReturn_m = 0.0;

enum class AfterEffect {
  kContinue,  // with the next effect of the table
  kFinal,     // the range stands; later effects do not apply
};

// The rays on which an effect acts. What counts is whether the true ray hits something, not whether an
// earlier effect has taken its return away or made one.
enum class ActsOn {
  kHits,    // rays that hit the target or the occluder
  kMisses,  // rays that hit nothing, for example false returns from the background
  kAll,
};

struct RayEffect {
  // Changes `range_m`, which starts as the true range, or as kNoReturn_m if the ray hits nothing. `random` is
  // the stream of this ray in this frame.
  AfterEffect (*apply)(const SensorSettings& settings, Random& random, double& range_m);
  ActsOn acts_on;
};

// One standard deviation of a measured range: 0.1 m + 0.01 range, Gaussian along the ray, independent from
// ray to ray (paper, sensor table).
double range_sigma_m(double range_m);
double range_sigma_m(double range_m, const SensorSettings& settings);  // of another sensor

AfterEffect drop_out(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_outlier(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_range_noise(const SensorSettings& settings, Random& random, double& range_m);

// The effects of the sensor, in the order in which they apply.
const std::vector<RayEffect>& ray_effects();

// The ranges of `grid` after the effects; kNoReturn_m where a ray has no return. The same arguments give the
// same ranges.
std::vector<double> measured_ranges_m(const RangeGrid& grid, const std::vector<RayEffect>& effects,
                                      const SensorSettings& settings, std::uint64_t noise_seed);

// Rays per side of the frames of a sensor.
int frame_rays(const SensorSettings& settings);

// Fills rays, field of view and ranges of `frame` with what the sensor measured over its field of view
// `fov_urad`: in counts, and 0 (no return) outside (0, gnc::kMaxRange_m] and the range gate. A sensor with
// more rays than a frame, or with rays uniform in angle, goes through gnc::make_frame, as its driver would:
// the smallest window in the middle of the view that holds all returns and at least as many rays as the
// frame.
void report_ranges(const std::vector<double>& ranges_m, const SensorSettings& settings,
                   std::uint32_t fov_urad, gnc::RangeImage& frame);

}  // namespace tumblesight::sim
