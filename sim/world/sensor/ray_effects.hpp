// Ray effects: how the range that the sensor reports for one ray differs from the true range.
//
// To add an effect: its parameters in sensor_settings.hpp, its function here and in a file of its own, its
// row in the table of ray_effects.cpp, which also says on which rays it acts. With its parameters at their
// defaults an effect must not draw from `random`: recordings, traces and results would change for every
// existing seed. What stands in front of the target is not a ray effect: it changes the true ranges before
// (occlusion.hpp).
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

AfterEffect drop_out(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_outlier(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_range_noise(const SensorSettings& settings, Random& random, double& range_m);

// The effects of the sensor, in the order in which they apply.
const std::vector<RayEffect>& ray_effects();

// Fills the ranges of `frame` with those of `grid` after the effects: in counts, and 0 (no return) outside
// (0, gnc::kMaxRange_m]. The same arguments give the same ranges.
void measure_ranges(const RangeGrid& grid, const std::vector<RayEffect>& effects,
                    const SensorSettings& settings, std::uint64_t noise_seed, gnc::RangeImage& frame);

}  // namespace tumblesight::sim
