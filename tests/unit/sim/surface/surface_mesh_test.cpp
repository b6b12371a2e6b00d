#include "sim/surface/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "gnc/surface/surface_mesh.hpp"
#include "sim/surface/mesh_distance.hpp"
#include "sim/surface/mesh_simplification.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using gnc::SurfaceMesh;

TriangleMesh ball(double radius_m, int sides) {
  Outline profile;
  for (int i = 0; i <= sides / 2; ++i) {
    const double angle_rad = 2.0 * M_PI * i / sides;
    const bool pole = i == 0 || i == sides / 2;
    profile.emplace_back(pole ? 0.0F : static_cast<float>(radius_m * std::sin(angle_rad)),
                         static_cast<float>(radius_m * std::cos(angle_rad)));
  }
  TriangleMesh mesh = revolve(profile, sides);
  mesh.name = "ball";
  return mesh;
}

#ifdef TUMBLESIGHT_HAS_MESHOPTIMIZER

struct Section {
  std::vector<std::uint8_t> bytes;
  SurfaceMesh mesh{bytes.data()};
};
Section section_of(const TriangleMesh& mesh) {
  return Section{surface_mesh_section(mesh, static_cast<double>(mesh.radius_m()))};
}

// The surface that the section describes.
TriangleMesh decoded(const SurfaceMesh& surface, double radius_m) {
  TriangleMesh mesh;
  mesh.name = "decoded";
  for (int i = 0; i < surface.vertices(); ++i) {
    const auto [x, y, z] = surface.vertex(i);
    mesh.vertices_trf_m.push_back((radius_m / SurfaceMesh::kRadius * Vector3d(x, y, z)).cast<float>());
  }
  for (int i = 0; i < surface.triangles(); ++i) {
    const auto [a, b, c] = surface.triangle(i);
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

// Every edge belongs to the triangles that it names, once per pair of ends, no triangle is degenerate, and
// none is there twice from the same side.
void expect_consistent(const SurfaceMesh& surface) {
  std::set<std::array<int, 3>> triangles, faces;
  for (int i = 0; i < surface.triangles(); ++i) {
    std::array<int, 3> corners{surface.triangle(i)[0], surface.triangle(i)[1], surface.triangle(i)[2]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    ASSERT_TRUE(faces.insert(corners).second) << i << " is there twice";
    std::sort(corners.begin(), corners.end());
    ASSERT_TRUE(corners[0] < corners[1] && corners[1] < corners[2]) << i;
    triangles.insert(corners);
  }
  std::set<std::array<int, 2>> edges;
  for (int i = 0; i < surface.edges(); ++i) {
    const SurfaceMesh::Edge edge = surface.edge(i);
    ASSERT_TRUE(edges.insert({std::min(edge.first, edge.second), std::max(edge.first, edge.second)}).second);
    for (const int corner : edge.opposite) {
      std::array<int, 3> corners{edge.first, edge.second, corner};
      std::sort(corners.begin(), corners.end());
      ASSERT_EQ(triangles.count(corners), 1U) << i;
    }
  }
}

void expect_sound(const Section& section) {
  ASSERT_TRUE(SurfaceMesh::is_sound(section.bytes.data(), section.bytes.size()));
  ASSERT_LE(section.bytes.size(), SurfaceMesh::kMaxBytes);
  expect_consistent(section.mesh);
}

// The largest distance from `to` of a point that a few views show of `from`, in other directions and with
// other rays than the section was made with.
double largest_distance_m(const TriangleMesh& from, const TriangleMesh& to) {
  constexpr int kRays = 256;
  const FlashLidar lidar(from);
  const MeshDistance distance(to);
  float largest_m = 0.0F;
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, 2, 3),
                               Vector3d(-3, 1, 2), Vector3d(2, -3, 1), Vector3d(-1, -1, 1)}) {
    for (const double side : {1.0, -1.0}) {
      const auto q = Eigen::Quaterniond::FromTwoVectors(side * axis.normalized(), Vector3d::UnitY());
      const FrameTruth truth{q, Vector3d::Zero(), 6.0 * static_cast<double>(from.radius_m())};
      const RangeGrid grid = lidar.true_ranges(truth, kRays, swath_m(from));
      for (int i = 0; i < kRays * kRays; ++i) {
        const double range_m = grid.range_m[static_cast<std::size_t>(i)];
        if (!std::isfinite(range_m)) continue;
        const Vector3d ray = Vector3d(grid.slope(i % kRays), 1.0, -grid.slope(i / kRays)).normalized();
        const Vector3d point_m = q.conjugate() * (range_m * ray - truth.range_m * Vector3d::UnitY());
        largest_m = std::max(largest_m, distance.distance_m(point_m.cast<float>()));
      }
    }
  }
  return static_cast<double>(largest_m);
}

