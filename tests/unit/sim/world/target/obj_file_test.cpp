#include "sim/world/target/obj_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"
#include "tests/unit/sim/world/target/refused_text.hpp"

namespace tumblesight::sim {
namespace {

const MeshFileOptions kAsIs{MeshUp::kZ, 1.0};
const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TriangleMesh read(const std::string& text, const std::string& path = "nowhere/craft.obj") {
  return read_obj(text, path, kAsIs);
}

void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
  expect_refusal([&] { (void)read(text); }, parts);
}

TEST(ObjFile, CornersAreNamedInEveryWay) {
  for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/9/9 2/9/9 3/9/9",
                           "f -4 -3 -2", "  f\t1  2 3  ", "f 1 2 3 # a triangle", "fo 1 2 3"}) {
    const TriangleMesh mesh = read(kFour + face + "\n");
    ASSERT_EQ(mesh.triangles.size(), 1U) << face;
    EXPECT_EQ(mesh.vertices_trf_m[2], Eigen::Vector3f(1, 1, 0)) << face;
  }
  EXPECT_EQ(read("f 1 2 3\n" + kFour).triangles.size(), 1U) << "vertices may follow";
  EXPECT_EQ(read("v 2 0 0 2\nv 0 1 0 1 0 0\nv 0 0 1 1 0 0 1\nf 1 2 3\n").vertices_trf_m[0],
            Eigen::Vector3f(1, 0, 0))
      << "weights and colours";
}

TEST(ObjFile, PointsLinesAndUnknownStatementsAreLeftOut) {
  const TriangleMesh mesh = read(kFour + "p 1 2\nl 1 2\nf 1 2\nf 1\ncurv 0 1 1 2\nvp 0 0\ns off\nf 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_EQ(mesh.notes.front(), "2 statements of lines and 2 of points left out: no ray hits them");
}

TEST(ObjFile, ABackslashJoinsLinesAndACommentEndsWithItsLine) {
  EXPECT_EQ(read(kFour + "f 1 \\\n2 \\\r\n3\n").triangles.size(), 1U);
  EXPECT_EQ(read(kFour + "# from D:\\cad\\\nf 1 2 3\n").triangles.size(), 1U);
  EXPECT_EQ(read(kFour + "f 1 2 3 # from D:\\cad\\\nf 1 3 4\n").triangles.size(), 2U);
}

TEST(ObjFile, ANameMayEndInABackslash) {
  for (const char* name : {"usemtl a\\", "g C:\\parts\\", "o C:\\parts\\", "mtllib C:\\a.mtl\\"}) {
    EXPECT_EQ(read(kFour + name + "\nf 1 2 3\nf 1 3 4\n").triangles.size(), 2U) << name;
    EXPECT_EQ(read(std::string(name) + "\n" + kFour + "f 1 2 3\nf 1 3 4\n").triangles.size(), 2U) << name;
  }
  EXPECT_EQ(read(kFour + "g front \\\nleft side\nf 1 2 3\n").triangles.size(), 1U) << "names go on";
}

TEST(ObjFile, ACommentNeedsNoBlankBeforeIt) {
  EXPECT_EQ(read("v 0 0 0#a\nv 1 0 0#1\nv 1 1 -0.5# b\nf 1 2 3#c\n").triangles.size(), 1U);
  EXPECT_EQ(read(kFour + "usemtl Panel#2\nf 1 2 3\n").is_panel.size(), 1U) << "names may hold one";
  expect_refused("v 0 0 0\nv -1.#IND 0 0\nv 1 1 0\nf 1 2 3\n", {"1 of 3", "not finite", "line 2"});
}

// A grid of `side` x `side` squares, each of two triangles.
std::string grid(int side, int first = 1) {
  std::string text;
  for (int i = 0; i <= side; ++i) {
    for (int k = 0; k <= side; ++k) text += "v " + std::to_string(i) + " " + std::to_string(k) + " 0\n";
  }
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) {
      const int a = first + i * (side + 1) + k, b = a + side + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) + "\n";
      text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(b + 1) + "\n";
    }
  }
  return text;
}

