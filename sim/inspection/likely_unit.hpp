// Which unit a mesh is probably in, judged by the size that it gives the spacecraft.
#pragma once

#include <vector>

namespace tumblesight::sim {

struct Unit {
  const char* name;  // in the plural
  double length_m;
};

// Spacecraft are taken to reach 0.15 to 15 m from their origin: from a CubeSat to a large space telescope.
inline constexpr double kSmallestPlausibleRadius_m = 0.15;
inline constexpr double kLargestPlausibleRadius_m = 15.0;

// The units in which a mesh of this radius is a spacecraft of plausible size, the one nearest to 3 m first.
// `radius`: in the unit of the file.
std::vector<Unit> likely_units(double radius);

}  // namespace tumblesight::sim