// Each triangle with vertices of its own, as in an STL file.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  soup.name = mesh.name;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices_trf_m.size());
    for (const std::uint32_t corner : triangle) soup.vertices_trf_m.push_back(mesh.vertices_trf_m[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh block() {
  TriangleMesh mesh = box({2.0F, 1.2F, 0.8F});
  mesh.name = "block";
  return mesh;
}

void expect_counts(const Section& section, int vertices, int triangles, int edges) {
  expect_sound(section);
  EXPECT_EQ(section.mesh.vertices(), vertices);
  EXPECT_EQ(section.mesh.triangles(), triangles);
  EXPECT_EQ(section.mesh.edges(), edges);
}

TEST(SurfaceMeshSection, OfABoxHasItsCornersFacesAndEdges) {
  const Section section = section_of(block());
  expect_counts(section, 8, 12, 12);
  EXPECT_LE(section.mesh.error_mm(), 1);
  const double radius_m = static_cast<double>(block().radius_m());
  for (const Vector3f& corner : decoded(section.mesh, radius_m).vertices_trf_m)
    EXPECT_TRUE(corner.cwiseAbs().isApprox(Vector3f(1.0F, 0.6F, 0.4F), 1e-4F)) << corner.transpose();
  for (int i = 0; i < 12; ++i)
    EXPECT_NE(section.mesh.edge(i).opposite[0], section.mesh.edge(i).opposite[1]) << i;
}

TEST(SurfaceMeshSection, OfAFlatSheetHasItsRim) {
  TriangleMesh sheet;
  sheet.name = "sheet";
  for (int i = 0; i < 121; ++i)
    sheet.vertices_trf_m.emplace_back(0.1F * static_cast<float>(i % 11), 0.1F * static_cast<float>(i / 11),
                                      0.3F);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const std::uint32_t at = i / 10 * 11 + i % 10;
    sheet.triangles.push_back({at, at + 1, at + 12});
    sheet.triangles.push_back({at, at + 12, at + 11});
  }
  const Section section = section_of(sheet);
  expect_counts(section, 4, 4, 4);  // two triangles, each from both sides
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(section.mesh.edge(i).opposite[0], section.mesh.edge(i).opposite[1]) << i;
}

TEST(SurfaceMeshSection, OfOneTriangleIsThatTriangleFromBothSides) {
  TriangleMesh one;
  one.name = "one";
  one.vertices_trf_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.1F}, {0.0F, 1.0F, 0.1F}};
  one.triangles = {{0, 1, 2}};
  expect_counts(section_of(one), 3, 2, 3);  // from both sides
}

TEST(SurfaceMeshSection, JoinsTrianglesThatShareNoVertices) {
  TriangleMesh soup = soup_of(block());
  float offset_m = 0.0F;
  for (Vector3f& vertex : soup.vertices_trf_m) {
    offset_m = 3e-4F - offset_m;  // less than is welded
    vertex.x() += offset_m;
  }
  expect_counts(section_of(soup), 8, 12, 12);
}

