#include "gnc/registration/frame_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr RangeNoise kNoNoise{0, 0};

// Each with a radius of the target and a reference depth, from the nearest to the farthest.
struct Case {
  Sensor sensor;
  double radius_m, depth_m;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double fov_deg : {1.0, 5.0, 20.0, 40.0}) {
    for (const int rays : {16, 17, 64, 128}) {
      for (const double radius_m : {0.5, 2.5, 50.0}) {
        for (const double radii : {2.1, 10.0, 80.0, 5000.0})
          if (radii * radius_m <= 500.0) all.push_back({{rays, fov_deg}, radius_m, radii * radius_m});
      }
    }
  }
  return all;
}
std::string name(const Case& at) {
  return std::to_string(at.sensor.fov_deg) + " deg, " + std::to_string(at.sensor.rays) + " rays, radius " +
         std::to_string(at.radius_m) + " m, depth " + std::to_string(at.depth_m) + " m";
}

// Ranges on the target, on every ray; rounded to their counts, as the sensor delivers them.
Frame random_frame(const Case& at, Random& random) {
  Frame frame(at.sensor);
  for (int row = 0; row < at.sensor.rays; ++row) {
    for (int column = 0; column < at.sensor.rays; ++column) {
      const double depth_m = at.depth_m + at.radius_m * random.uniform(-1.0, 1.0);
      frame.add(row, column, std::min(511.0, depth_m * ray(at.sensor, row, column).norm()));
    }
  }
  return frame;
}

// One count of inverse depth, and the error of the reciprocal.
TEST(FrameView, InverseDepthIsThatOfTheClosedForm) {
  Random random(2);
  for (const Case& at : cases()) {
    SCOPED_TRACE(name(at));
    const Frame frame = random_frame(at, random);
    const auto view = view_of(frame, at.depth_m, at.radius_m, kNoNoise);
    const double bound = 1.1 + 3e-7 * std::ldexp(1.0, view->shift);
    // The mean over the returns of a block.
    const auto expected_of = [&](int row, int column, double& sum, int& returns) {
      const double range_m =
          frame.image->ranges[static_cast<std::size_t>(row * at.sensor.rays + column)] / 128.0;
      if (!view->is_returned(row, column)) return;
      sum += std::clamp(inverse_depth_of(*view, range_m / ray(at.sensor, row, column).norm()), -32'766.0,
                        32'767.0);
      ++returns;
    };
    double worst = 0.0;
    for (int row = 0; row + 1 < at.sensor.rays; row += 2) {
      for (int column = 0; column + 1 < at.sensor.rays; column += 2) {
        double sum = 0.0;
        int returns = 0;
        for (int i = 0; i < 4; ++i) expected_of(row + i / 2, column + i % 2, sum, returns);
        if (returns > 0)
          worst =
              std::max(worst, std::abs(view->inverse_depth_of_block(row / 2, column / 2) - sum / returns));
      }
    }
    EXPECT_LE(worst, bound + 0.5);
  }
}

TEST(FrameView, TargetFillsFourteenBits) {
  for (const Case& at : cases()) {
    SCOPED_TRACE(name(at));
    const auto view = empty_view(at.sensor, at.depth_m, at.radius_m);
    const double nearest = inverse_depth_of(*view, at.depth_m - at.radius_m);
    EXPECT_GT(nearest, 4095.0);
    EXPECT_LE(nearest, 8193.0);
    EXPECT_EQ(view->rays, at.sensor.rays);
    EXPECT_NEAR(static_cast<double>(view->tan_half_fov_q30) / std::ldexp(1.0, 30), at.sensor.tan_half_fov(),
                1e-6);
    EXPECT_NEAR(view->radius_over_depth_q30 / std::ldexp(1.0, 30), at.radius_m / at.depth_m, 1e-8);
    const double rays_per_radius = at.radius_m / at.depth_m * at.sensor.rays / 2.0 / at.sensor.tan_half_fov();
    EXPECT_NEAR(view->rays_per_radius_q8 / 256.0, rays_per_radius, 1.0 / 256.0 + 1e-4 * rays_per_radius);
  }
}

TEST(FrameView, NoiseIsThatOfARangeAtTheReferenceDepth) {
  for (const Case& at : cases()) {
    SCOPED_TRACE(name(at));
    for (const RangeNoise noise : {RangeNoise{100, 1000}, RangeNoise{0, 200}, RangeNoise{20, 0}}) {
      const auto view = view_of(Frame(at.sensor), at.depth_m, at.radius_m, noise);
      const double sigma_m = 0.001 * noise.constant_mm + 1e-5 * noise.share_1e5 * at.depth_m;
      const double expected = sigma_m / at.depth_m * std::ldexp(1.0, view->shift);
      EXPECT_NEAR(view->noise_q8 / 256.0, expected, 1.0 / 256.0 + 1e-5 * expected);
    }
  }
}

TEST(FrameView, NoiseOfAPerfectSensorIsNotZero) {
  EXPECT_GE(view_of(Frame(Sensor()), 50.0, 3.0, kNoNoise)->noise_q8, 1);
}

// The mean of 1 / depth exceeds 1 / mean depth. 40 counts of bias in this case.
TEST(FrameView, MeanInverseDepthOfNoisyRangesIsThatOfTheSurface) {
  const Case at{{128, 2.0}, 2.5, 20.0};
  constexpr RangeNoise kNoise{1'000, 1'000};
  const double sigma_m = 1.2;
  Random random(3);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < trials(8); ++i) {
    Frame frame(at.sensor);
    for (int row = 0; row < at.sensor.rays; ++row)
      for (int column = 0; column < at.sensor.rays; ++column)
        frame.add(row, column, at.depth_m * ray(at.sensor, row, column).norm() + sigma_m * random.normal());
    const auto view = view_of(frame, at.depth_m, at.radius_m, kNoise);
    for (int block = 0; block < at.sensor.rays * at.sensor.rays / 4; ++block)
      sum += 4.0 *
             (view->inverse_depth_of_block(block / (at.sensor.rays / 2), block % (at.sensor.rays / 2)) + 0.5);
    count += at.sensor.rays * at.sensor.rays;
  }
  const double scale = std::ldexp(1.0, view_of(Frame(at.sensor), at.depth_m, at.radius_m)->shift);
  const double relative = sigma_m / at.depth_m;
  ASSERT_GT(scale * relative * relative, 40.0) << "the bias without the correction";
  EXPECT_NEAR(sum / count, 0.0, 5.0 * scale * relative / std::sqrt(count));
}

