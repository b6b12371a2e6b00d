#include "gnc/registration/reciprocal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

TEST(ReciprocalQ28, IsWithin1e7OverItsWholeRange) {
  constexpr std::int64_t kFirst = std::int64_t{1} << 28, kLast = std::int64_t{1} << 31;
  double worst = 0.0;
  const auto check = [&](std::int32_t x_q30) {
    const double exact = std::ldexp(1.0, 58) / static_cast<double>(x_q30);
    worst = std::max(worst, std::abs(reciprocal_q28(x_q30) / exact - 1.0));
  };
  Random random(1);
  for (int i = 0; i < trials(200'000); ++i)
    check(static_cast<std::int32_t>(random.uniform(static_cast<double>(kFirst), static_cast<double>(kLast))));
  // The ends of the intervals of the first guess.
  for (std::int64_t x = kFirst; x < kLast; x += 1 << 23) {
    check(static_cast<std::int32_t>(x));
    check(static_cast<std::int32_t>(x + (1 << 23) - 1));
  }
  EXPECT_LT(worst, 1e-7);
}

}  // namespace
}  // namespace tumblesight::gnc