// All but the end of the last rows, where every vertex is in use and only the missing line end tells.
TEST(ObjFile, AFileThatIsCutOffInItsFacesIsRefused) {
  const std::string whole = grid(20);
  const std::size_t faces = whole.find("f "), most = faces + (whole.size() - faces) * 85 / 100;
  for (std::size_t bytes = faces; bytes < most; bytes += 7) {
    if (whole[bytes - 1] == '\n') continue;
    EXPECT_THROW((void)read(whole.substr(0, bytes)), std::runtime_error) << bytes;
  }
  expect_refused(whole.substr(0, whole.find("\nf 200 ")),
                 {"cut off", "no line end", "of 441 vertices", "copy or export"});
  expect_refused(whole.substr(0, whole.size() - 4), {"cut off", "line 1241", "not complete"});
  expect_refused(kFour + "f 1/1 2/2 3/3\nf 1/1 3/3 4", {"cut off", "line 6", "not complete"});
  expect_refused(kFour + "f 1 2 3\nf 1 3 4\nuse", {"cut off", "line 7", "not complete"});
  expect_refused(kFour + "f 1 2 3 \\", {"cut off", "not complete"});
}

TEST(ObjFile, ACutWithinTheLastNumberIsRefused) {
  const std::string whole = grid(20);
  expect_refused(whole.substr(0, whole.size() - 2), {"cut off", "vertex 44,", "line 1241"});
  expect_refused(whole.substr(0, whole.size() - 3), {"cut off", "vertex 4,"});
}

TEST(ObjFile, AFileThatIsCutOffInALaterObjectIsRefused) {
  const std::string first = grid(20), second = grid(3, 442);
  for (std::size_t bytes = 1; bytes < second.size() * 3 / 4; bytes += 3) {
    if (second[bytes - 1] == '\n') continue;
    EXPECT_THROW((void)read(first + second.substr(0, bytes)), std::runtime_error) << bytes;
  }
}

TEST(ObjFile, AWholeFileWithoutALastLineEndIsReadWithANote) {
  for (std::string whole : {grid(20), grid(20) + grid(3, 442), kFour + "f 1 2 3 4\n# end\n"}) {
    whole.pop_back();
    const TriangleMesh mesh = read(whole);
    EXPECT_EQ(mesh.triangles.size(), read(whole + "\n").triangles.size());
    ASSERT_EQ(mesh.notes.size(), 1U);
    EXPECT_NE(mesh.notes.front().find("no line end"), std::string::npos) << mesh.notes.front();
    EXPECT_TRUE(read(whole + "\n").notes.empty());
    EXPECT_TRUE(read(whole + "\n\x1a").notes.empty());
  }
}

TEST(ObjFile, ManyVerticesOfNoFaceAreALoss) {
  const std::string whole = grid(20);
  const TriangleMesh mesh = read(whole.substr(0, whole.find("f 180 ")));
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_NE(mesh.losses.front().find("of 441 vertices belong to no face"), std::string::npos)
      << mesh.losses.front();
  EXPECT_EQ(read(whole + grid(3).substr(0, grid(3).find("f "))).losses.size(), 1U) << "a second object";
  EXPECT_TRUE(read(kFour + kFour + "l 5 6 7\np 8\nf 1 2 3\n").losses.empty()) << "lines and points";
  EXPECT_TRUE(read(whole + "v 1 2 3\n").losses.empty());
}

