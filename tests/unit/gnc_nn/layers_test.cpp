#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "gnc/nn/conv3x3.hpp"
#include "gnc/nn/dense.hpp"
#include "gnc/nn/pooling.hpp"
#include "gnc/nn/space_to_depth.hpp"
#include "tests/unit/gnc_nn/random_values.hpp"

namespace tumblesight::gnc {
namespace {

template <class Layer>
struct ConvRun {
  typename Layer::Weights weights;
  typename Layer::Input in{};
  typename Layer::Padded padded{};
  typename Layer::Output out{};
  void forward() { Layer::forward(weights, in, padded, out); }
};

TEST(Conv3x3, MatchesANaiveDoubleConvolution) {
  constexpr int kSide = 9, kIn = 5, kOut = 70;
  auto run = std::make_unique<ConvRun<Conv3x3<kSide, kIn, kOut>>>();
  RandomValues random(1);
  random.fill(run->weights.weight);
  random.fill(run->weights.bias);
  random.fill(run->in);
  random.fill(run->padded);  // what lay in the scratch must not matter
  run->forward();
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int o = 0; o < kOut; ++o) {
        double sum = run->weights.bias[o];
        for (int ky = -1; ky <= 1; ++ky) {
          for (int kx = -1; kx <= 1; ++kx) {
            if (y + ky < 0 || y + ky >= kSide || x + kx < 0 || x + kx >= kSide) continue;
            for (int i = 0; i < kIn; ++i) {
              sum += static_cast<double>(run->in[((y + ky) * kSide + x + kx) * kIn + i]) *
                     run->weights.weight[(((ky + 1) * 3 + kx + 1) * kIn + i) * kOut + o];
            }
          }
        }
        ASSERT_NEAR(run->out[(y * kSide + x) * kOut + o], sum, 2e-6) << y << "," << x << "," << o;
      }
    }
  }
}

TEST(Conv3x3, IdentityKernelCopiesTheImageExactly) {
  auto run = std::make_unique<ConvRun<Conv3x3<7, 2, 2>>>();
  RandomValues(2).fill(run->in);
  for (int c = 0; c < 2; ++c) run->weights.weight[(4 * 2 + c) * 2 + c] = 1.0F;  // centre tap
  run->forward();
  EXPECT_EQ(run->out, run->in);
}

TEST(Conv3x3, ADeltaShowsTheKernelTurnedRoundAndClippedAtTheBorder) {
  auto run = std::make_unique<ConvRun<Conv3x3<4, 1, 1>>>();
  for (int k = 0; k < 9; ++k) run->weights.weight[k] = static_cast<float>(k + 1);
  run->in[1 * 4 + 2] = 1.0F;
  run->forward();
  EXPECT_EQ(run->out, (std::array<float, 16>{0, 9, 8, 7,  //
                                             0, 6, 5, 4,  //
                                             0, 3, 2, 1,  //
                                             0, 0, 0, 0}));
  run->in.fill(0.0F);
  run->in[0] = 1.0F;
  run->forward();
  EXPECT_EQ(run->out, (std::array<float, 16>{5, 4, 0, 0,  //
                                             2, 1, 0, 0,  //
                                             0, 0, 0, 0,  //
                                             0, 0, 0, 0}));
}

TEST(Dense, MatchesANaiveDoubleProduct) {
  using Layer = Dense<131, 57>;
  auto weights = std::make_unique<Layer::Weights>();
  Layer::Input in;
  Layer::Output out;
  RandomValues random(3);
  random.fill(weights->weight);
  random.fill(weights->bias);
  random.fill(in);
  Layer::forward(*weights, in, out);
  for (int o = 0; o < 57; ++o) {
    double sum = weights->bias[o];
    for (int i = 0; i < 131; ++i) sum += static_cast<double>(in[i]) * weights->weight[i * 57 + o];
    EXPECT_NEAR(out[o], sum, 5e-6);
  }
}

TEST(MaxPool2x2, LeavesOutTheLastRowAndColumnOfAnOddSide) {
  using Layer = MaxPool2x2<5, 1>;
  Layer::Input in;
  for (int i = 0; i < 25; ++i) in[i] = static_cast<float>(i);
  in[24] = in[4] = in[20] = 1000.0F;
  in[0] = 500.0F;
  Layer::Output out;
  Layer::forward(in, out);
  EXPECT_EQ(out, (Layer::Output{500.0F, 8.0F, 16.0F, 18.0F}));
}

TEST(MaxPool2x2, TakesTheLargestOfTheFourPixelsInEveryChannel) {
  using Layer = MaxPool2x2<6, 7>;
  Layer::Input in;
  RandomValues(4).fill(in);
  for (float& v : in) v -= 2.0F;  // all negative: zero must not win
  Layer::Output out;
  Layer::forward(in, out);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      for (int c = 0; c < 7; ++c) {
        const auto at = [&](int dy, int dx) { return in[((2 * y + dy) * 6 + 2 * x + dx) * 7 + c]; };
        EXPECT_EQ(out[(y * 3 + x) * 7 + c], std::max({at(0, 0), at(0, 1), at(1, 0), at(1, 1)}));
      }
    }
  }
}

TEST(AveragePool, TakesTheMeanOfEveryWholeWindow) {
  using Layer = AveragePool<5, 2, 2>;
  Layer::Input in;
  for (int i = 0; i < 25; ++i) {
    in[2 * i] = static_cast<float>(i);
    in[2 * i + 1] = static_cast<float>(-2 * i);
  }
  Layer::Output out;
  Layer::forward(in, out);
  EXPECT_EQ(out, (Layer::Output{3, -6, 5, -10, 13, -26, 15, -30}));
}

TEST(AveragePool, OfTheWholeImageIsTheMeanOfEveryChannel) {
  using Layer = GlobalAveragePool<6, 3>;
  Layer::Input in;
  RandomValues(5).fill(in);
  Layer::Output out;
  Layer::forward(in, out);
  for (int c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (int i = 0; i < 36; ++i) sum += in[3 * i + c];
    EXPECT_NEAR(out[c], sum / 36.0, 1e-6);
  }
}

TEST(SpaceToDepth, PutsRowParityBeforeColumnParity) {
  using Layer = SpaceToDepth<4>;
  Layer::Input in;
  for (int i = 0; i < 16; ++i) in[i] = static_cast<float>(i);
  Layer::Output out;
  Layer::forward(in, out);
  EXPECT_EQ(out, (Layer::Output{0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15}));
}

}  // namespace
}  // namespace tumblesight::gnc
