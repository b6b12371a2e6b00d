// Clouds lie on the surface, whether they are made of a mesh or of a noisy scan.
#include "sim/baseline/surface_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/primitives.hpp"
#include "tests/unit/sim/baseline/jointed_arm.hpp"

namespace tumblesight::sim {
namespace {

const Eigen::Vector3f kHalfSize_m(1.0F, 1.5F, 2.0F);

TriangleMesh plain_box() {
  TriangleMesh mesh = box(2.0F * kHalfSize_m);
  mesh.name = "box";
  return mesh;
}

TEST(SurfaceViews, LieOnTheMeshWithNormalsTowardsTheSensor) {
  const TriangleMesh mesh = plain_box();
  const std::vector<SurfaceView> views = surface_views(mesh, swath_m(mesh), 6);
  ASSERT_EQ(views.size(), 6U);
  for (const SurfaceView& view : views) {
    ASSERT_GT(view.cloud.size(), 100U);
    for (std::size_t i = 0; i < view.cloud.size(); ++i) {
      const Eigen::Vector3f off_m = view.cloud.points_m[i].cwiseAbs() - kHalfSize_m;
      EXPECT_NEAR(off_m.maxCoeff(), 0.0F, 1e-3F);
      EXPECT_GE(view.cloud.normals[i].dot(view.towards_sensor), 0.0F);
      Eigen::Index face = 0;
      off_m.maxCoeff(&face);
      EXPECT_GT(view.cloud.normals[i].dot(view.cloud.points_m[i].normalized()), 0.0F) << "out of the box";
    }
  }
}

// A box face that fills the middle of the frame, 40 m away.
SurfaceCloud face_of_box(bool noise) {
  const TriangleMesh mesh = plain_box();
  const FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 40.0};
  SensorSettings settings;
  settings.noise = noise;
  auto frame = std::make_unique<gnc::RangeImage>();
  FlashLidar(mesh).expose(truth, settings, swath_m(mesh), 7, *frame);
  return cloud_of(*scan_of(*frame));
}

TEST(CloudOfAScan, IsTheSurfaceWithoutNoise) {
  const SurfaceCloud cloud = face_of_box(false);
  ASSERT_GT(cloud.size(), 500U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_NEAR(cloud.points_m[i].y(), 40.0F - kHalfSize_m.y(), 0.02F);
    EXPECT_LT(cloud.normals[i].y(), -0.98F);
  }
}

TEST(CloudOfAScan, RemovesMostOfTheNoise) {
  const SurfaceCloud cloud = face_of_box(true);
  ASSERT_GT(cloud.size(), 500U);
  double square_m2 = 0.0;
  double facing = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    square_m2 += std::pow(cloud.points_m[i].y() - (40.0 - kHalfSize_m.y()), 2.0);
    facing -= cloud.normals[i].y();
  }
  const auto count = static_cast<double>(cloud.size());
  EXPECT_LT(std::sqrt(square_m2 / count), 0.25 * range_sigma_m(40.0));
  EXPECT_GT(facing / count, 0.9);
}

TEST(Thinned, KeepsBothSidesOfAPanel) {
  SurfaceCloud panel;
  for (int i = 0; i < 10; ++i) {
    const float along_m = 0.001F * static_cast<float>(i);
    panel.points_m.insert(panel.points_m.end(), {{along_m, 0.0F, 0.01F}, {along_m, 0.0F, 0.0F}});
    panel.normals.insert(panel.normals.end(), {Eigen::Vector3f::UnitZ(), -Eigen::Vector3f::UnitZ()});
  }
  const SurfaceCloud thin = thinned(panel, 0.1);
  ASSERT_EQ(thin.size(), 2U);
  EXPECT_FLOAT_EQ(thin.normals[0].z() * thin.normals[1].z(), -1.0F);
  EXPECT_NEAR(thin.points_m[0].x(), 0.0045F, 1e-6F) << "the mean";
}

TEST(Misfit, IsTheMeanSquareDistanceInBothDirectionsUpToItsLimit) {
  const SurfaceCloud one{{{0.0F, 0.0F, 0.0F}}, {Eigen::Vector3f::UnitZ()}};
  SurfaceCloud two = one;
  EXPECT_EQ(misfit_m2(one, two, 0.5), 0.0);
  two.points_m.push_back({0.0F, 0.0F, 0.4F});
  EXPECT_NEAR(misfit_m2(one, two, 0.5), 0.08, 1e-6);
  two.points_m.back().z() = 9.0F;
  EXPECT_NEAR(misfit_m2(one, two, 0.5), 0.125, 1e-6);
}

}  // namespace
}  // namespace tumblesight::sim
