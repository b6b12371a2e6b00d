// Verifies TS-LID-120. A sensor's own rays as those of a frame, against closed forms.
#include "gnc/lidar/frame_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace tumblesight::gnc {
namespace {

constexpr double kTan = 0.3;  // of half the field of view of the sensor
constexpr double kCount_m = 1.0 / 128.0;

// A sensor that looks at a surface.
struct View {
  std::vector<float> slopes;
  std::vector<std::uint16_t> ranges;
  SensorRays rays() const { return {static_cast<int>(slopes.size()), slopes.data()}; }
};

using Surface = std::function<double(double right, double down)>;  // range in metres along (right, 1, -down)

View look(int rays, bool uniform_in_angle, const Surface& range_m) {
  View view;
  for (int i = 0; i < rays; ++i) {
    const double share = (2.0 * i + 1.0) / rays - 1.0;
    const double slope = uniform_in_angle ? std::tan(std::atan(kTan) * share) : kTan * share;
    view.slopes.push_back(static_cast<float>(slope));
  }
  for (const float down : view.slopes) {
    for (const float right : view.slopes) {
      const double counts = range_m(right, down) / kCount_m;
      view.ranges.push_back(static_cast<std::uint16_t>(std::isfinite(counts) ? std::lround(counts) : 0));
    }
  }
  return view;
}

FrameWindow window(int rays, double tan_half_fov = kTan) {
  return {rays, static_cast<float>(tan_half_fov),
          static_cast<std::uint32_t>(std::lround(2e6 * std::atan(tan_half_fov)))};
}

std::unique_ptr<RangeImage> frame_of(const View& view, const FrameWindow& window) {
  auto frame = std::make_unique<RangeImage>();
  make_frame(view.ranges.data(), view.rays(), window, *frame);
  return frame;
}

double plane_m(double right, double down) {
  return 60.0 * std::sqrt(1.0 + right * right + down * down);
}

// A sphere of 5 m at 40 m on the boresight.
double sphere_m(double right, double down) {
  const double length = std::sqrt(1.0 + right * right + down * down);
  const double along = 40.0 / length;
  const double square = 25.0 - (1600.0 - along * along);
  return square < 0.0 ? std::numeric_limits<double>::infinity() : along - std::sqrt(square);
}

double slope_of(int index, const FrameWindow& window) {
  return static_cast<double>(window.tan_half_fov) * ((2.0 * index + 1.0) / window.rays - 1.0);
}

TEST(FrameRays, OfTheFramesOwnGeometryStayWhatTheyAre) {
  const View view = look(128, false, sphere_m);
  const auto frame = frame_of(view, window(128));
  EXPECT_EQ(frame->rays, 128);
  EXPECT_EQ(frame->fov_urad, window(128).fov_urad);
  EXPECT_TRUE(std::equal(view.ranges.begin(), view.ranges.end(), frame->ranges.begin()));
}

TEST(FrameRays, OfAPlaneAcrossTheBoresightAreExact) {
  for (const int rays : {256, 200, 129, 100}) {
    for (const bool uniform_in_angle : {false, true}) {
      const FrameWindow whole = window(std::min(rays, 128));
      const auto frame = frame_of(look(rays, uniform_in_angle, plane_m), whole);
      for (int row = 0; row < whole.rays; ++row) {
        for (int column = 0; column < whole.rays; ++column) {
          const double expected_m = plane_m(slope_of(column, whole), slope_of(row, whole));
          ASSERT_NEAR(frame->ranges[row * whole.rays + column] * kCount_m, expected_m, 1.01 * kCount_m)
              << rays << ' ' << uniform_in_angle << ' ' << row << ' ' << column;
        }
      }
    }
  }
}

// Within half a cell and half a ray of the true place, except where that reaches over the silhouette.
TEST(FrameRays, OfASphereAreThoseOfItsSurface) {
  for (const int rays : {256, 128}) {
    const FrameWindow whole = window(128);
    const auto frame = frame_of(look(rays, true, sphere_m), whole);
    const double cell = kTan / 128.0 + 1.2 * kTan / rays;
    int seen = 0;
    for (int row = 0; row < 128; ++row) {
      for (int column = 0; column < 128; ++column) {
        const double right = slope_of(column, whole), down = slope_of(row, whole);
        const double from_axis = std::hypot(right, down);
        const double measured_m = frame->ranges[row * 128 + column] * kCount_m;
        const double edge = std::tan(std::asin(5.0 / 40.0));
        if (from_axis > edge + 2.0 * cell) {
          EXPECT_EQ(measured_m, 0.0);
        } else if (from_axis < edge - 2.0 * cell) {
          const double nearer_m = sphere_m(std::max(0.0, from_axis - 1.5 * cell), 0.0);
          const double farther_m = sphere_m(from_axis + 1.5 * cell, 0.0);
          EXPECT_GE(measured_m, nearer_m - kCount_m);
          EXPECT_LE(measured_m, farther_m + kCount_m);
          ++seen;
        }
      }
    }
    EXPECT_GT(seen, 1500) << rays;
  }
}

TEST(FrameRays, OfABinReportTheNearestReturn) {
  View view = look(256, false, [](double, double) { return std::numeric_limits<double>::infinity(); });
  view.ranges[256 * 100 + 60] = 9000;  // the cell of row 50, column 30
  view.ranges[256 * 101 + 61] = 8000;
  const auto frame = frame_of(view, window(128));
  EXPECT_NEAR(frame->ranges[50 * 128 + 30], 8000, 10);
  frame->ranges[50 * 128 + 30] = 0;
  EXPECT_EQ(std::count(frame->ranges.begin(), frame->ranges.end(), 0), RangeImage::kMaxReturns);
}

TEST(FrameRays, OfTheMiddleOfTheViewKeepTheirResolution) {
  const View view = look(256, false, sphere_m);
  const auto frame = frame_of(view, window(128, kTan / 2.0));
  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 128; ++column)
      ASSERT_EQ(frame->ranges[row * 128 + column], view.ranges[256 * (row + 64) + column + 64]);
  }
}

TEST(FrameRays, StayWithinTheCountsOfAFrame) {
  View view = look(16, false, plane_m);
  view.ranges.assign(view.ranges.size(), 65535);
  const auto far = frame_of(view, window(128));
  EXPECT_EQ(*std::max_element(far->ranges.begin(), far->ranges.end()), 65535);
  view.ranges.assign(view.ranges.size(), 1);
  const auto near = frame_of(view, window(128));
  EXPECT_EQ(*std::min_element(near->ranges.begin(), near->ranges.begin() + 128 * 128), 1);
}

TEST(FrameRays, WithReturnsAreTheSmallestSquareInTheMiddle) {
  for (const int rays : {16, 17}) {
    std::vector<std::uint16_t> ranges(static_cast<std::size_t>(rays * rays));
    EXPECT_EQ(rays_with_returns(ranges.data(), rays), 0);
    ranges[static_cast<std::size_t>(rays * 8 + 8)] = 1;
    EXPECT_EQ(rays_with_returns(ranges.data(), rays), rays == 16 ? 2 : 1);
    ranges[static_cast<std::size_t>(rays * 6 + 9)] = 1;
    EXPECT_EQ(rays_with_returns(ranges.data(), rays), rays == 16 ? 4 : 5);
    ranges[static_cast<std::size_t>(rays * 8 + rays - 1)] = 1;
    EXPECT_EQ(rays_with_returns(ranges.data(), rays), rays);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
