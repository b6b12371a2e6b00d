#include "gnc/nn/lstm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tests/unit/gnc_nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

double exact_sigmoid(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

TEST(Lstm, OneUnitStepAgreesWithTheEquationsWorkedByHand) {
  using Layer = Lstm<1, 1>;
  Layer::Weights weights;
  weights.input = {0.5F, -1.0F, 2.0F, 0.25F};  // i, f, g, o
  weights.recurrent = {1.0F, 0.5F, -0.5F, 2.0F};
  weights.bias = {0.1F, 0.2F, 0.3F, 0.4F};
  Layer::State state;
  state.h[0] = 0.5F;
  state.c[0] = -0.75F;
  Layer::Gates gates;
  Layer::forward(weights, {2.0F}, gates, state);
  const double i = exact_sigmoid(0.1 + 1.0 + 0.5);
  const double f = exact_sigmoid(0.2 - 2.0 + 0.25);
  const double g = std::tanh(0.3 + 4.0 - 0.25);
  const double o = exact_sigmoid(0.4 + 0.5 + 1.0);
  const double c = f * -0.75 + i * g;
  EXPECT_NEAR(state.c[0], c, 5e-7);
  EXPECT_NEAR(state.h[0], o * std::tanh(c), 5e-7);
}

TEST(Lstm, TwentyStepsFollowADoubleImplementation) {
  constexpr int kIn = 11, kHidden = 24, kGates = 4 * kHidden;
  using Layer = Lstm<kIn, kHidden>;
  auto weights = std::make_unique<Layer::Weights>();
  RandomValues random(6);
  random.fill(weights->input);
  random.fill(weights->recurrent);
  random.fill(weights->bias);
  Layer::State state;
  Layer::Gates gates;
  std::array<double, kHidden> h{}, c{};
  for (int step = 0; step < 20; ++step) {
    Layer::Input in;
    random.fill(in);
    Layer::forward(*weights, in, gates, state);
    std::array<double, kGates> z{};
    for (int k = 0; k < kGates; ++k) {
      z[k] = weights->bias[k];
      for (int i = 0; i < kIn; ++i) z[k] += static_cast<double>(in[i]) * weights->input[i * kGates + k];
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

TEST(Lstm, StateStaysBoundedForAnyPreActivationAndAnyCellLeftByABitFlip) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float gate : {nan, infinity, -infinity, 1e30F, 0.0F}) {
    for (const float cell : {nan, infinity, -infinity, 3e38F, 0.0F}) {
      std::array<float, 4> gates{gate, gate, gate, gate};
      float h = nan;
      float c = cell;
      lstm_update(gates.data(), 1, &h, &c);
      EXPECT_LE(std::fabs(h), 1.0F) << gate << " " << cell;
      EXPECT_LE(std::fabs(c), kLstmCellBound) << gate << " " << cell;
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
