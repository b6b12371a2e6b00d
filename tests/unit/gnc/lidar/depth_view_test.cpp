#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/numerics/conversion.hpp"
#include "tests/support/angles.hpp"

namespace tumblesight::gnc {
namespace {

constexpr DepthProjection kViewProjection{20000, 3000};
constexpr double kDistance_m = 20.0;
constexpr int kRays = 128;

// Rectangle in the TRF, perpendicular to z.
struct Plate {
  Eigen::Vector3d centre_m;
  double half_x_m, half_y_m;
};
// No symmetry: a large plate, a wing on one side, a smaller plate above a corner.
const std::array<Plate, 3> kTarget{
    {{{0.0, 0.0, 0.0}, 2.0, 1.5}, {{-3.0, 0.6, 0.0}, 1.0, 0.5}, {{1.0, -0.7, 1.0}, 0.8, 0.6}}};

Eigen::Vector3d ray_of(std::uint32_t fov_urad, int row, int column) {
  const double t = std::tan(fov_urad * 0.5e-6);
  return {t * ((2.0 * column + 1.0) / kRays - 1.0), 1.0, t * (1.0 - (2.0 * row + 1.0) / kRays)};
}

// Frame of the target at `position_m`: every ray is intersected with every plate, in the TRF.
RangeImage frame_of(const Eigen::Vector3d& position_m, const Eigen::Matrix3d& r_lrf_trf) {
  RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = kMaxFov_urad;
  const Eigen::Vector3d eye_m = -r_lrf_trf.transpose() * position_m;
  for (int row = 0; row < kRays; ++row) {
    for (int column = 0; column < kRays; ++column) {
      const Eigen::Vector3d along = r_lrf_trf.transpose() * ray_of(frame.fov_urad, row, column).normalized();
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const Plate& plate : kTarget) {
        const double range_m = (plate.centre_m.z() - eye_m.z()) / along.z();
        const Eigen::Vector3d from_centre_m = eye_m + range_m * along - plate.centre_m;
        const bool hit = range_m > 0.0 && std::abs(from_centre_m.x()) < plate.half_x_m &&
                         std::abs(from_centre_m.y()) < plate.half_y_m;
        if (hit) nearest_m = std::min(nearest_m, range_m);
      }
      if (std::isfinite(nearest_m)) {
        frame.ranges[row * kRays + column] = static_cast<std::uint16_t>(std::lround(nearest_m * 128.0));
      }
    }
  }
  return frame;
}

Eigen::Vector3d centroid_m(const RangeImage& frame) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = 0; i < kRays * kRays; ++i) {
    if (frame.ranges[i] == 0) continue;
    sum_m += frame.ranges[i] / 128.0 * ray_of(frame.fov_urad, i / kRays, i % kRays).normalized();
    ++count;
  }
  return sum_m / count;
}

std::unique_ptr<DepthImage> image_of(const RangeImage& frame,
                                     const DepthProjection& projection = kViewProjection) {
  static DepthImageScratch scratch;
  auto image = std::make_unique<DepthImage>();
  EXPECT_EQ(make_depth_image(frame, projection, scratch, *image), FrameStatus::kOk);
  return image;
}

Eigen::Vector3d off_boresight(double right_deg, double up_deg) {
  return kDistance_m *
         Eigen::Vector3d(std::tan(right_deg * kDegree), 1.0, std::tan(up_deg * kDegree)).normalized();
}
const std::vector<Eigen::Vector3d> kPositions_m = {off_boresight(9.0, 0.0), off_boresight(0.0, -9.0),
                                                   off_boresight(-8.0, 8.0), off_boresight(7.0, 8.0)};

