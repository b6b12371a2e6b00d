#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sim/world/math/angles.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

const Eigen::Vector3f kX = Eigen::Vector3f::UnitX();
const Eigen::Vector3f kY = Eigen::Vector3f::UnitY();
const Eigen::Vector3f kZ = Eigen::Vector3f::UnitZ();

TEST(AquariusStowed, FillsItsBoundingBox) {
  const Eigen::AlignedBox3f box = bounding_box(make_sacd_aquarius_stowed());
  EXPECT_LT((box.min() - Eigen::Vector3f(-1.26F, -1.26F, -1.32F)).cwiseAbs().maxCoeff(), 0.02F);
  EXPECT_LT((box.max() - Eigen::Vector3f(1.26F, 1.26F, 2.95F)).cwiseAbs().maxCoeff(), 0.02F);
}

TEST(AquariusStowed, BusStandsOnItsRingUnderTheSunshield) {
  const TriangleMesh mesh = make_sacd_aquarius_stowed();
  const auto ring = [](const Eigen::Vector3f& v) { return v.z() < -1.30F; };
  EXPECT_NEAR(reach_m(mesh, kX, ring), 0.72F, 0.01F);
  EXPECT_NEAR(reach_m(mesh, -kZ, ring), 1.32F, 0.01F);
  // An octagon with its flats on the axes: radius 0.63 between flat (0.60) and corner (0.65).
  const auto bus = [](const Eigen::Vector3f& v) {
    return v.z() > 0.876F && v.z() < 0.8875F && v.head<2>().norm() < 0.66F;
  };
  EXPECT_NEAR(reach_m(mesh, kX, bus), 0.61F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, (kX + std::tan(0.3926991F) * kY).normalized(), bus), 0.65F, 0.02F);
  const auto shield = [](const Eigen::Vector3f& v) {
    return v.z() > 1.21F && v.z() < 1.26F && v.head<2>().norm() > 1.1F;
  };
  EXPECT_NEAR(reach_m(mesh, kX, shield), 1.26F, 0.01F);
  EXPECT_NEAR(reach_m(mesh, (kX + kY).normalized(), shield), 1.26F, 0.01F);
  EXPECT_NEAR(reach_m(mesh, kZ, shield), 1.25F, 0.01F);
}

TEST(AquariusStowed, PanelsAreFoldedFlatAgainstTheSides) {
  const TriangleMesh mesh = make_sacd_aquarius_stowed();
  for (const float side : {-1.0F, 1.0F}) {
    const auto panel = [side](const Eigen::Vector3f& v) {
      return side * v.y() > 0.694F && side * v.y() < 0.752F && v.z() > -1.30F && v.z() < 0.80F;
    };
    EXPECT_NEAR(reach_m(mesh, side * kY, panel), 0.72F + 0.03F, 0.01F);
    EXPECT_NEAR(-reach_m(mesh, -side * kY, panel), 0.72F - 0.03F, 0.01F);
    EXPECT_NEAR(reach_m(mesh, kX, panel), 1.0F, 0.01F);
    EXPECT_NEAR(reach_m(mesh, -kX, panel), 1.0F, 0.01F);
    EXPECT_NEAR(reach_m(mesh, kZ, panel), 0.73F, 0.01F);
    EXPECT_NEAR(reach_m(mesh, -kZ, panel), 1.27F, 0.01F);
  }
}

TEST(AquariusStowed, ReflectorLiesTiltedOverTheFeeds) {
  const TriangleMesh mesh = make_sacd_aquarius_stowed();
  const Eigen::Vector3f centre(0.03F, -0.01F, 2.30F);
  const Eigen::Vector3f normal = Eigen::Vector3f(0.50F, 0.0F, 0.87F).normalized();
  const Eigen::Vector3f across = kY.cross(normal);
  const auto reflector = [&](const Eigen::Vector3f& v) {
    return v.z() > 1.6F && std::abs(normal.dot(v - centre)) < 0.075F && (v - centre).norm() > 1.1F;
  };
  for (const float sign : {-1.0F, 1.0F}) {
    EXPECT_NEAR(reach_m(mesh, sign * across, reflector) - sign * across.dot(centre), 1.25F, 0.02F);
    EXPECT_NEAR(reach_m(mesh, sign * kY, reflector) - sign * kY.dot(centre), 1.265F, 0.03F);
  }
  // Its boom stands on -x and leans to +y.
  const auto boom_end = [&](const Eigen::Vector3f& v) {
    return v.x() < -0.5F && v.y() > 0.7F && v.z() > 2.5F && normal.dot(v - centre) > 0.12F;
  };
  EXPECT_GT(reach_m(mesh, kZ, boom_end), 2.75F);
}

