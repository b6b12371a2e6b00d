// SensorSettings: the parameters of the sensor model, those of every effect. The defaults are the paper's
// sensor (sensor table). A sensor description (sensor_description.hpp) gives those of another sensor, a
// condition and the effects change them: sensor_settings() in sim/world/scenario/condition.hpp.
#pragma once

#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {

struct SensorSettings {
  int rays = 128;               // per side of the square view, at most gnc::kMaxSensorRays
  double dropout_share = 0.0;   // 0..1 of the returns, removed at random
  double outlier_share = 0.0;   // 0..1 of the returns, wrong by 5 sigma to 20 m, nearer or farther
  bool noise = true;            // Gaussian range noise, see range_sigma_m
  double noise_factor = 1.0;    // of its standard deviation
  double fixed_fov = 0.0;       // times the field of view that fits at 20 m; 0: fov_deg holds
  double footprint_rays = 0.0;  // width of the beam, in the distance of two rays; 0: a line
  double scan_time_s = 0.0;     // from the first to the last row; 0: all at once
  double fov_deg = 0.0;         // full field of view; 0: fitted to the target at every range
  RaySpacing spacing = RaySpacing::kTangent;
  double nearest_m = 0.0;  // the range gate: returns outside are not reported
  double farthest_m = 500.0;
  double noise_constant_m = 0.1;  // standard deviation of the range noise: constant + per_range * range
  double noise_per_range = 0.01;
  double photoelectrons = 0.0;  // link budget, as the effect; 0: every return is detected
  Effects effects{};            // see with_effects()
};

}  // namespace tumblesight::sim
