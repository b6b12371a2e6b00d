// Pose: attitude and position of the target.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::gnc {

// Where the target is and how it is turned, as the sensor sees it.
struct Pose {
  Matrix3<Fixed> r_lrf_trf = Matrix3<Fixed>::Identity();  // v_lrf = r_lrf_trf v_trf
  std::array<std::int32_t, 3> origin_lrf_um{};            // origin of the TRF
};

}  // namespace tumblesight::gnc
