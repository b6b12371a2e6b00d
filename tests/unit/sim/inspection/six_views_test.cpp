#include "sim/inspection/six_views.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kPixels = 64;

Eigen::Vector3f direction(const char* name) {
  return (name[0] == '-' ? -1.0F : 1.0F) * Eigen::Vector3f::Unit(name[1] - 'x');
}

TEST(SixViews, AreRightHanded) {
  for (const ViewSide& side : kViewSides)
    EXPECT_EQ(direction(side.right).cross(direction(side.up)), direction(side.from)) << side.from;
}

// A beacon in each direction is where the view says that the direction is.
// Verifies TS-SIL-360.
TEST(SixViews, ShowEachAxisWhereTheySay) {
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3f axis = (i < 3 ? 1.0F : -1.0F) * Eigen::Vector3f::Unit(i % 3);
    const TriangleMesh mesh = box_at(2.0F * axis.x(), 2.0F * axis.y(), 2.0F * axis.z(), {0.4F, 0.4F, 0.4F});
    for (const SideView& view : six_views(mesh, kPixels)) {
      double column = 0.0, row = 0.0, count = 0.0;
      for (int pixel = 0; pixel < kPixels * kPixels; ++pixel) {
        if (view.brightness[pixel] == 0.0F) continue;
        column += pixel % kPixels;
        row += pixel / kPixels;
        count += 1.0;
      }
      ASSERT_GT(count, 0.0) << view.side.from;
      const double right_m = view.swath_m * ((column / count + 0.5) / kPixels - 0.5);
      const double up_m = view.swath_m * (0.5 - (row / count + 0.5) / kPixels);
      EXPECT_NEAR(right_m, 2.0F * axis.dot(direction(view.side.right)), 0.2)
          << view.side.from << " axis " << i;
      EXPECT_NEAR(up_m, 2.0F * axis.dot(direction(view.side.up)), 0.2) << view.side.from << " axis " << i;
    }
  }
}

TEST(SixViews, OfAMeshFarFromItsOriginAreAboutItsCentre) {
  for (const SideView& view : six_views(moved(sound_mesh(), {450.0F, 0.0F, 0.0F}), kPixels)) {
    EXPECT_NEAR(view.middle_trf_m.x(), 450.0, 3.0);
    EXPECT_LT(view.swath_m, 10.0);
    EXPECT_GT(std::count_if(view.brightness.begin(), view.brightness.end(), [](float b) { return b > 0.0F; }),
              kPixels * kPixels / 50);
  }
  for (const SideView& view : six_views(moved(sound_mesh(), {4.0F, 0.0F, 0.0F}), kPixels))
    EXPECT_TRUE(view.middle_trf_m.isZero());
}

TEST(SixViews, AreBrightWhereTheSurfaceFacesTheViewerAndNearWhereItIsNear) {
  for (const SideView& view : six_views(box({2.0F, 2.0F, 2.0F}), kPixels)) {
    const int middle = kPixels * kPixels / 2 + kPixels / 2;
    EXPECT_GT(view.brightness[middle], 0.95F);
    EXPECT_NEAR(view.nearness[middle], 0.5F + 0.5F / std::sqrt(3.0F), 0.02F);
    EXPECT_EQ(view.brightness[0], 0.0F);
  }
}

}  // namespace
}  // namespace tumblesight::sim
