// SensorSettings: the parameters of the sensor model, those of every effect. The defaults are the paper's
// sensor (sensor table).
#pragma once

#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {

struct SensorSettings {
  int rays = 128;               // per side of the square frame, at most gnc::RangeImage::kMaxRays
  double dropout_share = 0.0;   // 0..1 of the returns, removed at random
  double outlier_share = 0.0;   // 0..1 of the returns, wrong by 5 sigma to 20 m, nearer or farther
  bool noise = true;            // Gaussian range noise, see range_sigma_m
  double noise_factor = 1.0;    // of its standard deviation
  double fixed_fov = 0.0;       // times the field of view that fits at 20 m; 0: fitted at every range
  double footprint_rays = 0.0;  // width of the beam, in the distance of two rays; 0: a line
  double scan_time_s = 0.0;     // from the first to the last row; 0: all at once
  Effects effects{};            // see with_effects()
};

}  // namespace tumblesight::sim
