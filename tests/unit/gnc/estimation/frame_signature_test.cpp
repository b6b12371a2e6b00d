// Verifies TS-FDIR-170.
#include "gnc/estimation/frame_signature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

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
  frame.ranges[64 * 35 + 20] = 0x7F80;  // row 3, column 4 of the cells
  FrameSignature expected{};
  expected[3 * 16 + 4] = 0x80;
  EXPECT_EQ(signature_of(frame), expected);
  frame.ranges[64 * 19 + 52] = 0x1585;
  expected[3 * 16 + 4] = 0x85;
  EXPECT_EQ(signature_of(frame), expected) << "the earlier row decides";
  frame.rays = UINT16_MAX;
  EXPECT_NE(signature_of(frame), FrameSignature{}) << "and does not read beyond the frame";
}

TEST(FrameSignature, RepeatsIfHalfOfTheCellsWithAReturnAreEqual) {
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
        EXPECT_EQ(is_repetition(a, b), 2 * different <= returns) << returns << ' ' << different;
        EXPECT_EQ(is_repetition(b, a), 2 * different <= returns);
      }
    }
  }
}

TEST(FrameSignature, NoiseOfACountMakesFramesOfOneSceneDifferent) {
  std::mt19937 engine(3);
  for (const double sigma_counts : {1.0, 3.0}) {
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

// Cells that are filled by rays of the start have the value of the whole signature.
TEST(SignatureStart, IsTheFirstCellsOfTheSignature) {
  for (const int rays : {16, 17, 33, 100, 127, 128}) {
    for (const int side : {1, 4, 12, 16}) {
      for (const int at : {0, 1, rays - side}) {
        if (at + side > rays) continue;
        const RangeImage frame = square(rays, side, at, 1);
        const FrameSignature whole = signature_of(frame);
        const SignatureStart start = start_of(frame);
        const auto cells = static_cast<std::uint32_t>(side * side);
        EXPECT_GE(start.filled, std::min(cells, SignatureStart::kMost)) << rays << ' ' << side << ' ' << at;
        EXPECT_LE(start.filled, std::min(cells, SignatureStart::kMost + 7))
            << rays << ' ' << side << ' ' << at;
        std::set<int> places;
        for (std::uint32_t i = 0; i < start.filled; ++i) {
          EXPECT_EQ(start.cells[start.places[i]], whole[start.places[i]]);
          EXPECT_NE(start.cells[start.places[i]], 0);
          places.insert(start.places[i]);
        }
        EXPECT_EQ(places.size(), start.filled) << "each once";
      }
    }
  }
  RangeImage frame = square(128, 128, 0, 1);
  EXPECT_GE(start_of(frame).filled, SignatureStart::kMost);
  frame.rays = UINT16_MAX;
  EXPECT_GE(start_of(frame).filled, SignatureStart::kMost) << "and does not read beyond the frame";
  frame.rays = 0;
  EXPECT_EQ(start_of(frame).filled, 0U);
}

TEST(SignatureStart, IsAlikeIfAQuarterOfTheComparedCellsAreEqual) {
  EXPECT_FALSE(is_alike(FrameSignature{}, SignatureStart{})) << "no return";
  for (const std::uint32_t returns : {1U, 2U, 3U, 4U, 63U, 64U, 96U}) {
    RangeImage frame;
    frame.rays = 128;
    for (std::uint32_t i = 0; i < returns; ++i) frame.ranges[128 * (i / 16) + i % 16] = 6400;
    const SignatureStart start = start_of(frame);
    const std::uint32_t compared = std::min(returns, SignatureStart::kCompared);
    for (std::uint32_t different = 0; different <= returns; ++different) {
      for (const bool lost : {false, true}) {
        FrameSignature earlier = signature_of(frame);
        for (std::uint32_t i = 0; i < different; ++i) {
          std::uint8_t& cell = earlier[start.places[i]];
          cell = static_cast<std::uint8_t>(lost ? 0 : cell ^ 1);
        }
        EXPECT_EQ(is_alike(earlier, start), 4 * std::min(different, compared) <= 3 * compared)
            << returns << ' ' << different;
      }
    }
  }
}

TEST(SignatureStart, ATenthOfTheReturnsThatIsLostDoesNotHideARepetition) {
  std::mt19937 engine(5);
  for (int pair = 0; pair < 200; ++pair) {
    RangeImage a = square(128, 40, 31, 1), b = a;
    for (RangeImage* frame : {&a, &b})
      for (std::uint16_t& range : frame->ranges)
        if (engine() % 20 == 0) range = 0;
    EXPECT_TRUE(is_alike(start_of(a).cells, start_of(b))) << pair;
    EXPECT_TRUE(is_alike(signature_of(a), start_of(b))) << pair;
  }
}

TEST(SignatureStart, NoiseOfFourCountsMakesFramesOfOneSceneDifferent) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0.0, 4.0);
  for (int pair = 0; pair < 200; ++pair) {
    RangeImage a = square(100, 16, 40, 1), b = a;
    for (RangeImage* frame : {&a, &b})
      for (std::uint16_t& range : frame->ranges)
        if (range != 0) range = static_cast<std::uint16_t>(std::lround(range + noise(engine)));
    EXPECT_FALSE(is_alike(start_of(a).cells, start_of(b)));
    EXPECT_FALSE(is_alike(signature_of(a), start_of(b)));
  }
}

