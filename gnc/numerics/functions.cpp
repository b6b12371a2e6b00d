#include "gnc/numerics/functions.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kOneQ30 = std::int64_t{1} << 30;

// Product of two Q30 numbers, rounded to the nearest, halves up. Requires |a b| < 2^63.
constexpr std::int64_t multiply_q30(std::int64_t a, std::int64_t b) {
  return (a * b + (kOneQ30 >> 1)) >> 30;
}

constexpr std::int64_t constant_q30(double value) {
  return static_cast<std::int64_t>(value * static_cast<double>(kOneQ30) + (value < 0.0 ? -0.5 : 0.5));
}

// 2^f for f in [0, 1), both in Q30: Taylor series of e^(f ln 2) up to the tenth power.
std::int64_t exp2_fraction_q30(std::int64_t f) {
  constexpr std::int64_t kLn2 = constant_q30(0.693147180559945309);
  const std::int64_t x = multiply_q30(f, kLn2);
  std::int64_t sum = kOneQ30;
  for (int n = 10; n >= 1; --n) {
    constexpr std::int64_t kReciprocal[] = {0,
                                            constant_q30(1.0),
                                            constant_q30(1.0 / 2.0),
                                            constant_q30(1.0 / 3.0),
                                            constant_q30(1.0 / 4.0),
                                            constant_q30(1.0 / 5.0),
                                            constant_q30(1.0 / 6.0),
                                            constant_q30(1.0 / 7.0),
                                            constant_q30(1.0 / 8.0),
                                            constant_q30(1.0 / 9.0),
                                            constant_q30(1.0 / 10.0)};
    sum = kOneQ30 + multiply_q30(multiply_q30(x, kReciprocal[n]), sum);
  }
  return sum;
}

}  // namespace

std::uint32_t integer_sqrt(std::uint64_t square) {
  // Digit-by-digit method: two bits of the square give one bit of the root.
  std::uint32_t root = 0;
  std::uint64_t remainder = 0;
  for (int bit = 31; bit >= 0; --bit) {
    remainder = (remainder << 2) | (square >> 62);
    square <<= 2;
    const std::uint64_t trial = (std::uint64_t{root} << 2) | 1;
    const std::uint64_t fits = ~less_mask(remainder, trial);
    remainder -= trial & fits;
    root = (root << 1) | static_cast<std::uint32_t>(fits & 1);
  }
  return root;
}

int highest_bit(std::uint64_t value) {
  const auto upper = static_cast<std::uint32_t>(value >> 32);
  int highest = select(upper != 0, 32, 0);
  std::uint32_t remaining = select(upper != 0, upper, static_cast<std::uint32_t>(value));
#pragma GCC unroll 5
  for (int step = 16; step >= 1; step /= 2) {
    const bool above = (remaining >> step) != 0;
    highest += select(above, step, 0);
    remaining = select(above, remaining >> step, remaining);
  }
  return highest;
}

Fixed sqrt(Fixed x) {
  // sqrt(raw 2^24), rounded to the nearest: half of sqrt(raw 2^26), rounded.
  const std::uint64_t raw = static_cast<std::uint64_t>(max(x.raw(), 0));
  return Fixed::from_raw((static_cast<std::int64_t>(integer_sqrt(raw << (Fixed::kFractionBits + 2))) + 1) >>
                         1);
}

Fixed exp(Fixed x) {
  // x / ln 2 = n + f in Q30: the product has 24 + 30 fraction bits, of which 24 are dropped.
  constexpr std::int64_t kLog2OfE = constant_q30(1.44269504088896341);
  const std::int64_t in_octaves = (std::int64_t{x.raw()} * kLog2OfE + (std::int64_t{1} << 23)) >> 24;
  const std::int64_t n = in_octaves >> 30;
  const std::int64_t mantissa = exp2_fraction_q30(in_octaves - n * kOneQ30);  // [1, 2)
  // From Q30 to Q24, times 2^n: (mantissa + 2^(right - 1)) >> right, with shifts of 32-bit integers only.
  const int right = clamp(6 - static_cast<int>(n), 0, 33);
  const auto m = static_cast<std::uint32_t>(mantissa);
  const std::uint32_t halved = (m >> 1) + (std::uint32_t{1} << max(right - 2, 0));
  const int remaining = max(right - 1, 0);
  const std::uint32_t shifted_by_more = halved >> (remaining / 2) >> (remaining - remaining / 2);
  const std::uint32_t shifted_by_at_most_one = select(is_less(right, 1), m, (m + 1) >> 1);
  const std::uint32_t shifted = select(is_less(right, 2), shifted_by_at_most_one, shifted_by_more);
  return Fixed::from_raw(select<std::int64_t>(is_less<std::int64_t>(6, n), Fixed::kLargestRaw, shifted));
}

Fixed sigmoid(Fixed x) {
  const Fixed e = exp(select(x > Fixed(), -x, x));  // <= 1
  const Fixed one = Fixed::from_raw(std::int64_t{1} << Fixed::kFractionBits);
  const Fixed below = e / (one + e);
  return select(x > Fixed(), one - below, below);
}

}  // namespace tumblesight::gnc
