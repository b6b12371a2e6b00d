// SensorSettings: the parameters of the sensor model, those of every effect. The defaults are the paper's
// sensor (sensor table).
#pragma once

namespace tumblesight::sim {

struct SensorSettings {
  int rays = 128;              // per side of the square frame, at most gnc::RangeImage::kMaxRays
  double dropout_share = 0.0;  // 0..1 of the returns, removed at random
  double outlier_share = 0.0;  // 0..1 of the returns, wrong by 5 sigma to 20 m, nearer or farther
  bool noise = true;           // Gaussian range noise, see range_sigma_m
};

}  // namespace tumblesight::sim
