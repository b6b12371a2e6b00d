// Effects of how a surface returns light. The models take the angle of incidence: between the ray and the
// surface's normal, on either side. Surfaces other than the target's count as facing the sensor.
#include <Eigen/Core>
#include <cmath>

#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kReferenceRange_m = 100.0;
constexpr double kVisible_m = 0.25;  // a reflector farther than this behind the surface of its ray is hidden

// Takes each return away for which keeps(surface) is false.
template <typename Predicate>
void keep_returns(RangeGrid& grid, Predicate&& keeps) {
  for (std::size_t i = 0; i < grid.range_m.size(); ++i) {
    if (std::isfinite(grid.range_m[i]) && !keeps(surface_of(grid, i))) lose_return(grid, i, grid.range_m[i]);
  }
}

}  // namespace

// Panels are mirrors with some scatter: they return light only within `strength` degrees of their normal.
void limit_panel_lobe(double strength, const Flash&, EffectRandom&, RangeGrid& grid) {
  const double least = std::cos(kRadPerDeg * strength);
  keep_returns(grid, [=](const SurfaceHit& s) { return !s.is_panel || s.cos_incidence >= least; });
}

// The same for every surface of the target.
void limit_lobe(double strength, const Flash&, EffectRandom&, RangeGrid& grid) {
  const double least = std::cos(kRadPerDeg * strength);
  keep_returns(grid, [=](const SurfaceHit& s) { return s.cos_incidence >= least; });
}

// A return is detected with probability cos^strength of the incidence: 1 is a Lambertian surface, more is
// glossier.
void thin_by_cosine(double strength, const Flash&, EffectRandom& random, RangeGrid& grid) {
  keep_returns(grid, [&](const SurfaceHit& s) {
    return random.frame.uniform() < std::pow(s.cos_incidence, strength);
  });
}

// Poisson detection of the first photoelectron: a Lambertian surface that faces the sensor at 100 m gives
// `strength` photoelectrons on average, others in proportion to cos(incidence) / range^2 (the target fills
// the footprint of a ray). A return is detected with probability 1 - exp(-mean).
void detect_photons(double strength, const Flash&, EffectRandom& random, RangeGrid& grid) {
  keep_returns(grid, [&](const SurfaceHit& s) {
    const double nearness = kReferenceRange_m / s.range_m;
    const double mean = strength * s.cos_incidence * nearness * nearness;
    return random.frame.uniform() < 1.0 - std::exp(-mean);
  });
}

// Retroreflectors at the target's six extreme corners, along +-x, +-y and +-z of the TRF. Each one in view
// saturates the receiver: the rays within `strength` rays of it report its range. A surface hides what is
// behind it, whether its own light comes back or not. Limit: a reflector returns light at every incidence.
void add_retroreflectors(double strength, const Flash& flash, EffectRandom&, RangeGrid& grid) {
  const Eigen::Vector2d offset_m = flash.truth.offset_swaths * flash.swath_m;
  const Eigen::Vector3d target_m(offset_m.x(), flash.truth.range_m, offset_m.y());
  const RangeGrid seen = grid;
  for (const Eigen::Vector3f& corner : flash.corners_trf_m) {
    const Eigen::Vector3d place_m = flash.truth.q_lrf_trf * corner.cast<double>() + target_m;
    const double column = grid.index_of(place_m.x() / place_m.y());
    const double row = grid.index_of(-place_m.z() / place_m.y());
    const long at = std::lround(row) * grid.rays + std::lround(column);
    const bool inside = column > -0.5 && row > -0.5 && column < grid.rays - 0.5 && row < grid.rays - 0.5;
    const double range_m = place_m.norm();
    if (!inside || sight_m(seen, static_cast<std::size_t>(at)) < range_m - kVisible_m) continue;
    for (int i = 0; i < grid.rays * grid.rays; ++i) {
      const double right = i % grid.rays - column;
      const double down = i / grid.rays - row;
      if (right * right + down * down <= strength * strength)
        grid.range_m[static_cast<std::size_t>(i)] = range_m;
    }
  }
}

}  // namespace tumblesight::sim
