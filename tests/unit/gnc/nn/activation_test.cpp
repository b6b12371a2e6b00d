// Verifies TS-NUM-060. In float32.
#include "gnc/nn/activation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/trials.hpp"

namespace tumblesight::gnc {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// 4 million arguments over +-bound, and every power of two with both signs.
std::vector<float> dense_sweep(float bound) {
  std::vector<float> x;
  constexpr int kSteps = trials(2'000'000);
  x.reserve(2 * kSteps + 1000);
  for (int i = -kSteps; i <= kSteps; ++i) x.push_back(bound * static_cast<float>(i) / kSteps);
  for (int e = -148; e <= 127; ++e) {
    for (const float sign : {1.0F, -1.0F}) {
      const float value = sign * std::ldexp(1.0F, e);
      if (std::fabs(value) <= bound) x.push_back(value);
    }
  }
  return x;
}

TEST(Exp, RelativeErrorIsBelow2em7WithinItsBounds) {
  const std::vector<float> x = dense_sweep(kExpArgumentBound);
  std::vector<float> y(x.size());
  exp(x.data(), y.data(), static_cast<int>(x.size()));
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double exact = std::exp(static_cast<double>(x[i]));
    worst = std::max(worst, std::fabs(y[i] - exact) / exact);
  }
  EXPECT_LT(worst, 2e-7);
}

TEST(Sigmoid, AbsoluteErrorIsBelow1p5em7) {
  double worst = 0.0;
  for (const float bound : {1.0F, 20.0F, 200.0F, 3e38F}) {
    const std::vector<float> x = dense_sweep(bound);
    std::vector<float> y(x.size());
    sigmoid(x.data(), y.data(), static_cast<int>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::fabs(y[i] - 1.0 / (1.0 + std::exp(-static_cast<double>(x[i])))));
    }
  }
  EXPECT_LT(worst, 1.5e-7);
}

TEST(Tanh, AbsoluteErrorIsBelow3em7) {
  double worst = 0.0;
  for (const float bound : {0.01F, 1.0F, 20.0F, 3e38F}) {
    const std::vector<float> x = dense_sweep(bound);
    std::vector<float> y(x.size());
    tanh(x.data(), y.data(), static_cast<int>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::fabs(y[i] - std::tanh(static_cast<double>(x[i]))));
      ASSERT_LE(std::fabs(y[i]), 1.0F) << x[i];
    }
  }
  EXPECT_LT(worst, 3e-7);
}

TEST(Activations, AreExactAtZeroAndSaturateAtTheEnds) {
  const std::array<float, 5> x{0.0F, kInfinity, -kInfinity, 3e38F, -3e38F};
  std::array<float, 5> y{};
  sigmoid(x.data(), y.data(), 5);
  EXPECT_EQ(y[0], 0.5F);
  EXPECT_EQ(y[1], 1.0F);
  EXPECT_LT(y[2], 1e-37F);
  EXPECT_EQ(y[1], y[3]);
  EXPECT_EQ(y[2], y[4]);
  tanh(x.data(), y.data(), 5);
  EXPECT_EQ(y, (std::array<float, 5>{0.0F, 1.0F, -1.0F, 1.0F, -1.0F}));
  exp(x.data(), y.data(), 1);
  EXPECT_EQ(y[0], 1.0F);
}

TEST(Activations, StayFiniteAndBoundedForNanAndInfinity) {
  for (const float bad : {kNan, -kNan, kInfinity, -kInfinity}) {
    std::array<float, 1> y{bad};
    exp(y.data(), y.data(), 1);
    EXPECT_EQ(exp(bad), y[0]);
    EXPECT_TRUE(std::isnormal(y[0]) && y[0] > 0.0F);
    EXPECT_TRUE(sigmoid(bad) >= 0.0F && sigmoid(bad) <= 1.0F);
    y[0] = bad;
    tanh(y.data(), y.data(), 1);
    EXPECT_LE(std::fabs(y[0]), 1.0F);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
