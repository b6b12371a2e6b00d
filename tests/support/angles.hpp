// Angles for tests that know no ground code; sim/world/math/angles.hpp is the one for the others.
#pragma once

namespace tumblesight {

inline constexpr double kDegree = 3.14159265358979323846 / 180.0;  // [rad]

}  // namespace tumblesight
