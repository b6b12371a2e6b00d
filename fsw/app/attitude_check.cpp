#include "fsw/app/attitude_check.hpp"

namespace tumblesight::fsw {
namespace {

constexpr int kBits = 30;
constexpr std::int64_t kOne = std::int64_t{1} << kBits;

std::int64_t product(std::int64_t a, std::int64_t b) {
  return (a * b + kOne / 2) >> kBits;
}

// Hamilton product. 64 bits, because a sum of four products can reach 4.
gnc::QuaternionQ30 product(const gnc::QuaternionQ30& a, const gnc::QuaternionQ30& b) {
  const auto part = [](std::int64_t sum) {
    const std::int64_t bounded = sum > INT32_MAX ? INT32_MAX : sum < -INT32_MAX ? -INT32_MAX : sum;
    return static_cast<std::int32_t>(bounded);
  };
  return {part(product(a[0], b[0]) - product(a[1], b[1]) - product(a[2], b[2]) - product(a[3], b[3])),
          part(product(a[0], b[1]) + product(a[1], b[0]) + product(a[2], b[3]) - product(a[3], b[2])),
          part(product(a[0], b[2]) - product(a[1], b[3]) + product(a[2], b[0]) + product(a[3], b[1])),
          part(product(a[0], b[3]) + product(a[1], b[2]) - product(a[2], b[1]) + product(a[3], b[0]))};
}

}  // namespace

bool is_unit(const gnc::QuaternionQ30& q) {
  std::int64_t square = 0;  // Q28
  for (const std::int32_t part : q) square += (static_cast<std::int64_t>(part) * part) >> 32;
  constexpr std::int64_t kOne28 = std::int64_t{1} << 28;
  constexpr std::int64_t kTolerance = kOne28 / 500'000;
  return square > kOne28 - kTolerance && square < kOne28 + kTolerance;
}

std::int32_t cos_half_angle(const gnc::QuaternionQ30& a, const gnc::QuaternionQ30& b) {
  std::int64_t dot = 0;
  for (std::size_t i = 0; i < 4; ++i) dot += product(a[i], b[i]);
  if (dot < 0) dot = -dot;
  return static_cast<std::int32_t>(dot < kOne ? dot : kOne);
}

// Taylor series up to the eighth power; half of the angle is at most pi / 2.
std::int32_t cos_half_of(std::uint32_t angle_urad) {
  const std::int64_t half = static_cast<std::int64_t>(angle_urad) * kOne / 2'000'000;
  const std::int64_t square = product(half, half);
  std::int64_t sum = kOne;
  for (const std::int64_t divisor : {56, 30, 12, 2}) sum = kOne - product(square, sum) / divisor;
  return static_cast<std::int32_t>(sum > 0 ? sum : 0);
}

gnc::QuaternionQ30 propagated(const gnc::QuaternionQ30& before, const gnc::QuaternionQ30& last) {
  const gnc::QuaternionQ30 back{before[0], -before[1], -before[2], -before[3]};
  return product(product(last, back), last);
}

bool AttitudeCheck::jumps(const gnc::QuaternionQ30& q_lrf_trf, std::uint32_t limit_urad) {
  const bool jumped =
      known_ >= 2 && cos_half_angle(propagated(before_, last_), q_lrf_trf) < cos_half_of(limit_urad);
  before_ = last_;
  last_ = q_lrf_trf;
  known_ = known_ < 2 ? known_ + 1 : 2;
  return jumped;
}

bool AttitudeCheck::repeats(const gnc::QuaternionQ30& q_lrf_trf_single_frame) {
  const bool repeated = q_lrf_trf_single_frame == last_single_frame_;
  last_single_frame_ = q_lrf_trf_single_frame;
  return repeated;
}

}  // namespace tumblesight::fsw
