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
  EXPECT_EQ(read(kFour + "f 1 2 3 \\").triangles.size(), 1U);
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
