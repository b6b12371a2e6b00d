// Verifies TS-NUM-050.
#include "gnc/numerics/fixed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tumblesight::gnc {
namespace {

constexpr double kUnit = 1.0 / (1 << 24);
constexpr double kLargest = 128.0 - kUnit;

double value_of(Fixed x) {
  return x.raw() * kUnit;
}
double saturated(long double x) {
  return static_cast<double>(std::min<long double>(kLargest, std::max<long double>(-kLargest, x)));
}

// Extremes, small numbers, and numbers of every magnitude.
std::vector<Fixed> test_values() {
  std::vector<Fixed> all;
  for (const std::int64_t raw : {0L, 1L, 2L, 3L, 1L << 23, 1L << 24, 3L << 23, 0x7FFFFFFEL, 0x7FFFFFFFL}) {
    all.push_back(Fixed::from_raw(raw));
    all.push_back(Fixed::from_raw(-raw));
  }
  std::mt19937 engine(1);
  for (int i = 0; i < 200; ++i) {
    const auto bits = static_cast<std::int32_t>(engine());
    all.push_back(Fixed::from_raw(bits >> (i % 31)));
  }
  return all;
}

TEST(Fixed, SumsAreExactOrSaturate) {
  for (const Fixed a : test_values()) {
    for (const Fixed b : test_values()) {
      ASSERT_EQ(value_of(a + b), saturated(value_of(a) + value_of(b)));
      ASSERT_EQ(value_of(a - b), saturated(value_of(a) - value_of(b)));
    }
    EXPECT_EQ(value_of(-a), -value_of(a));
  }
}

TEST(Fixed, ProductsAndQuotientsAreRoundedToTheNearestHalvesUp) {
  for (const Fixed a : test_values()) {
    for (const Fixed b : test_values()) {
      const std::int64_t product = std::int64_t{a.raw()} * b.raw() + (1 << 23);
      ASSERT_EQ((a * b).raw(), Fixed::from_raw(product >> 24).raw());
      if (b.raw() == 0) continue;
      // Twice the quotient, truncated; then the floor of it.
      const std::int64_t dividend = std::int64_t{a.raw()} * (1 << 25);
      const std::int64_t twice = dividend / b.raw();
      const bool truncated_up = dividend % b.raw() != 0 && (dividend < 0) != (b.raw() < 0);
      ASSERT_EQ((a / b).raw(), Fixed::from_raw((twice - truncated_up + 1) >> 1).raw())
          << a.raw() << " / " << b.raw();
    }
  }
}

TEST(Fixed, DivisionByZeroGivesTheLargestNumber) {
  EXPECT_EQ((Fixed(1.0) / Fixed()).raw(), Fixed::kLargestRaw);
  EXPECT_EQ((Fixed(-1.0) / Fixed()).raw(), -Fixed::kLargestRaw);
}

TEST(Fixed, DotProductsAreRoundedOnceAndSaturate) {
  const std::vector<Fixed> all = test_values();
  std::mt19937 engine(2);
  const auto random_value = [&] { return all[engine() % all.size()]; };
  for (int i = 0; i < 20'000; ++i) {
    const Fixed a0 = random_value(), b0 = random_value(), a1 = random_value(), b1 = random_value(),
                a2 = random_value(), b2 = random_value();
    const std::int64_t two = std::int64_t{a0.raw()} * b0.raw() + std::int64_t{a1.raw()} * b1.raw();
    if (two > std::int64_t{1} << 61 || two < -(std::int64_t{1} << 61)) continue;
    const std::int64_t rounded = (two + std::int64_t{a2.raw()} * b2.raw() + (1 << 23)) >> 24;
    ASSERT_EQ(Fixed::dot(a0, b0, a1, b1, a2, b2).raw(), Fixed::from_raw(rounded).raw());
  }
  const Fixed largest = Fixed::from_raw(Fixed::kLargestRaw);
  EXPECT_EQ(Fixed::dot(largest, largest, largest, largest, largest, largest), largest);
  EXPECT_EQ(Fixed::dot(largest, -largest, largest, -largest, largest, -largest), -largest);
}

// On 32-bit processors both limits are applied word by word.
TEST(Fixed, AnyRawNumberIsLimitedToTheLargestOnes) {
  constexpr std::int64_t kMost = Fixed::kLargestRaw;
  for (const std::int64_t near : {std::int64_t{0}, kMost, std::int64_t{1} << 32, std::int64_t{3} << 31,
                                  std::int64_t{1} << 61, std::numeric_limits<std::int64_t>::max() - 3}) {
    for (std::int64_t more = -3; more <= 3; ++more) {
      for (const std::int64_t raw : {near + more, -near + more, -near - more - 1})
        EXPECT_EQ(Fixed::from_raw(raw).raw(), std::clamp(raw, -kMost, kMost)) << raw;
    }
  }
  EXPECT_EQ(Fixed::from_raw(std::numeric_limits<std::int64_t>::min()).raw(), -kMost);
}

TEST(Fixed, TheFirstTwoProductsOfADotProductAreLimited) {
  constexpr std::int64_t kBound = std::int64_t{1} << 61, kQ30 = std::int64_t{1} << 30;
  for (const std::int64_t sign : {-1, 1}) {
    // Twice the square of 2^30 is 2^61. The third product takes what is left into the range.
    for (const std::int64_t factor :
         {kQ30 - 3, kQ30 - 1, kQ30, kQ30 + 1, kQ30 + 3, std::int64_t{Fixed::kLargestRaw}}) {
      const Fixed a = Fixed::from_raw(sign * factor), b = Fixed::from_raw(factor);
      const Fixed c = Fixed::from_raw(-sign * Fixed::kLargestRaw), d = Fixed::from_raw(kQ30);
      const std::int64_t limited = std::clamp(sign * 2 * factor * factor, -kBound, kBound);
      const std::int64_t rounded = (limited + std::int64_t{c.raw()} * d.raw() + (1 << 23)) >> 24;
      ASSERT_LT(std::abs(rounded), Fixed::kLargestRaw);
      EXPECT_EQ(Fixed::dot(a, b, a, b, c, d).raw(), rounded) << factor << " " << sign;
    }
  }
}

TEST(Fixed, ConstantsAreRoundedToTheNearestAndSaturate) {
  EXPECT_EQ(Fixed(1.0).raw(), 1 << 24);
  EXPECT_EQ(Fixed(-0.4 * kUnit).raw(), 0);
  EXPECT_EQ(Fixed(0.6 * kUnit).raw(), 1);
  EXPECT_EQ(Fixed(1000.0).raw(), Fixed::kLargestRaw);
  EXPECT_EQ(Fixed(-1000.0).raw(), -Fixed::kLargestRaw);
}

}  // namespace
}  // namespace tumblesight::gnc
