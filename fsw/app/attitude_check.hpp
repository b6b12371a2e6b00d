// AttitudeCheck: plausibility checks of an attitude. It compares the attitude with the last two, extrapolated
// at a constant rate, and detects a frozen sensor. Quaternions: Hamilton, scalar first, TRF to LRF, Q30.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::fsw {

// Whether the squared norm is 1 within 2e-6.
bool is_unit(const gnc::QuaternionQ30& q);

// Cosine of half the angle between two unit quaternions, |a . b|, in Q30.
std::int32_t cos_half_angle(const gnc::QuaternionQ30& a, const gnc::QuaternionQ30& b);
// Cosine of half of an angle in 0 ... pi, in Q30, with an error below 1e-5.
std::int32_t cos_half_of(std::uint32_t angle_urad);

// Attitude one step after `last` at a constant rate: last * before^-1 * last.
gnc::QuaternionQ30 propagated(const gnc::QuaternionQ30& before, const gnc::QuaternionQ30& last);

class AttitudeCheck {
 public:
  void forget() { *this = AttitudeCheck{}; }
  // Whether the angle between the attitude and the one extrapolated from the last two exceeds the limit.
  // False with fewer than two attitudes before it. Keeps the attitude as the last one. Attitudes must be one
  // frame period apart.
  bool jumps(const gnc::QuaternionQ30& q_lrf_trf, std::uint32_t limit_urad);
  // Whether a frame alone gives the same attitude as the frame before it, bit for bit. The noise of a working
  // sensor changes at least the last bits, so equal bits mean repeated ranges or a network without input.
  bool repeats(const gnc::QuaternionQ30& q_lrf_trf_single_frame);

 private:
  gnc::QuaternionQ30 before_ = gnc::kIdentityQ30;
  gnc::QuaternionQ30 last_ = gnc::kIdentityQ30;
  std::uint32_t known_ = 0;                 // how many of the two are valid
  gnc::QuaternionQ30 last_single_frame_{};  // initially zeros, which are not an attitude
};

}  // namespace tumblesight::fsw
