// What holds for every estimate, whatever its frame, weights and state.
#pragma once

#include <cmath>

#include "gnc/estimation/attitude_estimator.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {

inline void check_quaternion(const gnc::QuaternionQ30& q) {
  require(q[0] >= 0, "a quaternion's scalar is not negative");
  require(std::abs(gnc::to_double(q).norm() - 1.0) < 1e-7, "a quaternion is of unit length");
}

inline void check_estimate(const gnc::AttitudeEstimate& estimate) {
  check_quaternion(estimate.q_lrf_trf);
  check_quaternion(estimate.q_lrf_trf_single_frame);
  require(estimate.predicted_error_urad <= gnc::kPi_urad, "an expected error is at most pi");
  require(estimate.predicted_error_single_frame_urad <= gnc::kPi_urad,
          "a single frame's expected error is at most pi");
}

}  // namespace tumblesight::fuzz
