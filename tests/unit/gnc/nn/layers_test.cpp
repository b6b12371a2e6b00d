#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gnc/nn/conv_block.hpp"
#include "gnc/nn/dense.hpp"
#include "tests/unit/gnc/nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

template <class N, int kSide, int kIn, int kOut>
struct BlockRun {
  using Block = ConvBlock<N, kSide, kIn, kOut>;
  typename Block::Weights weights;
  typename Block::Input in{};
  typename Block::Sums sums{};
  typename Block::MaxPooled largest;
  typename Block::AveragePooled mean;
  std::vector<std::int8_t> storage;  // of the fixed-point weights

  explicit BlockRun(unsigned seed) {
    RandomValues random(seed);
    if constexpr (N::kIsInteger) {
      storage = random.vector<std::int8_t>(Block::kWeights);
      weights.weight.set_data(storage.data());
      for (auto& bias : weights.bias) bias = random.next<std::int16_t>();
      weights.shift.fill(9);
    } else {
      random.fill(weights.weight);
      random.fill(weights.bias);
    }
    for (int y = 0; y < kSide; ++y) {
      for (int i = 0; i < kSide * kIn; ++i) in.row(y)[i] = random.next<ConvInput<N>>();
    }
    random.fill(sums);  // the contents of the scratch memory must not matter
    random.fill(largest.values);
  }
  void forward() {
    Block::forward(fastest_kernels<N>(), weights, in, sums, largest);
    Block::forward(fastest_kernels<N>(), weights, in, sums, mean);
  }

  // One convolution sum by definition.
  double sum(int y, int x, int out) {
    double total = weights.bias[out];
    for (int tap = 0; tap < 9; ++tap) {
      const int from_y = y + tap / 3 - 1, from_x = x + tap % 3 - 1;
      if (from_y < 0 || from_y >= kSide || from_x < 0 || from_x >= kSide) continue;
      for (int i = 0; i < kIn; ++i) {
        constexpr int kGroup = N::ConvProduct::kGroup;
        const int index = tap * kIn + i;
        const int weight = (index / kGroup * kOut + out) * kGroup + index % kGroup;
        total += static_cast<double>(in.row(from_y)[from_x * kIn + i]) * weights.weight.data()[weight];
      }
    }
    return total;
  }
  double activated(double total, double largest_integer) const {
    if (!N::kIsInteger) return std::max(0.0, total);
    return std::min(largest_integer, std::max(0.0, std::floor(std::ldexp(total, -9) + 0.5)));
  }
};

template <class N>
void expect_block_by_definition(double tolerance) {
  constexpr int kSide = 9, kIn = 4, kOut = 48;  // an odd side: the last row and column fill no pooling window
  auto run = std::make_unique<BlockRun<N, kSide, kIn, kOut>>(1);
  run->forward();
  for (int y = 0; y < kSide / 2; ++y) {
    for (int x = 0; x < kSide / 2; ++x) {
      for (int c = 0; c < kOut; ++c) {
        const double four[] = {run->sum(2 * y, 2 * x, c), run->sum(2 * y, 2 * x + 1, c),
                               run->sum(2 * y + 1, 2 * x, c), run->sum(2 * y + 1, 2 * x + 1, c)};
        const double largest = run->activated(*std::max_element(four, four + 4), 255.0);
        ASSERT_NEAR(run->largest.row(y)[x * kOut + c], largest, tolerance) << y << ' ' << x << ' ' << c;
        double total = 0.0;
        for (const double value : four) total += run->activated(value, kMaxAveragedActivation);
        ASSERT_NEAR(run->mean[(y * (kSide / 2) + x) * kOut + c], N::kIsInteger ? total : total / 4.0,
                    tolerance);
      }
    }
  }
  // The border of zeros that the next convolution needs.
  for (int i = 0; i < run->largest.kRow; ++i) EXPECT_EQ(run->largest.values[i], 0);
  EXPECT_EQ(run->largest.row(1)[-1], 0);
}

// Verifies TS-NUM-090.
TEST(ConvBlock, Float32MatchesItsDefinition) {
  expect_block_by_definition<Float32>(2e-5);
}
// Verifies TS-NUM-050.
TEST(ConvBlock, FixedPointMatchesItsDefinitionExactly) {
  expect_block_by_definition<FixedPoint>(0.0);
}

// Verifies TS-NUM-090.
TEST(Dense, Float32MatchesANaiveDoubleProduct) {
  using Layer = Dense<Float32, 131, 57>;
  auto weights = std::make_unique<Layer::Weights>();
  Layer::Input in;
  Layer::Sums sums;
  Layer::Output out;
  Layer::Hidden hidden;
  RandomValues random(3);
  random.fill(weights->weight);
  random.fill(weights->bias);
  random.fill(in);
  Layer::output(fastest_kernels<Float32>(), *weights, in, sums, out);
  Layer::hidden(fastest_kernels<Float32>(), *weights, in, sums, hidden);
  for (int o = 0; o < 57; ++o) {
    double sum = weights->bias[o];
    for (int i = 0; i < 131; ++i) sum += static_cast<double>(in[i]) * weights->weight[i * 57 + o];
    EXPECT_NEAR(out[o], sum, 5e-6);
    EXPECT_NEAR(hidden[o], std::max(0.0, sum), 5e-6);
  }
}

// Verifies TS-NUM-050.
TEST(Dense, FixedPointRequantizesHiddenValuesAndScalesOutputs) {
  using Layer = Dense<FixedPoint, 130, 57>;
  auto weights = std::make_unique<Layer::Weights>();
  RandomValues random(4);
  const auto storage = random.vector<std::int8_t>(130 * 64);
  weights->weight.set_data(storage.data());
  for (auto& bias : weights->bias) bias = random.next<std::int16_t>();
  weights->shift.fill(14);
  Layer::Input in;
  random.fill(in);
  Layer::Sums sums;
  Layer::Output out;
  Layer::Hidden hidden;
  Layer::output(fastest_kernels<FixedPoint>(), *weights, in, sums, out);
  Layer::hidden(fastest_kernels<FixedPoint>(), *weights, in, sums, hidden);
  for (int o = 0; o < 57; ++o) {
    double sum = weights->bias[o];
    for (int i = 0; i < 130; ++i) sum += in[i] * storage[(i / 2 * 64 + o) * 2 + i % 2];
    const double scaled = std::ldexp(sum, -14);
    EXPECT_EQ(hidden[o], std::min(32767.0, std::max(0.0, std::floor(scaled + 0.5))));
    EXPECT_NEAR(std::ldexp(static_cast<double>(out[o].raw()), -24), std::min(128.0, std::max(-128.0, scaled)),
                1e-7);
  }
}

// Verifies TS-NUM-050.
TEST(Requantization, RoundsOnceToTheNearestHalvesUp) {
  EXPECT_EQ(requantize(5, 1), 3);
  EXPECT_EQ(requantize(-5, 1), -2);
  EXPECT_EQ(requantize(7, 3), 1);
  EXPECT_EQ(requantize(3, 3), 0);
  EXPECT_EQ(requantize(4, 3), 1);
  EXPECT_EQ(requantize(-4, 3), 0);
  EXPECT_EQ(requantize(INT32_MAX - (1 << 29), 30), 1);
  std::int16_t input = 0;
  to_input(Fixed(1.0), input);
  EXPECT_EQ(input, 32767);
  to_input(Fixed(-128.0), input);
  EXPECT_EQ(input, -32767);
  to_input(Fixed(0.5), Fixed(-0.5), input);
  EXPECT_EQ(input, -8192);
}

}  // namespace
}  // namespace tumblesight::gnc
