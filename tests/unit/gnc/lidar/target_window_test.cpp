#include "gnc/lidar/target_window.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

namespace tumblesight::gnc {
namespace {

constexpr double kTanHalfFov = 0.2;
constexpr std::int64_t q30(double value) {
  return static_cast<std::int64_t>(value * (1 << 30));
}

class TargetWindowTest : public testing::Test {
 protected:
  void use(int rays, double right, double down, double size) {
    frame->rays = static_cast<std::uint16_t>(rays);
    make_window(*frame, {q30(kTanHalfFov), q30(right), q30(down), q30(size), 3'000}, *window);
  }
  // Every return is the target's.
  void fill(double (*range_counts)(double row, double column)) {
    *mask = {};
    for (int row = 0; row < frame->rays; ++row) {
      for (int column = 0; column < frame->rays; ++column) {
        const auto counts = static_cast<std::uint16_t>(std::lround(range_counts(row, column)));
        frame->ranges[static_cast<std::size_t>(row * frame->rays + column)] = counts;
        if (counts != 0)
          mask->rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / 32)] |=
              1U << (31 - column % 32);
      }
    }
  }
  std::array<std::uint16_t, kWindowRays> sampled(int row) const {
    std::array<std::uint16_t, kWindowRays> out{};
    sample_row(*frame, *mask, *window, row, out.data());
    return out;
  }
  // Where the window's ray lies among the frame's.
  static double position(const WindowAxis& axis, int ray) {
    return (axis.first_q16 + static_cast<double>(axis.step_q16) * ray) / 65536.0;
  }

  std::unique_ptr<RangeImage> frame = std::make_unique<RangeImage>();
  std::unique_ptr<RayMask> mask = std::make_unique<RayMask>();
  std::unique_ptr<TargetWindow> window = std::make_unique<TargetWindow>();
};

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, OfATargetThatCoversEnoughRaysHasTheFramesOwn) {
  use(128, 0.0, 0.0, 2 * kTanHalfFov * 91 / 128);
  EXPECT_FALSE(window->is_resampled);
  EXPECT_EQ(window->rays, 128);
  use(128, 0.0, 0.0, 2 * kTanHalfFov * 89 / 128);
  EXPECT_TRUE(window->is_resampled);
  EXPECT_EQ(window->rays, kWindowRays);
}

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, LiesAroundTheTarget) {
  use(128, 0.05, -0.1, 0.1);
  ASSERT_TRUE(window->is_resampled);
  // Slope s is at ray (s / tan + 1) rays / 2 - 1/2.
  for (const double end : {-0.5, 0.5}) {
    const double ray = (kWindowRays - 1) / 2.0 + end * kWindowRays;
    const auto at = [ray](const WindowAxis& axis) {
      return (axis.first_q16 + static_cast<double>(axis.step_q16) * ray) / 65536.0;
    };
    EXPECT_NEAR(at(window->columns), ((0.05 + 0.1 * end) / kTanHalfFov + 1.0) * 64 - 0.5, 0.01);
    EXPECT_NEAR(at(window->rows), ((-0.1 + 0.1 * end) / kTanHalfFov + 1.0) * 64 - 0.5, 0.01);
  }
}

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, SamplesARampExactly) {
  const auto ramp = [](double row, double column) { return 8000.0 + 6.0 * column - 4.0 * row; };
  for (const int rays : {16, 33, 64, 128}) {
    use(rays, 0.02, 0.01, 2 * kTanHalfFov * 0.5);
    fill(ramp);
    for (int row = 0; row < kWindowRays; ++row) {
      const auto ranges = sampled(row);
      for (int column = 0; column < kWindowRays; ++column) {
        // Positions are used in units of 1/256 ray.
        EXPECT_NEAR(ranges[static_cast<std::size_t>(column)],
                    ramp(position(window->rows, row), position(window->columns, column)), 0.6)
            << rays << ' ' << row << ' ' << column;
      }
    }
  }
}

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, PutsAnEdgeInTheMiddleBetweenRays) {
  use(64, 0.0, 0.0, 2 * kTanHalfFov * 0.5);
  fill([](double, double column) { return column < 30 ? 8000.0 : 0.0; });
  const auto ranges = sampled(kWindowRays / 2);
  for (int column = 0; column < kWindowRays; ++column) {
    const double at = position(window->columns, column);
    if (std::abs(at - 29.5) < 0.01) continue;  // positions are used in units of 1/256 ray
    EXPECT_EQ(ranges[static_cast<std::size_t>(column)], at < 29.5 ? 8000 : 0) << at;
  }
}

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, DoesNotMixSurfacesThatAreARadiusApart) {
  use(64, 0.0, 0.0, 2 * kTanHalfFov * 0.5);
  fill([](double row, double column) { return row + column < 63 ? 8000.0 : 8500.0; });
  for (int row = 0; row < kWindowRays; ++row) {
    for (const std::uint16_t range : sampled(row))
      EXPECT_TRUE(range == 0 || range == 8000 || range == 8500) << range;
  }
}

// Verifies TS-LID-110.
TEST_F(TargetWindowTest, HasNoReturnOutsideTheFieldOfView) {
  use(64, 0.19, -0.19, 0.15);
  fill([](double, double) { return 8000.0; });
  int inside = 0;
  for (int row = 0; row < kWindowRays; ++row) {
    const auto ranges = sampled(row);
    for (int column = 0; column < kWindowRays; ++column) {
      const double x = position(window->columns, column), y = position(window->rows, row);
      const double beyond =
          std::max({-x, x - 63, -y, y - 63});  // the first and last rays' positions: 0 and 63
      if (beyond > 0.0 && beyond < 0.51) continue;
      EXPECT_EQ(ranges[static_cast<std::size_t>(column)], beyond > 0.0 ? 0 : 8000);
      inside += beyond < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
}

}  // namespace
}  // namespace tumblesight::gnc
