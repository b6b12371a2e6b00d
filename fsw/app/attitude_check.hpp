// AttitudeCheck: whether an attitude lies where the last two lead to, if the target spins on as it did, and
// whether the sensor still looks.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::fsw {

// Within 1e-6.
bool is_unit(const gnc::QuaternionQ30& q);

// Cosine of half the angle between two attitudes, with 30 bits behind the point: |a . b|.
std::int32_t cos_half_angle(const gnc::QuaternionQ30& a, const gnc::QuaternionQ30& b);
// The same of an angle, 0 ... pi; within 1e-5.
std::int32_t cos_half_of(std::uint32_t angle_urad);

// Where a constant spin leads one step after `last`: last before^-1 last.
gnc::QuaternionQ30 propagated(const gnc::QuaternionQ30& before, const gnc::QuaternionQ30& last);

class AttitudeCheck {
 public:
  void forget() { *this = AttitudeCheck{}; }
  // Whether the attitude is farther from where the last two lead to than the limit; with fewer than two
  // before it, not. Then it counts as the last one. Attitudes are one frame period apart.
  bool jumps(const gnc::QuaternionQ30& q_lrf_trf, std::uint32_t limit_urad);
  // Whether a frame alone gave the attitude that the one before gave, bit for bit: the same ranges under a
  // new number, or a network that sees nothing. The noise of a sensor that looks turns at least the last
  // bits.
  bool repeats(const gnc::QuaternionQ30& q_lrf_trf_single_frame);

 private:
  gnc::QuaternionQ30 before_ = gnc::kIdentityQ30;
  gnc::QuaternionQ30 last_ = gnc::kIdentityQ30;
  std::uint32_t known_ = 0;                 // of these
  gnc::QuaternionQ30 last_single_frame_{};  // zeros, which no attitude has, at first
};

}  // namespace tumblesight::fsw