// The assumptions on which the flight configuration is based: hinges do not move, the rest is as stowed.
TEST(Aquarius, DeployedDiffersFromStowedInPanelsBoomAndReflectorOnly) {
  const TriangleMesh stowed = make_sacd_aquarius_stowed();
  const TriangleMesh flown = make_sacd_aquarius();
  ASSERT_EQ(flown.triangles, stowed.triangles);
  EXPECT_NEAR(area_m2(flown), area_m2(stowed), 1e-3);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < stowed.vertices_trf_m.size(); ++i) {
    const Eigen::Vector3f& from = stowed.vertices_trf_m[i];
    if ((flown.vertices_trf_m[i] - from).norm() > 1e-4F) {
      ++moved;
      EXPECT_TRUE(std::abs(from.y()) > 0.69F || from.z() > 1.19F) << from.transpose();
    }
  }
  EXPECT_GT(moved, 500U);
  EXPECT_LT(moved, stowed.vertices_trf_m.size() / 2);
}

TEST(Aquarius, PanelsAreDeployedAsWings) {
  const TriangleMesh mesh = make_sacd_aquarius();
  for (const float side : {-1.0F, 1.0F}) {
    const auto wing = [side](const Eigen::Vector3f& v) { return side * v.y() > 1.3F; };
    EXPECT_NEAR(reach_m(mesh, side * kY, wing), 2.49F, 0.02F);
    EXPECT_NEAR(reach_m(mesh, kX, wing), 1.0F, 0.01F);
    const auto sheet = [side](const Eigen::Vector3f& v) {
      return side * v.y() > 1.3F && std::abs(v.x()) > 0.9F;
    };
    EXPECT_NEAR(reach_m(mesh, kZ, sheet) + reach_m(mesh, -kZ, sheet), 0.056F, 0.002F);
  }
}

// Measured from the centre of the horns' mouths along the mean of their axes.
TEST(Aquarius, ReflectorFacesTheFeedHorns) {
  const TriangleMesh mesh = make_sacd_aquarius();
  const Eigen::Vector3f mouths =
      (Eigen::Vector3f(-0.421F, -0.096F, 2.075F) + Eigen::Vector3f(-0.595F, -0.136F, 1.653F) +
       Eigen::Vector3f(-0.513F, 0.291F, 1.851F)) /
      3.0F;
  const Eigen::Vector3f axis =
      (Eigen::Vector3f(-0.955F, 0.077F, 0.286F) + Eigen::Vector3f(-0.877F, 0.074F, 0.474F) +
       Eigen::Vector3f(-0.917F, -0.127F, 0.379F))
          .normalized();
  const auto reflector = [](const Eigen::Vector3f& v) { return v.x() < -1.9F && v.z() > 1.2F; };
  const float top = reach_m(mesh, kZ, reflector);
  const float bottom = -reach_m(mesh, -kZ, reflector);
  EXPECT_NEAR(top - bottom, 2.50F, 0.02F);
  const float distance = (-2.08F - mouths.x()) / axis.x();
  EXPECT_NEAR((mouths + distance * axis).z(), (top + bottom) / 2.0F, 0.05F);
  EXPECT_NEAR((mouths + distance * axis).y(), 0.0F, 0.1F);
  // Concave towards the horns: the rim of the bowl is nearer to them than its centre.
  const auto rim = [](const Eigen::Vector3f& v) { return v.x() < -1.9F && v.z() > 3.7F; };
  const auto middle = [](const Eigen::Vector3f& v) {
    return v.x() < -1.9F && std::abs(v.z() - 2.51F) < 0.1F && std::abs(v.y()) < 0.1F;
  };
  EXPECT_GT(reach_m(mesh, kX, rim), reach_m(mesh, kX, middle) + 0.05F);
}

// The paper's inertia and that of the mesh as a shell of uniform thickness agree in the plane of symmetry and
// in the axis of least inertia.
TEST(Aquarius, ItsAxesAgreeWithThoseOfItsInertia) {
  const TriangleMesh mesh = make_sacd_aquarius();
  const std::vector<Eigen::Vector3f> points = surface_points(mesh, 20'000);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    mean += p.cast<double>();
    square += p.cast<double>() * p.cast<double>().transpose();
  }
  const double n = static_cast<double>(points.size());
  const Eigen::Matrix3d spread = square / n - mean * mean.transpose() / (n * n);
  const Eigen::Matrix3d shell = spread.trace() * Eigen::Matrix3d::Identity() - spread;
  const Eigen::Matrix3d axes_shell = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(shell).eigenvectors();
  const Eigen::Matrix3d axes_paper =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia_kg_m2("sacd_aquarius")).eigenvectors();
  EXPECT_GT(std::abs(axes_shell.col(0).dot(axes_paper.col(0))), std::cos(3.0 * kRadPerDeg));
  EXPECT_LT(std::abs(axes_paper.col(0).y()), 0.02);
  EXPECT_LT(std::abs(axes_shell.col(0).y()), 0.02);
}

}  // namespace
}  // namespace tumblesight::sim
