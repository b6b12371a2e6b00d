// Verifies TS-TRN-020.
// Scales of a layer with two inputs and one channel, for which the best choice is known.
#include "sim/quantization/scales.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace tumblesight::sim {
namespace {

class ScalesTest : public ::testing::Test {
 protected:
  ScalesTest() {
    layer = {"layer", 1, {}, {1.0, 1.0}, bias.data()};
    add_rows(layer, weights.data(), 2);
    for (int i = 0; i < 100; ++i) inputs.add({i % 2 == 0 ? 1.0 : -1.0, i % 4 < 2 ? 1.0 : -1.0});
  }

  std::array<float, 2> weights{1.0F, -0.25F};
  std::array<float, 1> bias{0.0F};
  FloatLayer layer;
  InputStatistics inputs{2};
};

TEST_F(ScalesTest, ThatFitHoldTheLargestObservedOutput) {
  Distribution outputs;
  outputs.add(1000.0);
  const OutputScales scales = scales_that_fit(layer, {outputs}, 16'383.5);
  EXPECT_DOUBLE_EQ(scales.sum[0], 1.0 / 127.0);
  EXPECT_LE(1000.0 / std::ldexp(scales.sum[0], scales.shift[0]), 16'383.5);
}

// Regression, found on the shipped NEAR model: a few bright frames cost all others two of eight bits.
TEST_F(ScalesTest, OfLeastLossLetARareLargeOutputSaturate) {
  Distribution outputs;
  for (int i = 0; i < 1'000'000; ++i) outputs.add(i * 1e-5);
  outputs.add(30.0);
  const OutputScales scales = scales_of_least_loss(layer, inputs, {outputs}, 255.0);
  const double last = 255.0 * std::ldexp(scales.sum[0], scales.shift[0]);
  EXPECT_NEAR(last, 13.2, 1.0);  // where d/dT of T^2 / (12 * 255^2) and of 1e-6 * (30 - T)^2 cancel
  EXPECT_LE(largest_weight(layer, 0) / scales.sum[0], kLargestWeight + 1e-9);
}

TEST_F(ScalesTest, OfLeastLossUseTheWholeRangeIfWeightsMayBeCoarse) {
  inputs = InputStatistics(2);  // hardly any input, so weights may be coarse
  for (int i = 0; i < 100; ++i) inputs.add({i % 2 == 0 ? 1e-6 : -1e-6, 0.0});
  for (const double largest : {10.0, 13.0, 16.0, 19.0}) {
    Distribution outputs;
    for (int i = 0; i < 100'000; ++i) outputs.add(largest * i * 1e-5);
    const OutputScales scales = scales_of_least_loss(layer, inputs, {outputs}, 255.0);
    EXPECT_NEAR(255.0 * std::ldexp(scales.sum[0], scales.shift[0]), largest, 0.08 * largest);
  }
}

TEST_F(ScalesTest, ArePowersOfTwoThatHoldTheLargestWeightUnlessSaturationLosesLess) {
  const std::vector<double> scales = powers_of_two(layer, inputs);
  EXPECT_DOUBLE_EQ(scales[0], 1.0 / 64.0);  // with 1/128 the largest weight would be 128, one too large

  weights = {1.0F, 0.3F};
  InputStatistics second_only(2);  // the first input is constant: its weight may saturate
  for (int i = 0; i < 100; ++i) second_only.add({1.0, i % 2 == 0 ? 1.0 : -1.0});
  EXPECT_LT(powers_of_two(layer, second_only)[0], 1.0 / 64.0);
}

}  // namespace
}  // namespace tumblesight::sim
