#include "gnc/surface/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

namespace tumblesight::gnc {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes section_of(std::initializer_list<int> numbers) {
  Bytes bytes;
  for (const int number : numbers) {
    bytes.push_back(static_cast<std::uint8_t>(number));
    bytes.push_back(static_cast<std::uint8_t>(number >> 8));
  }
  return bytes;
}

bool is_sound(const Bytes& section) {
  return SurfaceMesh::is_sound(section.data(), section.size());
}

// Two triangles that share an edge.
constexpr std::initializer_list<int> kFold{
    4,  2, 5,  300,                                                                   // counts and error
    -1, 2, -3, 32767, -32767, 256, 0, 0, 0, -32768, 1, 127,                           // vertices
    0,  1, 2,  2,     1,      3,                                                      // triangles
    1,  2, 0,  3,     0,      1,   2, 2, 0, 2,      1, 1,   1, 3, 2, 2, 2, 3, 1, 1};  // edges

// A section of zeros with these counts.
Bytes zeros(int vertices, int triangles, int edges) {
  Bytes section = section_of({vertices, triangles, edges, 0});
  section.resize(section.size() + static_cast<std::size_t>(6 * vertices + 6 * triangles + 8 * edges));
  return section;
}

TEST(SurfaceMesh, IsNotKnownWithoutASection) {
  const SurfaceMesh mesh;
  EXPECT_FALSE(mesh.is_known());
  EXPECT_EQ(mesh.vertices(), 0);
  EXPECT_EQ(mesh.triangles(), 0);
  EXPECT_EQ(mesh.edges(), 0);
}

TEST(SurfaceMesh, IsNotKnownWithAnEmptySection) {
  const Bytes section = zeros(0, 0, 0);
  ASSERT_TRUE(is_sound(section));
  EXPECT_FALSE(SurfaceMesh(section.data()).is_known());
}

TEST(SurfaceMesh, ReadsEveryNumberOfASection) {
  const Bytes section = section_of(kFold);
  ASSERT_TRUE(is_sound(section));
  const SurfaceMesh mesh(section.data());
  EXPECT_TRUE(mesh.is_known());
  EXPECT_EQ(mesh.vertices(), 4);
  EXPECT_EQ(mesh.triangles(), 2);
  EXPECT_EQ(mesh.edges(), 5);
  EXPECT_EQ(mesh.error_mm(), 300);
  EXPECT_EQ(mesh.vertex(0), (SurfaceMesh::Vertex{-1, 2, -3}));
  EXPECT_EQ(mesh.vertex(1), (SurfaceMesh::Vertex{32767, -32767, 256}));
  EXPECT_EQ(mesh.vertex(3), (SurfaceMesh::Vertex{-32768, 1, 127}));
  EXPECT_EQ(mesh.triangle(0), (SurfaceMesh::Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangle(1), (SurfaceMesh::Triangle{2, 1, 3}));
  const SurfaceMesh::Edge shared = mesh.edge(0), last = mesh.edge(4);
  EXPECT_EQ(shared.first, 1);
  EXPECT_EQ(shared.second, 2);
  EXPECT_EQ(shared.opposite, (std::array<std::int32_t, 2>{0, 3}));
  EXPECT_EQ(last.first, 2);
  EXPECT_EQ(last.second, 3);
  EXPECT_EQ(last.opposite, (std::array<std::int32_t, 2>{1, 1}));
}

TEST(SurfaceMesh, SectionOfAnyShorterSizeIsUnsound) {
  const Bytes section = section_of(kFold);
  for (std::size_t size = 0; size < section.size(); ++size) {
    const Bytes shorter(section.begin(), section.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(is_sound(shorter)) << size;
  }
}

TEST(SurfaceMesh, SectionMayBeFollowedByOtherBytes) {
  Bytes section = section_of(kFold);
  section.resize(section.size() + 100, 0xFF);
  EXPECT_TRUE(is_sound(section));
}

TEST(SurfaceMesh, LargestCountsAreSound) {
  const Bytes section = zeros(SurfaceMesh::kMaxVertices, SurfaceMesh::kMaxTriangles, SurfaceMesh::kMaxEdges);
  EXPECT_EQ(section.size(), SurfaceMesh::kMaxBytes);
  EXPECT_TRUE(is_sound(section));
}

TEST(SurfaceMesh, CountAboveItsLimitIsUnsound) {
  EXPECT_FALSE(is_sound(zeros(SurfaceMesh::kMaxVertices + 1, 1, 1)));
  EXPECT_FALSE(is_sound(zeros(1, SurfaceMesh::kMaxTriangles + 1, 1)));
  EXPECT_FALSE(is_sound(zeros(1, 1, SurfaceMesh::kMaxEdges + 1)));
  EXPECT_FALSE(is_sound(zeros(65535, 1, 1)));
  EXPECT_FALSE(is_sound(zeros(1, 65535, 1)));
  EXPECT_FALSE(is_sound(zeros(1, 1, 65535)));
}

TEST(SurfaceMesh, NumberOfAVertexThatDoesNotExistIsUnsound) {
  const Bytes sound = section_of(kFold);
  constexpr std::size_t kFirst = 8 + 6 * 4;
  for (std::size_t at = kFirst; at < sound.size(); at += 2) {
    for (const int number : {4, 5, 0x0100, 0x8000, 0xFFFF}) {
      Bytes section = sound;
      section[at] = static_cast<std::uint8_t>(number);
      section[at + 1] = static_cast<std::uint8_t>(number >> 8);
      EXPECT_FALSE(is_sound(section)) << at << ": " << number;
    }
  }
}

TEST(SurfaceMesh, TrianglesAndEdgesNeedVertices) {
  EXPECT_FALSE(is_sound(zeros(0, 1, 0)));
  EXPECT_FALSE(is_sound(zeros(0, 0, 1)));
  EXPECT_TRUE(is_sound(zeros(1, 1, 1)));
}

}  // namespace
}  // namespace tumblesight::gnc