TEST(SurfaceMeshSection, LeavesOutWhatIsRepeatedWithoutAreaOrInside) {
  TriangleMesh mesh = block();
  const TriangleMesh faces = mesh;
  append(mesh, faces);                    // repeated
  append(mesh, box({0.4F, 0.4F, 0.4F}));  // inside
  mesh.triangles.push_back({0, 1, 1});    // two corners
  mesh.vertices_trf_m.emplace_back(0.5F * (mesh.vertices_trf_m[0] + mesh.vertices_trf_m[1]));
  const auto middle = static_cast<std::uint32_t>(mesh.vertices_trf_m.size() - 1);
  mesh.triangles.push_back({0, middle, 1});            // three corners in a line
  mesh.vertices_trf_m.emplace_back(9.0F, 0.0F, 0.0F);  // in no triangle
  const double radius_m = static_cast<double>(block().radius_m());
  expect_counts({surface_mesh_section(mesh, radius_m)}, 8, 12, 12);
}

TEST(SurfaceMeshSection, DoesNotDependOnTheSideThatATriangleFaces) {
  TriangleMesh mesh = ball(1.0, 48);
  const int triangles = section_of(mesh).mesh.triangles();
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  EXPECT_NEAR(section_of(mesh).mesh.triangles(), triangles, 0.1 * triangles);
}

// Whichever way they are turned in the mesh that it is made of.
TEST(SurfaceMeshSection, TrianglesOfAClosedSurfaceFaceOutwards) {
  TriangleMesh mesh = ball(1.0, 48);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  for (const TriangleMesh& closed : {mesh, block()}) {
    const Section section = section_of(closed);
    const TriangleMesh seen = decoded(section.mesh, static_cast<double>(closed.radius_m()));
    for (const auto& [a, b, c] : seen.triangles) {
      const Vector3f first = seen.vertices_trf_m[a], second = seen.vertices_trf_m[b],
                     third = seen.vertices_trf_m[c];
      EXPECT_GT((second - first).cross(third - first).dot(first + second + third), 0.0F);
    }
  }
}

// The bottom of a box without a lid is seen from both sides, and so are its walls.
TEST(SurfaceMeshSection, TrianglesOfAnOpenBoxAreThereFromBothSides) {
  TriangleMesh open = block();
  const auto is_on_top = [&open](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&open](std::uint32_t corner) { return open.vertices_trf_m[corner].z() > 0.0F; });
  };
  open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(), is_on_top),
                       open.triangles.end());
  ASSERT_EQ(open.triangles.size(), 10U);
  expect_counts(section_of(open), 8, 20, 12);
}

TEST(SurfaceMeshSection, OnAnEdgeOfThreeFacesTheTwoThatAreFarthestApartCount) {
  TriangleMesh fin;  // on the plane z = 0 between x = -1 and 1, a fin at x = 0 that leans towards +x
  fin.name = "fin";
  fin.vertices_trf_m = {{0, -1, 0}, {0, 1, 0}, {-1, 0, -0.5F}, {1, 0, -0.5F}, {0.3F, 0, 1}};
  fin.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  const Section section = section_of(fin);
  expect_counts(section, 5, 6, 7);  // three triangles, each from both sides
  const TriangleMesh seen = decoded(section.mesh, static_cast<double>(fin.radius_m()));
  for (int i = 0; i < 7; ++i) {
    const SurfaceMesh::Edge edge = section.mesh.edge(i);
    if (edge.opposite[0] == edge.opposite[1]) continue;
    float z = 0.0F;
    for (const std::uint16_t corner : edge.opposite) z += seen.vertices_trf_m[corner].z();
    // The fin and the face on -x: 134 degrees; the two faces below: 127 degrees.
    EXPECT_NEAR(z, 0.5F, 1e-3F);
  }
}

