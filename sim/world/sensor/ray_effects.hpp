// Ray effects: how the measured range of one ray differs from the true range.
//
// To add an effect: its parameters in sensor_settings.hpp, its function here and in a file of its own, its
// row in the table of ray_effects.cpp. With its parameters at their defaults an effect must not draw from
// `random`: recordings, traces and results would change for every existing seed.
#pragma once

#include "sim/world/math/random.hpp"
#include "sim/world/sensor/sensor_settings.hpp"

namespace tumblesight::sim {

inline constexpr double kNoReturn_m = 0.0;

enum class AfterEffect {
  kContinue,  // with the next effect of the table
  kFinal,     // the range stands; later effects do not apply
};

// Changes `range_m`, which starts as the true range. `random` is the stream of this ray in this frame.
using RayEffect = AfterEffect (*)(const SensorSettings& settings, Random& random, double& range_m);

AfterEffect drop_out(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_outlier(const SensorSettings& settings, Random& random, double& range_m);
AfterEffect add_range_noise(const SensorSettings& settings, Random& random, double& range_m);

// The measured range after all effects; kNoReturn_m for a lost return. May be negative or beyond the sensor's
// reach.
double measured_range_m(double true_range_m, const SensorSettings& settings, Random random);

}  // namespace tumblesight::sim