// Stuck rows make every frame begin like the one before; the target's noise below makes it another one.
TEST(SignatureStart, StuckFirstRowsAreAlikeAndNoRepetition) {
  for (const int stuck_rows : {1, 4, 7}) {
    RangeImage a = square(128, 50, 40, 1), b = square(128, 50, 40, 2);
    for (RangeImage* frame : {&a, &b}) std::fill_n(frame->ranges.begin(), 128 * stuck_rows, 2560);
    EXPECT_TRUE(is_alike(signature_of(a), start_of(b))) << stuck_rows;
    EXPECT_FALSE(is_repetition(signature_of(a), signature_of(b))) << stuck_rows;
  }
}

// Ranges that are no return, such as those of saturated rays or of the chaser, fill no cell.
TEST(FrameSignature, IsOfTheRangeGate) {
  const RangeImage empty = square(128, 30, 50, 1);
  for (const int range : {1, 1279, 64'001, 65'535}) {
    RangeImage frame = empty;
    for (std::uint16_t& counts : frame.ranges)
      if (counts == 0) counts = static_cast<std::uint16_t>(range);
    EXPECT_EQ(signature_of(frame), signature_of(empty)) << range;
    EXPECT_EQ(start_of(frame).filled, 0U) << range << ": the groups that are looked at hold none";
  }
  for (const std::uint16_t range : {std::uint16_t{1280}, std::uint16_t{64'000}}) {
    RangeImage frame;
    frame.rays = 17;
    frame.ranges.fill(range);
    EXPECT_EQ(signature_of(frame)[0], (range | 0x80) & 0xFF) << range;
    EXPECT_GE(start_of(frame).filled, SignatureStart::kMost);
  }
}

// A frozen sensor whose rays without a return deliver some, each of which may be the first of its cell.
TEST(FrameSignature, OnePercentOfStrayReturnsDoNotHideARepetition) {
  std::mt19937 engine(9);
  for (int pair = 0; pair < 200; ++pair) {
    RangeImage a = square(128, 60, 34, 1), b = a;
    for (RangeImage* frame : {&a, &b})
      for (std::uint16_t& range : frame->ranges)
        if (engine() % 100 == 0) range = static_cast<std::uint16_t>(1280 + engine() % 60'000);
    EXPECT_TRUE(is_repetition(signature_of(a), signature_of(b))) << pair;
  }
}

// Returns that always fall into the same few cells are looked at for a few rows only, and a frame with hardly
// any return to its end.
TEST(SignatureStart, IsFoundInAFewRowsOrInTheLastRays) {
  RangeImage frame;
  frame.rays = 128;
  for (std::size_t row = 0; row < 128; row += 16)
    for (std::size_t column = 0; column < 128; ++column) frame.ranges[128 * row + column] = 6400;
  std::fill_n(frame.ranges.begin() + 128 * 120, 128, 6400);
  EXPECT_EQ(start_of(frame).filled, 16U);
  for (const int rays : {17, 101, 128}) {
    const RangeImage last = square(rays, 3, rays - 3, 1);
    EXPECT_EQ(start_of(last).filled, 9U) << rays;
  }
}

TEST(FrameHistory, KnowsTheLastEightByTheirStartsToo) {
  FrameHistory history;
  EXPECT_FALSE(history.contains_alike(start_of(square(128, 40, 31, 1))));
  EXPECT_FALSE(history.contains_alike(SignatureStart{})) << "no return";
  for (unsigned scene = 0; scene < 20; ++scene) {
    for (unsigned k = 0; k <= scene; ++k) {
      const RangeImage frame = square(128, 40, 31, k);
      const bool known = k < scene && k + FrameHistory::kFrames >= scene;
      EXPECT_EQ(history.contains_alike(start_of(frame)), known) << scene << ' ' << k;
      EXPECT_EQ(history.contains(signature_of(frame)), known) << scene << ' ' << k;
    }
    history.add(signature_of(square(128, 40, 31, scene)));
  }
}

}  // namespace
}  // namespace tumblesight::gnc