TEST(SurfaceMeshSection, OfAFineBallKeepsItsShape) {
  const TriangleMesh mesh = ball(1.5, 256);
  const Section section = section_of(mesh);
  expect_sound(section);
  EXPECT_LT(section.mesh.triangles(), static_cast<int>(mesh.triangles.size()) / 10);
  EXPECT_LE(section.mesh.error_mm(), 25);
  // Without a rim: each edge has two triangles, 3/2 edges a triangle.
  EXPECT_LE(2 * section.mesh.edges(), 3 * section.mesh.triangles());
  for (int i = 0; i < section.mesh.edges(); ++i)
    ASSERT_NE(section.mesh.edge(i).opposite[0], section.mesh.edge(i).opposite[1]) << i;
}

class ShippedSurfaceMesh : public testing::TestWithParam<std::string> {};

TEST_P(ShippedSurfaceMesh, IsSoundAndItsErrorIsTrue) {
  const TriangleMesh mesh = target_by_name(GetParam());
  const Section section = section_of(mesh);
  expect_sound(section);
  const TriangleMesh simple = decoded(section.mesh, static_cast<double>(mesh.radius_m()));
  const double found_m = std::max(largest_distance_m(simple, mesh), largest_distance_m(mesh, simple));
  // Other points than those that were measured may lie somewhat farther away.
  EXPECT_LE(1e3 * found_m, 1.2 * section.mesh.error_mm() + 2.0);
  EXPECT_GE(1e3 * found_m, 0.3 * section.mesh.error_mm());
}

INSTANTIATE_TEST_SUITE_P(Targets, ShippedSurfaceMesh, testing::ValuesIn(target_names()),
                         [](const auto& target) { return target.param; });

