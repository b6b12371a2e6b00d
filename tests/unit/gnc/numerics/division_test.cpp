// Verifies TS-NUM-070.
#include "gnc/numerics/division.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace tumblesight::gnc {
namespace {

// Numbers of every bit length.
std::uint64_t random_number(std::mt19937_64& engine) {
  return engine() >> (engine() % 64);
}

void expect_exact(std::uint64_t dividend, std::uint64_t divisor) {
  ASSERT_EQ(divide_by_reciprocal(dividend, divisor), dividend / divisor) << dividend << " / " << divisor;
}

// Of every bit length, with remainders of 0, of the divisor minus 1, and others.
TEST(Division, ByReciprocalEqualsTheProcessorsDivision) {
  std::mt19937_64 engine(5);
  for (int i = 0; i < 300'000; ++i) {
    const std::uint64_t dividend = random_number(engine);
    const std::uint64_t divisor = std::max<std::uint64_t>(random_number(engine), 1);
    expect_exact(dividend, divisor);
    const std::uint64_t multiple = dividend / divisor * divisor;
    expect_exact(multiple, divisor);
    expect_exact(multiple - 1, divisor);
  }
}

// All pairs of powers of two, up to 3 more or less.
TEST(Division, ByReciprocalIsExactAroundPowersOfTwo) {
  std::vector<std::uint64_t> numbers;
  for (int bit = 0; bit < 64; ++bit)
    for (std::uint64_t more = 0; more <= 6; ++more) numbers.push_back((std::uint64_t{1} << bit) + more - 3);
  for (const std::uint64_t dividend : numbers)
    for (const std::uint64_t divisor : numbers)
      if (divisor != 0) expect_exact(dividend, divisor);
}

// Every reciprocal of 20 bits, once just below and once at a multiple.
TEST(Division, ByReciprocalIsExactForEveryLeadingPartOfADivisor) {
  for (std::uint64_t lead = 1 << 19; lead < 1 << 20; ++lead) {
    for (const std::uint64_t divisor : {lead, lead << 43, (lead << 43) | ((std::uint64_t{1} << 43) - 1)}) {
      const std::uint64_t largest = UINT64_MAX / divisor * divisor;
      expect_exact(largest, divisor);
      expect_exact(largest - 1, divisor);
    }
  }
}

TEST(Division, TruncatesTowardZero) {
  EXPECT_EQ(divide(7, 2), 3);
  EXPECT_EQ(divide(-7, 2), -3);
  EXPECT_EQ(divide(0, 5), 0);
  EXPECT_EQ(divide(INT64_MIN, 2), INT64_MIN / 2);
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

template <class Integer>
void expect_absolute_values() {
  using Limits = std::numeric_limits<Integer>;
  EXPECT_EQ(abs<Integer>(Limits::min()), Limits::min());
  EXPECT_EQ(abs<Integer>(Limits::min() + 1), Limits::max());
  EXPECT_EQ(abs<Integer>(-1), 1);
  EXPECT_EQ(abs<Integer>(0), 0);
  EXPECT_EQ(abs<Integer>(Limits::max()), Limits::max());
}
// In the sanitizers' build also: without an overflow.
TEST(Select, AbsoluteValueKeepsTheMostNegativeInteger) {
  expect_absolute_values<std::int16_t>();
  expect_absolute_values<std::int32_t>();
  expect_absolute_values<std::int64_t>();
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
