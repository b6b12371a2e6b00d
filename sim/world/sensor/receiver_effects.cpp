// Effects of the receiver: errors of the range that repeat, and pixels that do not do what they should.
#include <algorithm>
#include <cmath>

#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kHotPixelMean_m = 100.0;

// Calls change(index) for every ray with a return.
template <typename Change>
void for_each_return(RangeGrid& grid, Change&& change) {
  for (std::size_t i = 0; i < grid.range_m.size(); ++i) {
    if (std::isfinite(grid.range_m[i])) change(i);
  }
}

}  // namespace

// Every range is wrong by `strength` metres.
void add_range_bias(double strength, const Flash&, EffectRandom&, RangeGrid& grid) {
  for_each_return(grid, [&](std::size_t i) { grid.range_m[i] += strength; });
}

// Every range is wrong by `strength` of itself: a clock that runs too fast or too slow.
void scale_ranges(double strength, const Flash&, EffectRandom&, RangeGrid& grid) {
  for_each_return(grid, [&](std::size_t i) { grid.range_m[i] *= 1.0 + strength; });
}

// A weak return crosses the threshold late on its leading edge: by `strength` metres times
// 1 - cos(incidence).
void add_range_walk(double strength, const Flash&, EffectRandom&, RangeGrid& grid) {
  for_each_return(
      grid, [&](std::size_t i) { grid.range_m[i] += strength * (1.0 - surface_of(grid, i).cos_incidence); });
}

// Every pixel has a constant error of its own, Gaussian with `strength` metres as the standard deviation.
void add_fixed_pattern(double strength, const Flash&, EffectRandom& random, RangeGrid& grid) {
  for (double& range_m : grid.range_m) range_m += strength * random.sequence.normal();
}

// Dark counts and sunlight: with probability `strength` a ray reports a place drawn uniformly over the range
// gate, whether it has a return or not. New in every frame. Limit: the place does not depend on the return,
// as if the gate closed after one false count.
void add_false_returns(double strength, const SensorSettings& settings, EffectRandom& random,
                       std::vector<double>& range_m) {
  for (double& reported_m : range_m) {
    if (random.frame.uniform() < strength)
      reported_m = random.frame.uniform(settings.nearest_m, settings.farthest_m);
  }
}

// The given share of the pixels, drawn once per sequence, has so many dark counts that the first one often
// comes before the return: the pixel reports whichever is nearer. The place of the first dark count is
// exponentially distributed with a mean of 100 m, and new in every frame.
void add_hot_pixels(double strength, const SensorSettings&, EffectRandom& random,
                    std::vector<double>& range_m) {
  for (double& reported_m : range_m) {
    const double first_count_m = -kHotPixelMean_m * std::log(random.frame.uniform());
    if (random.sequence.uniform() >= strength) continue;
    reported_m = reported_m == kNoReturn_m ? first_count_m : std::min(reported_m, first_count_m);
  }
}

// The given share of the pixels never reports anything.
void add_dead_pixels(double strength, const SensorSettings&, EffectRandom& random,
                     std::vector<double>& range_m) {
  for (double& reported_m : range_m) {
    if (random.sequence.uniform() < strength) reported_m = kNoReturn_m;
  }
}

// The given share of the rows and of the columns never reports anything.
void add_dead_lines(double strength, const SensorSettings& settings, EffectRandom& random,
                    std::vector<double>& range_m) {
  const auto side = static_cast<std::size_t>(settings.rays);
  for (std::size_t line = 0; line < side; ++line) {
    const bool row_is_dead = random.sequence.uniform() < strength;
    const bool column_is_dead = random.sequence.uniform() < strength;
    for (std::size_t i = 0; i < side; ++i) {
      if (row_is_dead) range_m[line * side + i] = kNoReturn_m;
      if (column_is_dead) range_m[i * side + line] = kNoReturn_m;
    }
  }
}

}  // namespace tumblesight::sim