TEST(SurfaceMeshSection, OfManyTrianglesFitsWithinSeconds) {
  TriangleMesh mesh;  // bumps of 40 mm, which no few triangles describe
  mesh.name = "rough";
  constexpr int kSide = 317;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = 4.0 * (i % kSide) / (kSide - 1) - 2.0, y = 4.0 * (i / kSide) / (kSide - 1) - 2.0;
    const double z = 0.04 * std::sin(40.0 * x) * std::sin(37.0 * y);
    mesh.vertices_trf_m.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  for (std::uint32_t i = 0; i < (kSide - 1) * (kSide - 1); ++i) {
    const std::uint32_t at = i / (kSide - 1) * kSide + i % (kSide - 1);
    mesh.triangles.push_back({at, at + 1, at + kSide + 1});
    mesh.triangles.push_back({at, at + kSide + 1, at + kSide});
  }
  ASSERT_GT(mesh.triangles.size(), 199'000U);
  const Section section = section_of(mesh);
  expect_sound(section);
  EXPECT_GT(section.mesh.triangles(), 1000);
  // The height of the bumps and half of it: each triangle of a sheet counts twice, once for each side.
  EXPECT_LE(section.mesh.error_mm(), 120);
}

TEST(SurfaceMeshSection, OfTrianglesThatShareNothingFitsToo) {
  TriangleMesh mesh;  // 20,000 separate chips on a ball
  mesh.name = "chips";
  const TriangleMesh whole = ball(1.5, 144);
  for (const auto& [a, b, c] : whole.triangles) {
    const Vector3f middle =
        (whole.vertices_trf_m[a] + whole.vertices_trf_m[b] + whole.vertices_trf_m[c]) / 3.0F;
    const auto first = static_cast<std::uint32_t>(mesh.vertices_trf_m.size());
    for (const std::uint32_t corner : {a, b, c})
      mesh.vertices_trf_m.push_back(0.8F * whole.vertices_trf_m[corner] + 0.2F * middle);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  ASSERT_GT(mesh.triangles.size(), 20'000U);
  const Section section = section_of(mesh);
  expect_sound(section);
  EXPECT_GT(section.mesh.triangles(), 100);
  EXPECT_LE(section.mesh.error_mm(), 300);
}

TEST(SurfaceMeshSection, LimitsCoordinatesToTheRadiusAndStatesTheError) {
  const Section section{surface_mesh_section(block(), 0.5)};
  ASSERT_TRUE(SurfaceMesh::is_sound(section.bytes.data(), section.bytes.size()));
  for (int i = 0; i < section.mesh.vertices(); ++i) {
    for (const std::int16_t coordinate : section.mesh.vertex(i))
      EXPECT_LE(std::abs(coordinate), SurfaceMesh::kRadius);
  }
  EXPECT_NEAR(section.mesh.error_mm(), 510, 15)
      << "corners at (1, 0.6, 0.4) m are moved to (0.5, 0.5, 0.4) m";
}

TEST(SurfaceMeshSection, IsTheSameEveryTime) {
  EXPECT_EQ(section_of(ball(1.0, 48)).bytes, section_of(ball(1.0, 48)).bytes);
}

TEST(SurfaceMeshSection, NeedsASurfaceAndARadius) {
  EXPECT_THROW((void)surface_mesh_section(TriangleMesh{}, 1.0), std::invalid_argument);
  TriangleMesh line;
  line.vertices_trf_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW((void)surface_mesh_section(line, 2.0), std::invalid_argument);
  EXPECT_THROW((void)surface_mesh_section(block(), 0.0), std::invalid_argument);
  EXPECT_THROW((void)surface_mesh_section(block(), 1e6), std::invalid_argument) << "smaller than a unit";
}

#else

TEST(SurfaceMeshSection, NeedsMeshoptimizer) {
  try {
    (void)surface_mesh_section(box({1.0F, 1.0F, 1.0F}), 1.0);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("libmeshoptimizer-dev"), std::string::npos);
  }
}

#endif

TEST(MeshDistance, IsToTheInsideAnEdgeOrACorner) {
  const Vector3f a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(closest_point({0.2F, 0.2F, 3.0F}, a, b, c).isApprox(Vector3f(0.2F, 0.2F, 0.0F)));
  EXPECT_TRUE(closest_point({0.4F, -2.0F, 1.0F}, a, b, c).isApprox(Vector3f(0.4F, 0.0F, 0.0F)));
  EXPECT_TRUE(closest_point({1.0F, 1.0F, 1.0F}, a, b, c).isApprox(Vector3f(0.5F, 0.5F, 0.0F)));
  EXPECT_TRUE(closest_point({3.0F, -1.0F, 1.0F}, a, b, c).isApprox(b));
  EXPECT_TRUE(closest_point({0.5F, 1.0F, 0.0F}, a, b, a).isApprox(Vector3f(0.5F, 0.0F, 0.0F)));
}

TEST(MeshDistance, IsToTheNearestTriangle) {
  const TriangleMesh mesh = ball(1.0, 64);
  const MeshDistance distance(mesh);
  for (const float radius_m : {0.2F, 0.9F, 1.5F, 20.0F}) {
    const Vector3f point_m = radius_m * Vector3f(1.0F, 2.0F, -2.0F) / 3.0F;
    EXPECT_NEAR(distance.distance_m(point_m), std::abs(radius_m - 1.0F), 2e-3F);
  }
  EXPECT_NEAR(distance.largest_distance_m({{2, 0, 0}, {0, 0, 3}, {0, 1, 0}}), 2.0F, 1e-5F);
}

TEST(MeshSimplification, WeldsWithinTheDistanceOnly) {
  TriangleMesh mesh;
  mesh.vertices_trf_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.9e-3F}, {1, 0, 1.1e-3F}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 1, 2}, {3, 4, 2}, {0, 3, 1}};
  const TriangleMesh result = welded(mesh, 1e-3);
  EXPECT_EQ(result.vertices_trf_m.size(), 4U) << "the unused one is left out";
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 3, 2}};
  EXPECT_EQ(result.triangles, expected);
}

TEST(MeshSimplification, TurnsNeighboursTheSameWay) {
  TriangleMesh mesh = welded(ball(1.0, 24), 1e-3);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  std::set<std::array<std::uint32_t, 2>> directed;
  for (const auto& triangle : oriented(mesh).triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(directed.insert({triangle[k], triangle[(k + 1) % 3]}).second);
  }
}

}  // namespace
}  // namespace tumblesight::sim
