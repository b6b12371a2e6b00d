// Range noise: Gaussian, zero mean, along the ray, independent from ray to ray.
#pragma once

namespace tumblesight::sim {

// One standard deviation of a measured range: 0.1 m + 0.01 range (paper, sensor table).
double range_sigma_m(double range_m);

}  // namespace tumblesight::sim
