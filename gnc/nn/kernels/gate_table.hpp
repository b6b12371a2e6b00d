// The sigmoid of the LSTM's gates in fixed point, as a table (docs/numerics.md).
#pragma once

#include <array>
#include <cstdint>

#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// The sigmoid at 0, 1/32, ... 16, interpolated linearly.
inline constexpr int kGateSegmentsPerUnit = 32;
inline constexpr int kGateSegments = 16 * kGateSegmentsPerUnit;
inline constexpr int kGatePositionBits = Fixed::kFractionBits - 5;  // of the position within a segment
static_assert(1 << 5 == kGateSegmentsPerUnit);
inline constexpr std::int32_t kGateEnd = 16 << Fixed::kFractionBits;

// e^-x for x in [0, 16] as (e^(-x / 1024))^1024; the error of the truncated series is below the last bit of a
// double. Evaluated by the compiler only.
constexpr double exp_negative(double x) {
  const double t = -x / 1024.0;
  double power = 1.0 + t * (1.0 + t / 2.0 * (1.0 + t / 3.0 * (1.0 + t / 4.0 * (1.0 + t / 5.0))));
  for (int i = 0; i < 10; ++i) power *= power;
  return power;
}

constexpr std::array<Fixed, kGateSegments + 1> make_gate_table() {
  std::array<Fixed, kGateSegments + 1> table{};
  for (int i = 0; i <= kGateSegments; ++i)
    table[i] = Fixed(1.0 / (1.0 + exp_negative(1.0 * i / kGateSegmentsPerUnit)));
  return table;
}

}  // namespace tumblesight::gnc
