// A reciprocal in 32 bits, for depths and for the areas of triangles.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/numerics/functions.hpp"

namespace tumblesight::gnc {

// First guesses for reciprocal_q28(): 1 / the middle of the 128th in which x lies. The first 32 are not used.
extern const std::array<std::int32_t, 256> kReciprocal_q28;

// 1 / x with 28 fraction bits, relative error below 1e-7. x_q30: 1/4 to 2, without 2. By Newton's method in
// 32 bits; inline, since every vertex needs one.
inline std::int32_t reciprocal_q28(std::int32_t x_q30) {
  std::int32_t r = kReciprocal_q28[static_cast<std::size_t>(x_q30 >> 23)];
  for (int i = 0; i < 2; ++i) {
    const std::int32_t missing_q26 = (1 << 26) - high_product(x_q30, r);  // 1 - x r, below 1/32
    r += high_product(r, missing_q26 * (1 << 6));
  }
  return r;
}

}  // namespace tumblesight::gnc