TEST(ObjFile, WhatIsWrongIsNamedWithItsLine) {
  expect_refused(kFour + "f 1 2 99\n", {"line 5", "vertex 99", "has 4"});
  expect_refused(kFour + "f 1 2 -9\n", {"line 5", "-9", "has 4"});
  expect_refused(kFour + "f 1 2 0\n", {"line 5", "'0'", "begin at 1"});
  expect_refused(kFour + "f 1 2 x\n", {"line 5", "'x'"});
  expect_refused(kFour + "f 1 2 " + std::string(50000, 'y') + "\n", {"line 5", "'yyy"});
  expect_refused("v 0 0\n", {"line 1", "2 coordinates instead of 3"});
  expect_refused("v 0,5 0 0\n", {"line 1", "'0,5'", "decimal point"});
  expect_refused("v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n", {"1 of 3", "not finite", "line 2"});
  expect_refused(kFour + "cstype bezier\nsurf 0 1 0 1 1 2 3 4\n", {"line 6", "free-form", "'surf'"});
  expect_refused(std::string("\x7f"
                             "ELF\0\0\0",
                             7),
                 {"is text"});
}

TEST(ObjFile, AVertexThatIsNotFiniteAndNotUsedIsNoFault) {
  EXPECT_EQ(read("v nan 0 0\n" + kFour + "f 2 3 4\n").triangles.size(), 1U);
}

// 20 teeth of a comb: a concave polygon of 42 corners.
TEST(ObjFile, AConcavePolygonKeepsItsArea) {
  std::string text = "v 0 0 0\nv 4 0 0\n", face = "f 1 2";
  for (int i = 0; i < 20; ++i) {
    const double x = 4.0 - 0.2 * i, y = i % 2 == 0 ? 2.0 : 0.3;
    text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\nv " + std::to_string(x - 0.2) + " " +
            std::to_string(y) + " 0\n";
  }
  for (int i = 3; i <= 42; ++i) face += " " + std::to_string(i);
  for (const std::string& closing : {std::string(), std::string(" 1")}) {
    const TriangleMesh mesh = read(text + face + closing + "\n");
    EXPECT_EQ(mesh.triangles.size(), 40U);
    EXPECT_NEAR(area_m2(mesh), 4.0 * 0.3 + 2.0 * 1.7, 1e-5);
    EXPECT_TRUE(mesh.losses.empty());
  }
}

TEST(ObjFile, APolygonThatCannotBeDividedIsALossWithItsShare) {
  const TriangleMesh mesh =
      read(kFour + "v 2 0 0\nv 3 0 0\nv 4 0 0\nv 5 0 0\nv 6 0 0\nf 1 2 3 4\nf 5 6 7 8 9\n");
  EXPECT_EQ(mesh.triangles.size(), 3U);
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_NE(mesh.losses.front().find("1 polygon of 2"), std::string::npos) << mesh.losses.front();
  EXPECT_NE(mesh.losses.front().find("line 11"), std::string::npos) << mesh.losses.front();
}

// The order by which shipped and adopted meshes were always read.
TEST(ObjFile, TrianglesComeMaterialByMaterialInTheOrderOfTheLibrary) {
  const TemporaryFolder here;
  std::ofstream(here.path("craft.mtl")) << "newmtl second\nnewmtl first\n";
  const std::string faces =
      "usemtl first\nf 1 2 3\nusemtl third\nf 2 3 4\nusemtl second\nf 3 4 1\nusemtl first\nf 4 1 2\n";
  const auto starts = [](const TriangleMesh& mesh) {
    std::string text;
    for (const auto& triangle : mesh.triangles)
      text += std::to_string(
          static_cast<int>(mesh.vertices_trf_m[triangle[0]].x() + 2 * mesh.vertices_trf_m[triangle[0]].y()));
    return text;
  };
  EXPECT_EQ(starts(read("mtllib craft.mtl\n" + kFour + faces, here.path("craft.obj"))), "3021");
  EXPECT_EQ(starts(read("mtllib absent.mtl\n" + kFour + faces)), "0213") << "of their first use";
}

TEST(ObjFile, PanelsAreKnownByTheNamesOfTheirMaterials) {
  const TriangleMesh mesh = read(kFour + "f 1 2 3\nusemtl Solar Cells\nf 1 3 4\n");
  EXPECT_EQ(mesh.is_panel, (std::vector<std::uint8_t>{0, 1}));
}

}  // namespace
}  // namespace tumblesight::sim
