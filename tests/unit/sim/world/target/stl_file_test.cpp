#include "sim/world/target/stl_file.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "tests/unit/sim/world/target/refused_text.hpp"

namespace tumblesight::sim {
namespace {

const MeshFileOptions kAsIs{MeshUp::kZ, 1.0};

std::string facet(const std::string& normal = "0 0 1", const std::string& last = "0 1 0") {
  return "facet normal " + normal + "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex " + last +
         "\nendloop\nendfacet\n";
}

std::string solid(const std::string& name, int facets) {
  std::string text = "solid " + name + "\n";
  for (int i = 0; i < facets; ++i) text += facet();
  return text + "endsolid " + name + "\n";
}

// `z`: of every corner.
std::string binary(const std::string& title, std::uint32_t announced, int triangles, float z = 0.0F) {
  std::string bytes = title;
  bytes.resize(80, '\0');
  bytes.append(reinterpret_cast<const char*>(&announced), 4);
  for (int i = 0; i < triangles; ++i) {
    const float numbers[12] = {0, 0, 0, 0, 0, z, 1, 0, z, 0, 1, z};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append(2, '\0');
  }
  return bytes;
}

std::size_t triangles_of(const std::string& bytes) {
  return read_stl(bytes, kAsIs).triangles.size();
}

void expect_refused(const std::string& bytes, const std::vector<std::string>& parts) {
  expect_refusal([&] { (void)read_stl(bytes, kAsIs); }, parts);
}

TEST(StlFile, AllSolidsAreReadEmptyOnesAmongThem) {
  EXPECT_EQ(triangles_of(solid("a", 2) + solid("", 0) + solid("c d", 3)), 5U);
}

TEST(StlFile, LinesMayEndInAnyWayAndWordsMayBeInCapitals) {
  std::string text = solid("CRAFT", 2);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(triangles_of(text), 2U);
  std::string of_windows, of_old_macs, in_one_line;
  for (const char c : solid("craft", 2)) {
    of_windows += c == '\n' ? "\r\n" : std::string(1, c);
    of_old_macs += c == '\n' ? '\r' : c;
    in_one_line += c == '\n' ? ' ' : c;
  }
  EXPECT_EQ(triangles_of(of_windows), 2U);
  EXPECT_EQ(triangles_of(of_old_macs), 2U);
  EXPECT_EQ(triangles_of(in_one_line), 2U);
  EXPECT_EQ(triangles_of(solid("craft", 2) + "\x1a"), 2U);
}

TEST(StlFile, ASolidMayBeNamedAsAFacet) {
  for (const char* name : {"facet normal", "facet", "my facet normal craft", "facet normal vertex 1 2 3"}) {
    EXPECT_EQ(triangles_of(solid(name, 2)), 2U) << name;
  }
  for (const char* normal : {"0 0 1", "nan nan nan", ""}) {
    std::string in_one_line;
    for (const char c : "solid facet normal " + facet(normal) + facet(normal) + "endsolid\n")
      in_one_line += c == '\n' ? ' ' : c;
    EXPECT_EQ(triangles_of(in_one_line), 2U) << normal;
  }
}

TEST(StlFile, NormalsAreNotUsedWhateverTheyAre) {
  for (const char* normal :
       {"nan nan nan", "-nan(ind) -nan(ind) -nan(ind)", "1.#QNAN 0 0", "0,0 0,0 1,0", ""})
    EXPECT_EQ(triangles_of("solid a\n" + facet(normal) + "endsolid a\n"), 1U) << normal;
}

TEST(StlFile, TextThatIsCutOffAnywhereIsRefused) {
  const std::string whole = solid("craft", 3);
  for (std::size_t bytes = 6; bytes < whole.size() - 15; ++bytes)
    EXPECT_THROW((void)read_stl(whole.substr(0, bytes), kAsIs), std::runtime_error) << bytes;
  expect_refused(whole.substr(0, whole.size() / 2),
                 {"line 12", "before 'endsolid'", "1 triangle", "cut off"});
}

TEST(StlFile, WhatIsWrongInTextIsNamedWithItsLine) {
  expect_refused("solid a\n" + facet("0 0 1", "0 nan 0") + "endsolid\n", {"1 of 3", "not finite", "line 6"});
  expect_refused("solid a\n" + facet("0 0 1", "0 1e400 0") + "endsolid\n",
                 {"1 of 3", "not finite", "line 6"});
  expect_refused("solid a\n" + facet("0 0 1", "0 1,5 0") + "endsolid\n",
                 {"line 6", "'1,5'", "decimal point"});
  expect_refused("solid a\n" + facet("0 0 1", std::string(30000, 'x')) + "endsolid\n", {"line 6", "'xxx"});
  expect_refused("solid a\n" + facet("0 0 1", "0 1 0\nvertex 1 1 0") + "endsolid\n",
                 {"line 7", "more than 3"});
  expect_refused("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid\n",
                 {"line 6", "1 vertices instead of 3"});
}

TEST(StlFile, WhatStlDoesNotDefineIsCountedBetweenFacetsOnly) {
  const TriangleMesh mesh = read_stl("solid a\ncolor 1 0 0\n" + facet() + "endsolid\n", kAsIs);
  EXPECT_EQ(mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_NE(mesh.notes.front().find("line 2"), std::string::npos) << mesh.notes.front();
}

TEST(StlFile, ABinaryFileMayBeginWithSolid) {
  EXPECT_EQ(triangles_of(binary("solid made by some CAD", 3, 3)), 3U);
}

TEST(StlFile, BytesAfterTheLastTriangleAreCounted) {
  for (const char* title : {"craft", "solid craft"}) {
    for (const std::string& more :
         {std::string("end of file\n"), std::string(37, '\0'), std::string(512, '\0')}) {
      const TriangleMesh mesh = read_stl(binary(title, 3, 3) + more, kAsIs);
      EXPECT_EQ(mesh.triangles.size(), 3U);
      ASSERT_EQ(mesh.notes.size(), 1U);
      EXPECT_NE(mesh.notes.front().find(std::to_string(more.size())), std::string::npos)
          << mesh.notes.front();
    }
  }
}

TEST(StlFile, ACountThatDiffersIsRefusedWithTheNumbers) {
  expect_refused(binary("craft", 2, 5, 1.0F),
                 {"announces 2 triangles", "184 bytes", "334 bytes", "150 too many"});
  expect_refused(binary("craft", 5, 2), {"announces 5 triangles", "334 bytes", "184 bytes", "150 too few"});
  expect_refused(binary("craft", 0xFFFFFFFFU, 2), {"announces 4294967295 triangles", "cut off"});
  expect_refused(binary("craft", 3, 3).substr(0, 50), {"50", "84"});
  expect_refused("hello world" + std::string(200, ' '), {"no STL file", "solid"});
}

TEST(StlFile, ACornerThatIsNotFiniteIsNamedWithItsTriangle) {
  const std::string bad = binary("", 1, 1, std::numeric_limits<float>::infinity()).substr(84);
  expect_refused(binary("craft", 3, 2) + bad, {"3 of 9", "not finite", "triangle 3", "inf"});
}

}  // namespace
}  // namespace tumblesight::sim
