#include "gnc/lidar/depth_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace tumblesight::gnc {
namespace {

constexpr double kRange_m = 50.0;
constexpr DepthProjection kProjection{6000, 3000};

std::uint32_t fov_urad(double swath_m, double range_m) {
  return static_cast<std::uint32_t>(std::lround(2e6 * std::atan(swath_m / (2.0 * range_m))));
}

struct Projection {
  RangeImage frame;
  DepthImageScratch scratch;
  DepthImage image;

  Projection() {
    frame.rays = 128;
    frame.fov_urad = fov_urad(6.0, kRange_m);
  }
  // Range along ray (row, column) to a point at a depth, in counts: depth * sqrt(1 + u^2 + v^2).
  std::uint16_t counts(int row, int column, double depth_m) const {
    const double t = std::tan(frame.fov_urad * 0.5e-6);
    const double u = t * ((2.0 * column + 1.0) / frame.rays - 1.0);
    const double v = t * (1.0 - (2.0 * row + 1.0) / frame.rays);
    return static_cast<std::uint16_t>(std::lround(depth_m * std::sqrt(1.0 + u * u + v * v) * 128.0));
  }
  void set(int row, int column, double depth_m) {
    frame.ranges[row * frame.rays + column] = counts(row, column, depth_m);
  }
  FrameStatus make(const DepthProjection& projection = kProjection) {
    const FrameStatus status = make_depth_image(frame, projection, scratch, image);
    EXPECT_EQ(check_frame(frame), status);
    return status;
  }
  double at(int row, int column) const { return image.depth[row * DepthImage::kSide + column] / 65536.0; }
};

class DepthImageTest : public testing::Test {
 protected:
  std::unique_ptr<Projection> s = std::make_unique<Projection>();
};

// Verifies TS-LID-070.
TEST_F(DepthImageTest, ATiltedPlaneBecomesARampInTheCentroidRelativeScale) {
  // depth = range + 0.5 x, over the whole frame; x = u * depth, so depth = range / (1 - 0.5 u).
  const double t = std::tan(s->frame.fov_urad * 0.5e-6);
  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 128; ++column) {
      const double u = t * ((2.0 * column + 1.0) / 128 - 1.0);
      s->set(row, column, kRange_m / (1.0 - 0.5 * u));
    }
  }
  ASSERT_EQ(s->make(), FrameStatus::kOk);
  for (int row : {5, 50, 94}) {
    for (int column = 5; column < 95; ++column) {
      const double x = 6.0 * ((column + 0.5) / 100.0 - 0.5);
      EXPECT_NEAR(s->at(row, column), 0.5 + 0.5 * (0.0 - 0.5 * x) / 3.0, 0.01) << row << ' ' << column;
    }
  }
}

// Verifies TS-LID-070.
TEST_F(DepthImageTest, RowZeroIsUpAndColumnZeroIsLeft) {
  // A wall without its lower left quarter: its centroid lies above and to the right of the middle.
  for (int row = 0; row < 128; ++row) {
    for (int column = row < 64 ? 0 : 64; column < 128; ++column) {
      s->set(row, column, kRange_m + 0.1 * ((row + column) % 2));
    }
  }
  ASSERT_EQ(s->make({10000, 3000}), FrameStatus::kOk);
  EXPECT_GT(s->at(30, 25), 0.0);
  EXPECT_GT(s->at(30, 70), 0.0);
  EXPECT_GT(s->at(75, 70), 0.0);
  EXPECT_EQ(s->at(75, 25), 0.0);
}

// Verifies TS-LID-080.
TEST_F(DepthImageTest, ReturnsInOneCellAreAveraged) {
  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 128; ++column)
      s->set(row, column, kRange_m + ((row + column) % 2 == 0 ? 0.4 : -0.4));
  }
  s->frame.fov_urad = fov_urad(2.0, kRange_m);  // 128 rays over a third of the image: 14 returns per cell
  ASSERT_EQ(s->make(), FrameStatus::kOk);
  for (int column = 40; column < 60; ++column) EXPECT_NEAR(s->at(50, column), 0.5, 0.03);
}

// Verifies TS-LID-070.
TEST_F(DepthImageTest, NearerIsBrighterAndAReturnIsNeverZero) {
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 128; ++column)
      s->set(row, column, row < 32 ? kRange_m - 4.0 : kRange_m + 4.0);
  }
  ASSERT_EQ(s->make({20000, 3000}), FrameStatus::kOk);
  int smallest = DepthImage::kLargest;
  int largest = 0;
  for (const int depth : s->image.depth) {
    if (depth > 0) smallest = std::min(smallest, depth);
    largest = std::max(largest, depth);
  }
  EXPECT_EQ(largest, DepthImage::kLargest);
  EXPECT_EQ(smallest, DepthImage::kSmallest);
}

