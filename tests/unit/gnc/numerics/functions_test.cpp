// Verifies TS-NUM-060.
#include "gnc/numerics/functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tumblesight::gnc {
namespace {

constexpr double kUnitInTheLast = 1.0 / (1 << 24);

double to_double(Fixed x) {
  return x.raw() * kUnitInTheLast;
}

// Largest error of `function` against `exact` over a sweep of the whole range.
template <class Function, class Exact>
double worst_error(Function function, Exact exact) {
  double worst = 0.0;
  for (std::int64_t raw = -Fixed::kLargestRaw; raw <= Fixed::kLargestRaw; raw += 4999) {
    const Fixed x = Fixed::from_raw(raw);
    const double expected = std::min(128.0 - kUnitInTheLast, exact(to_double(x)));
    worst = std::max(worst, std::fabs(to_double(function(x)) - expected));
  }
  return worst;
}

TEST(Sqrt, ErrorIsAtMostOneUnit) {
  EXPECT_LE(
      worst_error([](Fixed x) { return sqrt(x); }, [](double x) { return std::sqrt(std::max(0.0, x)); }),
      kUnitInTheLast);
  EXPECT_EQ(sqrt(Fixed(4.0)), Fixed(2.0));
  EXPECT_EQ(sqrt(Fixed(-1.0)), Fixed());
}

TEST(Exp, ErrorIsAtMostOneUnitPlusRelative3em9) {
  const auto exact = [](double x) { return std::exp(x); };
  EXPECT_LE(worst_error([](Fixed x) { return exp(x); }, exact), 128.0 * 3e-9 + kUnitInTheLast);
  EXPECT_EQ(exp(Fixed()), Fixed(1.0));
  EXPECT_EQ(exp(Fixed(127.0)).raw(), Fixed::kLargestRaw);
  EXPECT_EQ(exp(Fixed(-127.0)), Fixed());
}

TEST(Sigmoid, ErrorIsAtMostTwoUnits) {
  EXPECT_LE(
      worst_error([](Fixed x) { return sigmoid(x); }, [](double x) { return 1.0 / (1.0 + std::exp(-x)); }),
      2.0 * kUnitInTheLast);
  EXPECT_EQ(sigmoid(Fixed()), Fixed(0.5));
}

TEST(IntegerSqrt, IsTheLargestRootNotAbove) {
  std::mt19937_64 engine(1);
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t square = i == 0 ? ~std::uint64_t{0} : engine() >> (i % 64);
    const std::uint64_t root = integer_sqrt(square);
    ASSERT_LE(root * root, square);
    if (root < 0xFFFFFFFFU) {
      ASSERT_GT((root + 1) * (root + 1), square);
    }
  }
  EXPECT_EQ(integer_sqrt(0), 0U);
}

TEST(HighestBit, IsThePositionOfTheHighestBitSet) {
  EXPECT_EQ(highest_bit(0), 0);
  for (int bit = 0; bit < 64; ++bit) {
    EXPECT_EQ(highest_bit(std::uint64_t{1} << bit), bit);
    EXPECT_EQ(highest_bit((std::uint64_t{1} << bit) | ((std::uint64_t{1} << bit) - 1)), bit);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
