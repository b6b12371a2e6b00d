// Conversion between degrees and radians. Angles are radians inside the program; degrees appear in files,
// tables and messages only.
#pragma once

namespace tumblesight::sim {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kPi_f = static_cast<float>(kPi);  // meshes are built in single precision
inline constexpr double kRadPerDeg = kPi / 180.0;
inline constexpr double kDegPerRad = 180.0 / kPi;

}  // namespace tumblesight::sim
