#include "gnc/nn/lstm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "tests/unit/gnc/nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

double exact_sigmoid(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

TEST(Lstm, OneUnitStepAgreesWithTheEquationsWorkedByHand) {
  using Layer = Lstm<Float32, 1, 1>;
  Layer::Weights weights;
  weights.weight = {0.5F, -1.0F, 2.0F, 0.25F};  // i, f, g, o
  weights.recurrent = {1.0F, 0.5F, -0.5F, 2.0F};
  weights.bias = {0.1F, 0.2F, 0.3F, 0.4F};
  Layer::State state;
  state.h[0] = 0.5F;
  state.c[0] = -0.75F;
  Layer::Sums gates;
  Layer::forward(fastest_kernels<Float32>(), weights, {2.0F}, gates, state);
  const double i = exact_sigmoid(0.1 + 1.0 + 0.5);
  const double f = exact_sigmoid(0.2 - 2.0 + 0.25);
  const double g = std::tanh(0.3 + 4.0 - 0.25);
  const double o = exact_sigmoid(0.4 + 0.5 + 1.0);
  const double c = f * -0.75 + i * g;
  EXPECT_NEAR(state.c[0], c, 5e-7);
  EXPECT_NEAR(state.h[0], o * std::tanh(c), 5e-7);
}

// Verifies TS-NUM-090.
TEST(Lstm, TwentyStepsFollowADoubleImplementation) {
  constexpr int kIn = 11, kHidden = 24, kGates = 4 * kHidden;
  using Layer = Lstm<Float32, kIn, kHidden>;
  auto weights = std::make_unique<Layer::Weights>();
  RandomValues random(6);
  random.fill(weights->weight);
  random.fill(weights->recurrent);
  random.fill(weights->bias);
  Layer::State state;
  Layer::Sums gates;
  std::array<double, kHidden> h{}, c{};
  for (int step = 0; step < 20; ++step) {
    Layer::Input in;
    random.fill(in);
    Layer::forward(fastest_kernels<Float32>(), *weights, in, gates, state);
    std::array<double, kGates> z{};
    for (int k = 0; k < kGates; ++k) {
      z[k] = weights->bias[k];
      for (int i = 0; i < kIn; ++i) z[k] += static_cast<double>(in[i]) * weights->weight[i * kGates + k];
      for (int i = 0; i < kHidden; ++i) z[k] += h[i] * weights->recurrent[i * kGates + k];
    }
    for (int i = 0; i < kHidden; ++i) {
      c[i] = exact_sigmoid(z[kHidden + i]) * c[i] + exact_sigmoid(z[i]) * std::tanh(z[2 * kHidden + i]);
      h[i] = exact_sigmoid(z[3 * kHidden + i]) * std::tanh(c[i]);
      ASSERT_NEAR(state.c[i], c[i], 1e-5) << "step " << step;
      ASSERT_NEAR(state.h[i], h[i], 1e-5) << "step " << step;
    }
  }
}

// Verifies TS-EST-170.
TEST(Lstm, StateStaysBoundedForAnyPreActivationAndAnyCellLeftByABitFlip) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float gate : {nan, infinity, -infinity, 1e30F, 0.0F}) {
    for (const float cell : {nan, infinity, -infinity, 3e38F, 0.0F}) {
      std::array<float, 4> gates{gate, gate, gate, gate};
      float h = nan;
      float c = cell;
      lstm_update(gates.data(), nullptr, 1, &h, &c);
      EXPECT_LE(std::fabs(h), 1.0F) << gate << " " << cell;
      EXPECT_LE(std::fabs(c), kLstmCellBound) << gate << " " << cell;
    }
  }
}

