// Verifies TS-TRN-020.
// Loss by rounding and saturation, compared with closed forms.
#include "sim/quantization/statistics.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

TEST(Distribution, LosesATwelfthOfTheSquaredUnitIfUniform) {
  Distribution even;
  for (int i = 1; i <= 10'000; ++i) even.add(i * 1e-4);
  const double unit = 1.0 / 255.0;
  EXPECT_NEAR(even.squared_loss(unit, 255.0), unit * unit / 12.0, 0.02 * unit * unit);
}

TEST(Distribution, LosesTheSquaredExcessBeyondTheLargestInteger) {
  Distribution two;
  two.add(0.0);
  two.add(8.0);
  EXPECT_NEAR(two.squared_loss(0.01, 500.0), 0.5 * 3.0 * 3.0,
              0.5 * 0.6);  // 0 stays, 8 becomes 5; bins of 2 %
  EXPECT_EQ(two.largest(), 8.0);
}

TEST(Distribution, LosesNothingIfAllValuesAreZero) {
  Distribution zeros;
  EXPECT_EQ(zeros.squared_loss(1.0, 255.0), 0.0);
  zeros.add(0.0);
  EXPECT_EQ(zeros.squared_loss(1.0, 255.0), 0.0);
}

}  // namespace
}  // namespace tumblesight::sim
