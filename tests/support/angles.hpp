// Angles for tests that do not link ground code; the others use sim/world/math/angles.hpp.
#pragma once

namespace tumblesight {

inline constexpr double kDegree = 3.14159265358979323846 / 180.0;  // [rad]

}  // namespace tumblesight
