// Verifies TS-FDIR-170.
#include "gnc/tracking/frame_signature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumblesight::gnc {
namespace {

// A square of `side` returns somewhere in a frame, with the noise of `seed`.
RangeImage square(int rays, int side, int at, unsigned seed) {
  std::mt19937 engine(seed);
  RangeImage frame;
  frame.rays = static_cast<std::uint16_t>(rays);
  for (int row = at; row < at + side; ++row)
    for (int column = at; column < at + side; ++column)
      frame.ranges[static_cast<std::size_t>(row * rays + column)] =
          static_cast<std::uint16_t>(6400 + engine() % 16);
  return frame;
}

int cells_with_returns(const RangeImage& frame) {
  int count = 0;
  for (const std::uint8_t cell : signature_of(frame)) count += cell != 0 ? 1 : 0;
  return count;
}

TEST(FrameSignature, ATargetFillsTheCellsWhereverItIs) {
  for (const int rays : {20, 32, 64, 100, 128}) {
    for (const int side : {1, 4, 15, 16}) {
      for (int at = 0; at + side <= rays; at += 3)
        EXPECT_EQ(cells_with_returns(square(rays, side, at, 1)), side * side);
    }
    EXPECT_EQ(cells_with_returns(square(rays, rays, 0, 1)), 256);
  }
}

TEST(FrameSignature, IsTheLowBitsOfTheFirstReturnOfACell) {
  RangeImage frame;
  frame.rays = 64;
  EXPECT_EQ(signature_of(frame), FrameSignature{});
  frame.ranges[64 * 35 + 20] = 0xFF80;  // row 3, column 4 of the cells
  FrameSignature expected{};
  expected[3 * 16 + 4] = 0x80;
  EXPECT_EQ(signature_of(frame), expected);
  frame.ranges[64 * 19 + 52] = 0x0185;
  expected[3 * 16 + 4] = 0x85;
  EXPECT_EQ(signature_of(frame), expected) << "the earlier row decides";
  frame.rays = UINT16_MAX;
  EXPECT_NE(signature_of(frame), FrameSignature{}) << "and does not read beyond the frame";
}

TEST(FrameSignature, RepeatsIfThreeQuartersOfTheCellsWithAReturnAreEqual) {
  FrameSignature a{};
  EXPECT_FALSE(is_repetition(a, a)) << "no return";
  for (const int returns : {1, 2, 3, 4, 100, 256}) {
    a = {};
    for (int i = 0; i < returns; ++i)
      a[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(0x80 | i % 128);
    for (int different = 0; different <= returns; ++different) {
      for (const bool lost : {false, true}) {
        FrameSignature b = a;
        for (int i = 0; i < different; ++i) {
          std::uint8_t& cell = b[static_cast<std::size_t>(returns - 1 - i)];
          cell = static_cast<std::uint8_t>(lost ? 0 : cell ^ 1);
        }
        EXPECT_EQ(is_repetition(a, b), 4 * different <= returns) << returns << ' ' << different;
        EXPECT_EQ(is_repetition(b, a), 4 * different <= returns);
      }
    }
  }
}

TEST(FrameSignature, NoiseOfACountMakesFramesOfOneSceneDifferent) {
  std::mt19937 engine(3);
  for (const double sigma_counts : {0.5, 1.0, 3.0}) {
    std::normal_distribution<double> noise(0.0, sigma_counts);
    for (int pair = 0; pair < 200; ++pair) {
      RangeImage a = square(100, 16, 40, 1), b = a;
      for (RangeImage* frame : {&a, &b})
        for (std::uint16_t& range : frame->ranges)
          if (range != 0) range = static_cast<std::uint16_t>(std::lround(range + noise(engine)));
      EXPECT_FALSE(is_repetition(signature_of(a), signature_of(b)));
    }
  }
}

TEST(FrameRepetition, ComparesPairsOfNeighbouringRays) {
  for (const int rays : {16, 17, 33, 128}) {
    for (const int side : {4, 12, 16}) {
      const RangeImage a = square(rays, side, 0, 1);
      EXPECT_TRUE(is_repetition(a, a));
      EXPECT_FALSE(is_repetition(a, square(rays, side, 0, 2)));
      RangeImage b = a;
      for (int row = 0; row < side / 2 - 1; ++row) b.ranges[static_cast<std::size_t>(row * rays)] ^= 1;
      EXPECT_TRUE(is_repetition(a, b)) << "a few flicker";
      b.rays = static_cast<std::uint16_t>(rays - 1);
      EXPECT_FALSE(is_repetition(a, b));
    }
  }
  EXPECT_FALSE(is_repetition(square(128, 128, 0, 1), square(128, 128, 0, 2))) << "more than 512 pairs";
  RangeImage none;
  none.rays = 32;
  EXPECT_FALSE(is_repetition(none, none)) << "no return";
  none.rays = UINT16_MAX;
  EXPECT_FALSE(is_repetition(none, none)) << "and does not read beyond the frame";
}

TEST(FrameRepetition, NoiseOfACountMakesFramesOfOneSceneDifferent) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0.0, 0.5);
  for (int pair = 0; pair < 200; ++pair) {
    RangeImage a = square(100, 16, 40, 1), b = a;
    for (RangeImage* frame : {&a, &b})
      for (std::uint16_t& range : frame->ranges)
        if (range != 0) range = static_cast<std::uint16_t>(std::lround(range + noise(engine)));
    EXPECT_FALSE(is_repetition(a, b));
  }
}

}  // namespace
}  // namespace tumblesight::gnc
