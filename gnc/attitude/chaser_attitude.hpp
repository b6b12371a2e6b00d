// ChaserAttitude: the chaser's own attitude, from its navigation.
#pragma once

#include <cstdint>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::gnc {

// The inertial frame is any frame that does not turn, as long as it stays the same.
struct ChaserAttitude {
  std::int64_t time_ns = 0;                     // for which it holds
  QuaternionQ30 q_inertial_lrf = kIdentityQ30;  // v_inertial = q_inertial_lrf v_lrf
  bool valid = false;
};

}  // namespace tumblesight::gnc