// The face of the plates toward the sensor, tilted.
Eigen::Matrix3d tilted_attitude() {
  const Eigen::AngleAxisd facing(M_PI_2, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd tilt(0.4, Eigen::Vector3d(0.5, 0.2, 1.0).normalized());
  return (tilt * facing).toRotationMatrix();
}

// Of the cells filled in at least one image: the share filled in only one, and the mean difference of the
// others.
struct Difference {
  double one_sided = 0.0, mean = 0.0;
};

Difference difference(const DepthImage& a, const DepthImage& b) {
  int either = 0, both = 0;
  double sum = 0.0;
  for (int i = 0; i < DepthImage::kCells; ++i) {
    either += a.depth[i] > 0 || b.depth[i] > 0 ? 1 : 0;
    if (a.depth[i] == 0 || b.depth[i] == 0) continue;
    ++both;
    sum += std::abs(a.depth[i] - b.depth[i]) / 65536.0;
  }
  EXPECT_GT(both, 200);
  return {1.0 - static_cast<double>(both) / either, sum / both};
}

// Verifies TS-LID-090.
TEST(DepthView, IsTheShortestTurnOfTheBoresightToTheCentroid) {
  for (const Eigen::Vector3d& position_m : kPositions_m) {
    const RangeImage frame = frame_of(position_m, tilted_attitude());
    const Eigen::Matrix3d turn = converted<float>(image_of(frame)->r_lrf_view).cast<double>();
    EXPECT_LT((turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-6);
    EXPECT_LT((turn.col(1) - centroid_m(frame).normalized()).norm(), 1e-5);
    EXPECT_GT((turn.col(1) - Eigen::Vector3d::UnitY()).norm(), 0.1);
    const Eigen::AngleAxisd shortest(turn);
    EXPECT_NEAR(shortest.axis().y(), 0.0, 1e-5);
    EXPECT_NEAR(shortest.angle(), std::acos(turn(1, 1)), 1e-5);
  }
}

// Verifies TS-LID-090.
TEST(DepthView, ShowsATargetOffTheBoresightAsOnTheBoresight) {
  const Eigen::Matrix3d r_lrf_trf = tilted_attitude();
  for (const Eigen::Vector3d& position_m : kPositions_m) {
    const auto image = image_of(frame_of(position_m, r_lrf_trf));
    const Eigen::Matrix3d r_view_lrf = converted<float>(image->r_lrf_view).cast<double>().transpose();
    const Eigen::Vector3d on_boresight_m = r_view_lrf * position_m;
    const auto rotated = image_of(frame_of(on_boresight_m, r_view_lrf * r_lrf_trf));
    EXPECT_LT((converted<float>(rotated->r_lrf_view) - Eigen::Matrix3f::Identity()).norm(), 0.01F);
    const Difference sampling = difference(*image, *rotated);
    EXPECT_LT(sampling.one_sided, 0.1);
    EXPECT_LT(sampling.mean, 0.01);
    // Without the rotation of the view the images differ by more than the sampling.
    const auto unrotated = image_of(frame_of(on_boresight_m, r_lrf_trf));
    EXPECT_GT(difference(*image, *unrotated).mean, 4.0 * sampling.mean);
  }
}

// Verifies TS-LID-030.
TEST(DepthView, IsTheSameWithPartsOfTheChaserInTheFieldOfView) {
  RangeImage clear = frame_of(kPositions_m[2], tilted_attitude());
  RangeImage occluded = clear;
  int hidden = 0;
  for (int row = 30; row < kRays; ++row) {  // a mast from below, over part of the target
    for (int column = 30; column < 40; ++column) {
      hidden += clear.ranges[row * kRays + column] > 0 ? 1 : 0;
      clear.ranges[row * kRays + column] = 0;
      occluded.ranges[row * kRays + column] = static_cast<std::uint16_t>(3 * 128 + row);
    }
  }
  ASSERT_GT(hidden, 20);
  const auto expected = image_of(clear);
  const auto image = image_of(occluded);
  EXPECT_EQ(image->depth, expected->depth);
  EXPECT_TRUE(image->r_lrf_view == expected->r_lrf_view);
}

// Position of a return in the image, in cells.
Eigen::Vector2d in_cells(const RangeImage& frame, int ray, const DepthImage& image,
                         const DepthProjection& projection) {
  const Eigen::Vector3d point_m =
      frame.ranges[ray] / 128.0 * ray_of(frame.fov_urad, ray / kRays, ray % kRays).normalized();
  const Eigen::Vector3d in_view_m = converted<float>(image.r_lrf_view).cast<double>().transpose() * point_m;
  constexpr double kMiddle = DepthImage::kSide / 2;
  const double cells_per_m = DepthImage::kSide / (1e-3 * projection.swath_mm);
  return {kMiddle + in_view_m.x() * cells_per_m, kMiddle - in_view_m.z() * cells_per_m};
}

// Every filled cell is within `kTolerance` cells of a return, and every return that lies in the image by more
// than that has a filled cell as close. Returns the number of those.
int expect_returns_where_they_are(const RangeImage& frame, const DepthProjection& projection) {
  constexpr double kTolerance = 1.0;
  constexpr int kSide = DepthImage::kSide;
  const std::unique_ptr<DepthImage> image = image_of(frame, projection);
  std::vector<bool> explained(DepthImage::kCells, false);
  int inside = 0;
  for (int ray = 0; ray < kRays * kRays; ++ray) {
    if (frame.ranges[ray] == 0) continue;
    const Eigen::Vector2d at = in_cells(frame, ray, *image, projection);
    if ((at.array() < -kTolerance).any() || (at.array() >= kSide + kTolerance).any()) continue;
    bool filled = false;
    const auto first = [&](double along) { return std::max(0, static_cast<int>(along - kTolerance) - 1); };
    const auto end = [&](double along) { return std::min(kSide, static_cast<int>(along + kTolerance) + 2); };
    for (int row = first(at.y()); row < end(at.y()); ++row) {
      for (int column = first(at.x()); column < end(at.x()); ++column) {
        const Eigen::Vector2d from_middle = at - Eigen::Vector2d(column + 0.5, row + 0.5);
        if (from_middle.cwiseAbs().maxCoeff() > 0.5 + kTolerance) continue;
        const auto cell = static_cast<std::size_t>(row * kSide + column);
        explained[cell] = true;
        filled = filled || image->depth[cell] > 0;
      }
    }
    const bool well_inside = (at.array() > kTolerance).all() && (at.array() < kSide - kTolerance).all();
    if (!well_inside) continue;
    ++inside;
    EXPECT_TRUE(filled) << "ray " << ray << " at " << at.transpose();
  }
  for (std::size_t cell = 0; cell < DepthImage::kCells; ++cell) {
    EXPECT_TRUE(explained[cell] || image->depth[cell] == 0)
        << "nothing is at row " << cell / kSide << ", column " << cell % kSide;
  }
  return inside;
}

// Verifies TS-LID-095.
TEST(DepthView, ReturnsBesideTheImageDoNotAppearInIt) {
  RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = kMaxFov_urad;
  int inside = 0;
  for (const int slant : {0, 3}) {  // a wall that fills the field of view, 14.6 m wide
    for (int ray = 0; ray < kRays * kRays; ++ray)
      frame.ranges[ray] = static_cast<std::uint16_t>(20 * 128 + slant * (ray % kRays) + ray % 7);
    for (const std::uint32_t swath_mm : {10'500U, 12'000U, 14'000U})
      inside += expect_returns_where_they_are(frame, {swath_mm, swath_mm / 5});
  }
  EXPECT_GT(inside, 10'000);
}

// Of a frame with a small target far away. The field of view is up to a hundred times wider than the image.
RangeImage small_target(int row, int column, int reach) {
  RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = kMaxFov_urad;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j)
      frame.ranges[(row + i) * kRays + column + j] = static_cast<std::uint16_t>(110 * 128 + j);
  }
  return frame;
}

// Verifies TS-LID-095, TS-LID-100.
TEST(DepthView, IsTheSameWithStrayReturnsAllOverTheFieldOfView) {
  for (const std::uint32_t swath_mm : {500U, 1'250U, 5'000U}) {
    for (const int column : {64, 100, 112}) {
      for (const int row : {64, 20, 108}) {
        SCOPED_TRACE(std::to_string(swath_mm) + ' ' + std::to_string(column) + ' ' + std::to_string(row));
        const RangeImage alone = small_target(row, column, 4);
        RangeImage frame = alone;
        for (int along = 0; along < kRays; along += 11) {
          for (const int edge : {0, 5, kRays - 1}) {
            frame.ranges[edge * kRays + along] = 110 * 128;
            frame.ranges[along * kRays + edge] = 110 * 128;
          }
        }
        const DepthProjection projection{swath_mm, swath_mm / 2};
        const auto expected = image_of(alone, projection), image = image_of(frame, projection);
        EXPECT_EQ(image->depth, expected->depth);
        EXPECT_TRUE(image->r_lrf_view == expected->r_lrf_view);
        EXPECT_GT(
            std::count_if(image->depth.begin(), image->depth.end(), [](int depth) { return depth > 0; }),
            300);
      }
    }
  }
}

}  // namespace
}  // namespace tumblesight::gnc
