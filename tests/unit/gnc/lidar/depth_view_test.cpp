#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/numerics/conversion.hpp"
#include "tests/support/angles.hpp"

namespace tumblesight::gnc {
namespace {

constexpr DepthProjection kProjection{20000, 3000};
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
                                     const DepthProjection& projection = kProjection) {
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

}  // namespace
}  // namespace tumblesight::gnc