TEST(FrameView, RaysWithoutAReturnOfTheTargetAreMissed) {
  const Sensor sensor{32, 20.0};
  Frame frame(sensor);
  frame.add(10, 10, 50.0);
  frame.hide(3, 4, 60.0);            // behind the target
  frame.hide(3, 5, 50.0);            // beside it
  frame.hide(3, 6, 48.0 + 1 / 64.);  // less than 2 m in front of it
  const auto view = view_of(frame, 50.0, 3.0);
  for (int row = 0; row < sensor.rays; ++row) {
    for (int column = 0; column < sensor.rays; ++column)
      EXPECT_EQ(view->is_returned(row, column) || view->is_hidden(row, column), row == 10 && column == 10);
  }
}

TEST(FrameView, RaysWithAReturnWellInFrontOfTheTargetAreHidden) {
  for (const int rays : {17, 64, 128}) {
    const Sensor sensor{rays, 20.0};
    Frame frame(sensor);
    frame.add(0, rays - 1, 52.0);
    frame.add(rays - 1, 0, 50.0);
    frame.hide(0, 0, 47.0);
    frame.hide(rays - 1, rays - 1, 1.0 / 128.0);
    const auto view = view_of(frame, 50.0, 3.0);
    int hidden = 0;
    for (int ray = 0; ray < rays * rays; ++ray) hidden += view->is_hidden(ray / rays, ray % rays) ? 1 : 0;
    EXPECT_EQ(hidden, 2);
    EXPECT_TRUE(view->is_hidden(0, 0));
    EXPECT_TRUE(view->is_hidden(rays - 1, rays - 1));
    EXPECT_TRUE(view->is_returned(0, rays - 1));
    EXPECT_TRUE(view->is_returned(rays - 1, 0));
  }
}

// A range that is not the target's at all is still a return of it.
TEST(FrameView, ReturnFarFromTheReferenceDepthIsNeitherMissedNorHidden) {
  const Sensor sensor{32, 20.0};
  for (const double reference_m : {6.3, 50.0, 500.0}) {
    Frame frame(sensor);
    frame.add(1, 1, 1.0 / 128.0);
    frame.add(2, 2, 511.9);
    const auto view = view_of(frame, reference_m, 3.0);
    EXPECT_TRUE(view->is_returned(1, 1));
    EXPECT_TRUE(view->is_returned(2, 2));
    EXPECT_GT(view->inverse_depth_of_block(0, 0), view->inverse_depth_of_block(1, 1));
  }
}

TEST(FrameView, TargetNearerThanTwoRadiiOrAMetreOrFartherThanTheLongestRangeIsRefused) {
  const Frame frame(Sensor{32, 20.0});
  const auto view = std::make_unique<FrameView>();
  const auto makes = [&](std::int32_t depth_um, std::uint32_t radius_mm) {
    return make_frame_view(*frame.image, *frame.mask, depth_um, radius_mm, RangeNoise(), *view);
  };
  EXPECT_TRUE(makes(6'000'000, 3'000));
  EXPECT_FALSE(makes(5'999'999, 3'000));
  EXPECT_FALSE(makes(0, 3'000));
  EXPECT_TRUE(makes(1'000'000, 300));
  EXPECT_FALSE(makes(999'999, 300));
  EXPECT_FALSE(makes(-1, 3'000));
  EXPECT_FALSE(makes(-2'147'483'647 - 1, 3'000));
  EXPECT_TRUE(makes(512'000'000, 3'000));
  EXPECT_FALSE(makes(525'000'000, 3'000));
  EXPECT_FALSE(makes(2'147'483'647, 3'000));
  EXPECT_FALSE(makes(50'000'000, 0));
  EXPECT_FALSE(makes(50'000'000, 0xFFFFFFFF));
}

TEST(FrameView, SameFrameGivesTheSameView) {
  Random random(4);
  const Case at{{64, 20.0}, 2.5, 30.0};
  const Frame frame = random_frame(at, random);
  const auto first = view_of(frame, at.depth_m, at.radius_m),
             second = view_of(frame, at.depth_m, at.radius_m);
  EXPECT_EQ(first->returned.rows, second->returned.rows);
  EXPECT_EQ(first->hidden.rows, second->hidden.rows);
  EXPECT_EQ(first->block_inverse_depth, second->block_inverse_depth);
}

}  // namespace
}  // namespace tumblesight::gnc
