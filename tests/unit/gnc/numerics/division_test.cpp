// Verifies TS-NUM-070.
#include "gnc/numerics/division.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <random>

namespace tumblesight::gnc {
namespace {

// Numbers of every bit length.
std::uint64_t random_number(std::mt19937_64& engine) {
  return engine() >> (engine() % 64);
}

TEST(Division, BitByBitEqualsTheProcessorsDivision) {
  std::mt19937_64 engine(5);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t dividend = random_number(engine);
    const std::uint64_t divisor = (random_number(engine) >> 1) + 1;
    ASSERT_EQ(divide_bit_by_bit(dividend, divisor), dividend / divisor) << dividend << " / " << divisor;
  }
  EXPECT_EQ(divide_bit_by_bit(UINT64_MAX, 1), UINT64_MAX);
  EXPECT_EQ(divide_bit_by_bit(UINT64_MAX, INT64_MAX), 2U);
}

TEST(Division, TruncatesTowardZero) {
  EXPECT_EQ(divide(7, 2), 3);
  EXPECT_EQ(divide(-7, 2), -3);
  EXPECT_EQ(divide(0, 5), 0);
}

template <class Integer>
void expect_masks() {
  using Limits = std::numeric_limits<Integer>;
  const std::array<Integer, 9> values{Limits::min(),
                                      Limits::max(),
                                      0,
                                      1,
                                      2,
                                      static_cast<Integer>(-1),
                                      static_cast<Integer>(-2),
                                      static_cast<Integer>(Limits::max() - 1),
                                      static_cast<Integer>(Limits::min() + 1)};
  for (const Integer a : values) {
    for (const Integer b : values) {
      EXPECT_EQ(less_mask(a, b), a < b ? static_cast<Integer>(~Integer{0}) : Integer{0}) << +a << " < " << +b;
      EXPECT_EQ(is_less(a, b), a < b);
      EXPECT_EQ(max(a, b), a < b ? b : a);
      EXPECT_EQ(min(a, b), b < a ? b : a);
    }
  }
}

TEST(Select, LessMaskEqualsTheComparison) {
  expect_masks<std::int16_t>();
  expect_masks<std::uint16_t>();
  expect_masks<std::int32_t>();
  expect_masks<std::uint32_t>();
  expect_masks<std::int64_t>();
  expect_masks<std::uint64_t>();
}

}  // namespace
}  // namespace tumblesight::gnc
