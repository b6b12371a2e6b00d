// Elementary functions of integers and of Fixed (Q7.24). Definitions and errors: docs/numerics.md. The
// instruction count of each does not depend on its argument.
#pragma once

#include <cstdint>

#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// Largest r with r^2 <= square. Exact; 32 iterations.
std::uint32_t integer_sqrt(std::uint64_t square);
// Index of the highest bit that is set, 0 to 63; 0 for the values 0 and 1.
int highest_bit(std::uint64_t value);
// The same for 32 bits.
constexpr int highest_bit_32(std::uint32_t value) {
  int bit = 0;
#pragma GCC unroll 5
  for (int half = 16; half > 0; half /= 2) {
    const int step = (value >> (bit + half)) != 0 ? half : 0;
    bit += step;
  }
  return bit;
}
// The upper 32 bits of a product, rounded down.
constexpr std::int32_t high_product(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>((static_cast<std::int64_t>(a) * b) >> 32);
}

// Square root, error at most 2^-24. Negative arguments give 0.
Fixed sqrt(Fixed x);
// e^x, error at most 2^-24 for x <= 0 and relative 1e-8 above. Saturates for x > ln 128.
Fixed exp(Fixed x);
// Logistic function 1 / (1 + e^-x), error at most 2^-23.
Fixed sigmoid(Fixed x);

}  // namespace tumblesight::gnc
