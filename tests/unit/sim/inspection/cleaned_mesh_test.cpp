#include "sim/inspection/cleaned_mesh.hpp"

#include <gtest/gtest.h>

#include "sim/inspection/mesh_inspection.hpp"
#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

TEST(CleanedMesh, LosesStraysMarkerAndRepeatedTrianglesAndMovesToItsCentre) {
  const TriangleMesh sound = sound_mesh();
  TriangleMesh mesh =
      with(with(doubled(sound), box({0.5F, 0.5F, 0.5F})), box_at(6.0F, 0.0F, 0.0F, {0.05F, 0.05F, 0.05F}));
  const MeshInspection found = inspect(mesh, {});
  const CleanedMesh clean = cleaned(mesh, found, {});
  EXPECT_EQ(clean.repeated, sound.triangles.size());
  EXPECT_EQ(clean.marker, 12U);
  EXPECT_EQ(clean.strays, 12U);
  EXPECT_EQ(clean.mesh.triangles.size(), sound.triangles.size());
  const MeshInspection again = inspect(clean.mesh, {});
  EXPECT_LT(again.centre_distance_m(), 0.02);
  EXPECT_EQ(cleaned(mesh, found, {Eigen::Vector3d(0.0, 0.0, 0.5), true}).strays, 0U);
  EXPECT_EQ(cleaned(mesh, found, {Eigen::Vector3d(0.0, 0.0, 0.5), true}).moved_m,
            Eigen::Vector3d(0.0, 0.0, -0.5));
}

std::size_t marker_removed_from(const TriangleMesh& mesh) {
  return cleaned(mesh, inspect(mesh, {}), {}).marker;
}

// The body of a CubeSat is a cube of 12 triangles about the origin, as an exporter's marker is.
TEST(CleanedMesh, KeepsTheBodyOfACubeSat) {
  const TriangleMesh mesh = cubesat();
  EXPECT_EQ(cleaned(mesh, inspect(mesh, {}), {}).mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(marker_removed_from(times(cubesat(), 0.1F)), 0U);
  EXPECT_EQ(marker_removed_from(with(cubesat(), box({0.5F, 0.5F, 0.6F}))), 0U) << "equipment inside";
  EXPECT_EQ(marker_removed_from(with(cubesat(), box({0.1F, 0.1F, 0.1F}))), 0U) << "its marker inside";
  const TriangleMesh stray = box_at(9.0F, 0.0F, 0.0F, {0.05F, 0.05F, 0.05F});
  EXPECT_EQ(marker_removed_from(with(cubesat(), stray)), 0U);
  EXPECT_EQ(marker_removed_from(with(cubesat(), moved(stray, {900.0F, 0.0F, 0.0F}))), 0U);
}

// Plates on four sides show two sides of it only.
TEST(CleanedMesh, KeepsABodyThatPlatesCoverInPart) {
  TriangleMesh mesh = cubesat();
  append(mesh, box_at(0.505F, 0.0F, 0.0F, {0.01F, 1.0F, 1.0F}));
  append(mesh, box_at(-0.505F, 0.0F, 0.0F, {0.01F, 1.0F, 1.0F}));
  append(mesh, box_at(0.0F, 0.505F, 0.0F, {1.0F, 0.01F, 1.0F}));
  append(mesh, box_at(0.0F, -0.505F, 0.0F, {1.0F, 0.01F, 1.0F}));
  EXPECT_EQ(marker_removed_from(mesh), 0U);
}

TEST(CleanedMesh, LosesAMarkerThatIsTinyOrInsideOrHidesTheRest) {
  EXPECT_EQ(marker_removed_from(with(sound_mesh(), box({1.0F, 1.0F, 1.0F}))), 12U) << "faces in the body's";
  EXPECT_EQ(marker_removed_from(with(sound_mesh(), box({2.0F, 2.0F, 2.0F}))), 12U);
  const TriangleMesh beside = moved(sound_mesh(), {0.9F, 0.0F, 0.0F});
  EXPECT_EQ(marker_removed_from(with(beside, box({0.1F, 0.1F, 0.1F}))), 12U) << "tiny, and seen";
}

// A marker around a CubeSat: two cubes about the origin, in either order.
TEST(CleanedMesh, LosesTheMarkerAndKeepsTheBodyOfACubeSatInside) {
  const TriangleMesh marker = box({3.5F, 3.5F, 3.5F});
  for (const TriangleMesh& mesh : {with(cubesat(), marker), with(marker, cubesat())}) {
    const CleanedMesh clean = cleaned(mesh, inspect(mesh, {}), {});
    EXPECT_EQ(clean.mesh.triangles.size(), cubesat().triangles.size());
    EXPECT_LT(clean.mesh.radius_m(), 2.0);
    EXPECT_EQ(marker_removed_from(clean.mesh), 0U);
  }
}

}  // namespace
}  // namespace tumblesight::sim