// Verifies TS-LID-080.
TEST_F(DepthImageTest, DepthIsLimitedToARadiusFromTheCentroid) {
  // One return in 16 lies 7 m behind the others, which puts the centroid 0.44 m behind them: they are at
  // 0.573. Limited to 0, it lowers the mean of a cell to 0.537, with its full distance to 0.5.
  s->frame.fov_urad = fov_urad(2.0, kRange_m);
  for (int i = 0; i < 128 * 128; ++i) {
    const bool far = i / 128 % 4 == 0 && i % 4 == 0;
    s->set(i / 128, i % 128, far ? kRange_m + 7.0 : kRange_m);
  }
  ASSERT_EQ(s->make(), FrameStatus::kOk);
  double sum = 0.0;
  for (int column = 40; column < 60; ++column) sum += s->at(50, column) / 20;
  EXPECT_NEAR(sum, 0.537, 0.01);
}

// Verifies TS-LID-080.
TEST_F(DepthImageTest, ManyReturnsInOneCellAreAveraged) {
  s->frame.fov_urad = kMinFov_urad;  // 128 x 128 rays over less than a metre, all within 2 x 2 cells
  for (int i = 0; i < 128 * 128; ++i) s->set(i / 128, i % 128, kRange_m + (i % 2 == 0 ? 1.0 : -1.0));
  ASSERT_EQ(s->make({100'000, 3000}), FrameStatus::kOk);
  int filled = 0;
  for (const int depth : s->image.depth) {
    if (depth == 0) continue;
    EXPECT_NEAR(depth / 65536.0, 0.5, 0.01);
    ++filled;
  }
  EXPECT_EQ(filled, 4);
}

// Verifies TS-LID-030.
TEST_F(DepthImageTest, RangesBeyondTheSensorsReachCountAsNoReturn) {
  for (int i = 0; i < 128 * 128; ++i) s->frame.ranges[i] = 64001;
  EXPECT_EQ(s->make(), FrameStatus::kEmpty);
}

// Verifies TS-LID-020, TS-LID-030.
TEST_F(DepthImageTest, ReturnsFromTheChaserItselfAreIgnored) {
  constexpr std::uint16_t kNearestUsed = 1280;                                                       // 10 m
  for (int i = 0; i < 128 * 128; ++i) s->frame.ranges[i] = static_cast<std::uint16_t>(384 + i % 8);  // 3 m
  EXPECT_EQ(s->make(), FrameStatus::kEmpty);
  for (int i = 0; i < kMinReturns; ++i) s->frame.ranges[i] = kNearestUsed - 1;
  EXPECT_EQ(s->make(), FrameStatus::kEmpty);
  for (int i = 0; i < kMinReturns; ++i) s->frame.ranges[i] = static_cast<std::uint16_t>(kNearestUsed + i % 2);
  EXPECT_EQ(s->make(), FrameStatus::kOk);
}

// Verifies TS-LID-010, TS-LID-020.
TEST_F(DepthImageTest, UnusableFramesAreRefusedWithTheReason) {
  EXPECT_EQ(s->make(), FrameStatus::kEmpty);
  for (int i = 0; i < kMinReturns - 1; ++i) s->set(60, i, kRange_m + 0.1 * i);
  EXPECT_EQ(s->make(), FrameStatus::kEmpty);
  s->set(61, 0, kRange_m);
  EXPECT_EQ(s->make(), FrameStatus::kOk);
  for (int i = 0; i < 128 * 128; ++i) s->frame.ranges[i] = 6400;
  EXPECT_EQ(s->make(), FrameStatus::kFlat);
  s->frame.ranges[77] = 6401;
  EXPECT_EQ(s->make(), FrameStatus::kOk);

  for (const std::uint16_t rays : std::initializer_list<std::uint16_t>{0, 15, 129, 65535}) {
    s->frame.rays = rays;
    EXPECT_EQ(s->make(), FrameStatus::kBadRayCount) << rays;
  }
  s->frame.rays = 128;
  for (const std::uint32_t fov : {0U, kMinFov_urad - 1, kMaxFov_urad + 1, 0xFFFFFFFFU}) {
    s->frame.fov_urad = fov;
    EXPECT_EQ(s->make(), FrameStatus::kBadFov) << fov;
  }
}

}  // namespace
}  // namespace tumblesight::gnc