// Verifies TS-NUM-060.
TEST(FixedPointGates, AreWithinTheirStatedErrorOfTheExactFunctions) {
  double worst_sigmoid = 0.0, worst_tanh = 0.0;
  for (std::int64_t raw = -Fixed::kLargestRaw; raw <= Fixed::kLargestRaw; raw += 10'007) {
    const Fixed x = Fixed::from_raw(raw);
    const double exact = std::ldexp(static_cast<double>(raw), -24);
    const double s = std::ldexp(static_cast<double>(gate_sigmoid(x).raw()), -24);
    const double t = std::ldexp(static_cast<double>(gate_tanh(x).raw()), -24);
    worst_sigmoid = std::max(worst_sigmoid, std::fabs(s - exact_sigmoid(exact)));
    worst_tanh = std::max(worst_tanh, std::fabs(t - std::tanh(exact)));
    ASSERT_TRUE(std::fabs(s) <= 1.0 && std::fabs(t) <= 1.0);
  }
  EXPECT_LT(worst_sigmoid, 1.3e-5);
  EXPECT_LT(worst_tanh, 2.6e-5);
  EXPECT_EQ(gate_sigmoid(Fixed()), Fixed(0.5));
  EXPECT_EQ(gate_tanh(Fixed()), Fixed());
}

TEST(FixedPointLstm, FollowsADoubleImplementationOfItsOwnIntegers) {
  constexpr int kIn = 10, kHidden = 16, kGates = 4 * kHidden, kShift = 21;
  using Layer = Lstm<FixedPoint, kIn, kHidden>;
  std::mt19937 engine(9);
  std::uniform_int_distribution<int> weight(-127, 127), input(-32767, 32767);
  std::vector<std::int8_t> forward(kIn * kGates), recurrent(kHidden * kGates);
  for (std::int8_t& w : forward) w = static_cast<std::int8_t>(weight(engine));
  for (std::int8_t& w : recurrent) w = static_cast<std::int8_t>(weight(engine));
  Layer::Weights weights;
  weights.weight.set_data(forward.data());
  weights.recurrent.set_data(recurrent.data());
  for (std::int32_t& bias : weights.bias) bias = 100 * weight(engine);
  weights.shift.fill(kShift);
  Layer::State state;
  Layer::Sums sums;
  std::array<double, kHidden> h{}, c{};
  for (int step = 0; step < 20; ++step) {
    Layer::Input in;
    for (std::int16_t& x : in) x = static_cast<std::int16_t>(input(engine));
    Layer::forward(fastest_kernels<FixedPoint>(), weights, in, sums, state);
    std::array<double, kGates> z{};
    for (int k = 0; k < kGates; ++k) {
      z[k] = weights.bias[k];
      for (int i = 0; i < kIn; ++i) z[k] += in[i] * forward[(i / 2 * kGates + k) * 2 + i % 2];
      for (int i = 0; i < kHidden; ++i) z[k] += 32768.0 * h[i] * recurrent[(i / 2 * kGates + k) * 2 + i % 2];
      z[k] = std::ldexp(z[k], -kShift);
    }
    for (int i = 0; i < kHidden; ++i) {
      c[i] = exact_sigmoid(z[kHidden + i]) * c[i] + exact_sigmoid(z[i]) * std::tanh(z[2 * kHidden + i]);
      h[i] = exact_sigmoid(z[3 * kHidden + i]) * std::tanh(c[i]);
      ASSERT_NEAR(std::ldexp(static_cast<double>(state.c[i].raw()), -24), c[i], 2e-3) << "step " << step;
      ASSERT_NEAR(state.h[i] / 32768.0, h[i], 2e-3) << "step " << step;
    }
  }
}

// Verifies TS-EST-170.
TEST(FixedPointLstm, StateStaysBoundedForAnySumAndAnyCellLeftByABitFlip) {
  for (const std::int32_t sum : {INT32_MAX, -INT32_MAX - 1, 0}) {
    for (const std::int32_t cell : {Fixed::kLargestRaw, -Fixed::kLargestRaw, 0}) {
      for (const std::uint8_t shift : {std::uint8_t{1}, std::uint8_t{24}, std::uint8_t{62}}) {
        const std::array<std::int32_t, 4> gates{sum, sum, sum, sum};
        const std::array<std::uint8_t, 4> shifts{shift, shift, shift, shift};
        std::int16_t h = 0;
        Fixed c = Fixed::from_raw(cell);
        lstm_update(gates.data(), shifts.data(), 1, &h, &c);
        EXPECT_TRUE(h >= -32767 && !(c > Fixed(64.0)) && !(c < Fixed(-64.0)));
      }
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
