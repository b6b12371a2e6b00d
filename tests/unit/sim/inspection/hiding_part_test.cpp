#include "sim/inspection/hiding_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/world/target/panels.hpp"
#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

// Round bolts on the top of the body, each a closed convex part of its own.
TriangleMesh with_bolts(TriangleMesh mesh, int per_side) {
  for (int i = 0; i < per_side * per_side; ++i) {
    const float x = static_cast<float>(i % per_side) / static_cast<float>(per_side) - 0.5F;
    const float y = static_cast<float>(i / per_side) / static_cast<float>(per_side) - 0.5F;
    append(mesh, moved(frustum(24, 0.002F, 0.002F, 0.8F, 0.81F), {x, 0.9F * y, 0.0F}));
  }
  return mesh;
}

TriangleMesh dome() {
  Outline profile;
  for (int i = 0; i <= 32; ++i) {
    const float angle = 3.14159265F * static_cast<float>(i) / 32.0F;
    profile.push_back({i == 0 || i == 32 ? 0.0F : 8.0F * std::sin(angle), -8.0F * std::cos(angle)});
  }
  return revolve(profile, 64);
}

// Each cover that is tried costs a pass over the whole mesh.
TEST(HidingPart, OfThousandsOfPartsAHandfulIsTried) {
  const TriangleMesh mesh = with_bolts(sound_mesh(), 55);
  const auto parts = connected_parts(mesh);
  ASSERT_GT(parts.size(), 3000U);
  EXPECT_LE(possible_covers(mesh, parts, std::nullopt).size(), kMostCovers);
  EXPECT_FALSE(hiding_part(mesh, std::nullopt).has_value());
}

// Many parts that could all be a cover by their boxes.
TEST(HidingPart, OfManyLargePartsNoMoreIsTried) {
  TriangleMesh mesh;
  for (int i = 0; i < 500; ++i)
    append(mesh, box_at(0.001F * static_cast<float>(i), 0.0F, 0.0F, {2.0F, 2.0F, 2.0F}));
  EXPECT_EQ(possible_covers(mesh, connected_parts(mesh), std::nullopt).size(), kMostCovers);
}

TEST(HidingPart, AmongThousandsOfPartsTheCoverIsFound) {
  const TriangleMesh bolted = with_bolts(sound_mesh(), 55);
  const TriangleMesh mesh = with(bolted, dome());
  const auto found = hiding_part(mesh, std::nullopt);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->triangles.front(), bolted.triangles.size());
  EXPECT_EQ(found->triangles.size(), dome().triangles.size());
  EXPECT_DOUBLE_EQ(found->hidden, 1.0);
}

// Small next to the parts around it, and yet tried.
TEST(HidingPart, AMarkerIsAlwaysTried) {
  TriangleMesh mesh = with(sound_mesh(), box({2.0F, 2.0F, 2.0F}));
  for (int i = 0; i < 300; ++i)
    append(mesh, box_at(0.001F * static_cast<float>(i), 0.0F, 0.0F, {0.1F, 9.0F, 9.0F}));
  const auto marker = marker_cube(mesh);
  ASSERT_TRUE(marker.has_value());
  const auto parts = connected_parts(mesh);
  const auto covers = possible_covers(mesh, parts, marker);
  const auto tried = [&](std::size_t part) { return parts[part] == marker->triangles; };
  EXPECT_TRUE(std::any_of(covers.begin(), covers.end(), tried));
}

// The share is measured by points that are spread over the rest. Of a body whose half is inside it is a half,
// whatever the sizes of the triangles and of the cover.
TEST(HidingPart, TheShareIsThatOfTheArea) {
  for (const float width : {1.02F, 100.0F}) {
    const TriangleMesh inside = box({1.0F, 1.0F, 1.0F});
    const TriangleMesh outside = box_at(3.0F + width, 0.0F, 0.0F, {0.5F, 1.0F, 1.0F});
    const auto found = hiding_part(with(with(inside, outside), box({width, width, width})),
                                   MarkerCube{{24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35}, width});
    ASSERT_TRUE(found.has_value());
    EXPECT_TRUE(found->is_marker);
    EXPECT_NEAR(found->rest_m2, 10.0, 1e-5);
    EXPECT_NEAR(found->hidden, 0.6, 0.002);
  }
}

}  // namespace
}  // namespace tumblesight::sim
