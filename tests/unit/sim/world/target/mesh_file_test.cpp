#include "sim/world/target/mesh_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

// A wedge whose bounding box differs along every axis, which reveals swapped or mirrored axes: corners
// (0,0,0), (1,0,0), (0,2,0), (0,0,3) of the file's axes.
constexpr float kWedge[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
constexpr std::uint16_t kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

template <typename T>
void put(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string stl(const std::vector<std::vector<float>>& triangles) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(triangles.size()));
  for (const std::vector<float>& corners : triangles) {
    bytes.append(12, '\0');  // normal
    for (const float c : corners) {
      put(bytes, c);
    }
    bytes.append(2, '\0');  // attributes
  }
  return bytes;
}

std::vector<std::vector<float>> wedge_triangles(float scale = 1.0F) {
  std::vector<std::vector<float>> triangles;
  for (const auto& face : kFaces) {
    std::vector<float>& corners = triangles.emplace_back();
    for (const std::uint16_t vertex : face) {
      for (const float c : kWedge[vertex]) {
        corners.push_back(scale * c);
      }
    }
  }
  return triangles;
}

[[maybe_unused]] std::string obj() {
  std::string text;
  for (const auto& v : kWedge) {
    text += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
  }
  for (const auto& f : kFaces) {
    text += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
            std::to_string(f[2] + 1) + "\n";
  }
  return text;
}

[[maybe_unused]] std::string gltf_buffer() {
  std::string bytes;
  for (const auto& v : kWedge) {
    for (const float c : v) {
      put(bytes, c);
    }
  }
  for (const auto& f : kFaces) {
    for (const std::uint16_t i : f) {
      put(bytes, i);
    }
  }
  return bytes;
}

// The wedge at half size under a node that doubles it and moves it by (0.5, 0, 0).
[[maybe_unused]] std::string gltf(const std::string& buffer_uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[0.5,0,0]},{"mesh":0,"scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,2,3]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"buffers":[{"uri":")" +
         buffer_uri + R"(","byteLength":72}]})";
}

// Two triangles, the second one of another material.
[[maybe_unused]] std::string obj_with_materials(const std::string& second) {
  return "mtllib file.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl bus\nf 1 2 3\nusemtl " + second +
         "\nf 1 2 4\n";
}

class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tumblesight_mesh_file_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

  // Loads a file that must be refused: the message names the file and contains every one of `parts`.
  static void expect_refused(const std::string& path, const std::vector<std::string>& parts,
                             const MeshFileOptions& options = {}) {
    try {
      (void)load_mesh_file(path, options);
      ADD_FAILURE() << path << " was not refused";
    } catch (const std::runtime_error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(path), std::string::npos) << message;
      for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
      }
    }
  }

  fs::path folder_;
};

[[maybe_unused]] void expect_box(const TriangleMesh& mesh, const Eigen::Vector3f& min,
                                 const Eigen::Vector3f& max) {
  const Eigen::AlignedBox3f box = bounding_box(mesh);
  EXPECT_LT((box.min() - min).norm(), 1e-5F) << box.min().transpose();
  EXPECT_LT((box.max() - max).norm(), 1e-5F) << box.max().transpose();
}

TEST_F(MeshFile, BadScaleIsRefused) {
  const std::string path = write("wedge.stl", stl(wedge_triangles()));
  expect_refused(path, {"scale", "0", "--mesh-scale"}, {MeshUp::kY, 0.0});
  expect_refused(path, {"scale", "-1", "positive"}, {MeshUp::kY, -1.0});
  expect_refused(path, {"scale", "nan"}, {MeshUp::kY, std::numeric_limits<double>::quiet_NaN()});
}

TEST_F(MeshFile, AMissingOrEmptyFileAndAFolderAreRefused) {
  expect_refused((folder_ / "missing.stl").string(), {"no such file"});
  expect_refused(folder_.string(), {"not a file"});
  expect_refused(write("empty.stl", ""), {"empty", "0 bytes"});
}

TEST_F(MeshFile, OtherFormatsAreRefusedByNameWithAProgramThatConvertsThem) {
  const char* const known = ".stl, .obj, .ply, .gltf or .glb";
  expect_refused(write("wedge", "v 0 0 0\n"), {known});
  for (const char* name : {"wedge.FBX", "wedge.dae", "wedge.3ds", "wedge.blend"})
    expect_refused(write(name, "x"), {known, "Blender", "File > Export > glTF 2.0"});
  for (const char* name : {"wedge.step", "wedge.STP", "wedge.iges", "wedge.igs"})
    expect_refused(write(name, "x"), {known, "FreeCAD", "CAD Assistant"});
}

TEST_F(MeshFile, OtherContentUnderAKnownEndingIsNamed) {
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), zip("PK\3\4\x14\0\0\0", 8);
  const std::string more(200, '\7');
  for (const char* ending : {".stl", ".obj", ".ply"}) {
    const auto expect = [&](const std::string& bytes, const std::vector<std::string>& parts) {
      expect_refused(write(std::string("content") + ending, bytes), parts);
    };
    expect(png + more, {"PNG image"});
    expect(zip + more, {"ZIP archive", "unpack"});
    expect("glTF" + more, {"GLB file", ".glb"});
    expect("\n<!DOCTYPE html><html>404</html>\n", {"HTML page", "download"});
    expect("<HTML><body>404 Not Found</body></HTML>\n", {"HTML page", "download"});
    expect("version https://git-lfs.github.com/spec/v1\noid sha256:abc\nsize 12345\n", {"git lfs pull"});
  }
  expect_refused(write("text.obj", "solid craft\nendsolid craft\n"), {"STL file", ".stl"});
  expect_refused(write("scan.stl", "ply\nformat ascii 1.0\n"), {"PLY file", ".ply"});
  std::string bytes = stl(wedge_triangles());
  bytes.replace(0, 2, "PK");
  bytes.replace(2, 2, "\3\4");
  EXPECT_EQ(load_mesh_file(write("title.stl", bytes)).triangles.size(), 4U) << "a title may be anything";
}

TEST_F(MeshFile, APipeIsRefusedAndNotWaitedFor) {
  const std::string path = (folder_ / "pipe.stl").string();
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  expect_refused(path, {"not a file"});
}

// Nothing behind the door has to cope with lengths whose squares leave single precision.
TEST_F(MeshFile, ExtentsThatNoUnitExplainsAreRefused) {
  expect_refused(write("huge.stl", stl(wedge_triangles(1e30F))), {"3e+30 m", "1e+09 m", "--mesh-scale"});
  expect_refused(write("tiny.stl", stl(wedge_triangles(1e-40F))), {"m long", "1e-09 m", "--mesh-scale"});
}

TEST_F(MeshFile, TheFormatsOfTextAndOfScannersGiveTheSameMesh) {
  const TriangleMesh of_stl = load_mesh_file(write("wedge.stl", stl(wedge_triangles())));
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& v : kWedge)
    ply += std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
  for (const auto& f : kFaces)
    ply += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
  for (const TriangleMesh& other :
       {load_mesh_file(write("w.obj", obj())), load_mesh_file(write("w.ply", ply))}) {
    EXPECT_EQ(other.vertices_trf_m, of_stl.vertices_trf_m);
    EXPECT_EQ(other.triangles, of_stl.triangles);
  }
}

TEST(MeshUpAxis, IsYOrZ) {
  EXPECT_EQ(mesh_up_from("y"), MeshUp::kY);
  EXPECT_EQ(mesh_up_from("z"), MeshUp::kZ);
  EXPECT_THROW(mesh_up_from("x"), std::invalid_argument);
}

// y up: TRF x = X, y = -Z, z = Y.
TEST_F(MeshFile, StlIsReadWithBothUpAxesAndJoined) {
  const std::string path = write("wedge.stl", stl(wedge_triangles()));
  const TriangleMesh y_up = load_mesh_file(path);
  EXPECT_EQ(y_up.name, path);
  EXPECT_EQ(y_up.triangles.size(), 4U);
  EXPECT_EQ(y_up.vertices_trf_m.size(), 4U);
  EXPECT_NEAR(area_m2(y_up), 1.0 + 1.5 + 3.0 + 3.5, 1e-5);
  expect_box(y_up, {0.0F, -3.0F, 0.0F}, {1.0F, 0.0F, 2.0F});
  expect_box(load_mesh_file(path, {MeshUp::kZ, 1.0}), {0.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 3.0F});
}

TEST_F(MeshFile, ScaleTurnsMillimetresIntoMetres) {
  const std::string path = write("mm.stl", stl(wedge_triangles(1000.0F)));
  expect_box(load_mesh_file(path, {MeshUp::kZ, 0.001}), {0.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 3.0F});
}

// Verifies TS-SIL-300.
TEST_F(MeshFile, MarksThePartsWhoseMaterialIsNamedAPanel) {
  (void)write("file.mtl", "newmtl bus\nnewmtl Solar_Cells\nnewmtl gold\n");
  const TriangleMesh named = load_mesh_file(write("named.obj", obj_with_materials("Solar_Cells")));
  ASSERT_EQ(named.is_panel.size(), 2U);
  EXPECT_EQ(named.is_panel[0] + named.is_panel[1], 1);
  const std::size_t panel = named.is_panel[0] != 0 ? 0 : 1;
  float highest = 0.0F;  // the file's z is the TRF's -y
  for (const std::uint32_t corner : named.triangles[panel])
    highest = std::max(highest, -named.vertices_trf_m[corner].y());
  EXPECT_EQ(highest, 1.0F);
  EXPECT_TRUE(load_mesh_file(write("plain.obj", obj_with_materials("gold"))).is_panel.empty());
}

TEST_F(MeshFile, ObjIsRead) {
  const TriangleMesh mesh = load_mesh_file(write("wedge.OBJ", obj()));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  expect_box(mesh, {0.0F, -3.0F, 0.0F}, {1.0F, 0.0F, 2.0F});
}

TEST_F(MeshFile, QuadsAreTriangulated) {
  const TriangleMesh mesh =
      load_mesh_file(write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), {MeshUp::kZ, 1.0});
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_m2(mesh), 1.0, 1e-6);
}

TEST_F(MeshFile, GltfIsReadWithItsNodeTransforms) {
  (void)write("wedge.bin", gltf_buffer());
  const TriangleMesh mesh = load_mesh_file(write("wedge.gltf", gltf("wedge.bin")));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  expect_box(mesh, {0.5F, -6.0F, 0.0F}, {2.5F, 0.0F, 4.0F});
}

TEST_F(MeshFile, GlbIsRead) {
  std::string json = gltf("");
  json.replace(json.find("\"uri\":\"\","), 9, "");
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::string buffer = gltf_buffer();
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  expect_box(load_mesh_file(write("wedge.glb", bytes)), {0.5F, -6.0F, 0.0F}, {2.5F, 0.0F, 4.0F});
}

// Files that state more than they hold, or are of another kind.
TEST_F(MeshFile, InvalidGltfIsRefused) {
  std::string bytes = "glTF";
  for (const std::uint32_t number : {2U, 28U, 2'000'000'000U}) put(bytes, number);
  expect_refused(write("large.glb", bytes + "JSON{}  "), {"larger than the file"});
  expect_refused(write("other.glb", "ply\nformat ascii 1.0\nelement vertex 4\n"), {"GLB"});
  expect_refused(write("short.glb", "glTF"), {"GLB"});
  expect_refused(write("other.gltf", "ply\nformat ascii 1.0\nelement vertex 4\n"), {"glTF"});
}

// Several roots, a part that is used twice, a mirroring scale and a matrix.
// Verifies TS-SIL-350.
TEST_F(MeshFile, GltfPartsAreWhereTheirNodesPutThem) {
  std::string text = gltf("wedge.bin");
  const std::string nodes = R"("scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[0.5,0,0]},{"mesh":0,"scale":[2,2,2]}])";
  ASSERT_NE(text.find(nodes), std::string::npos);
  text.replace(text.find(nodes), nodes.size(), R"("scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"scale":[-1,1,1]},{"children":[2],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,4,0,0,1]},{"mesh":0}])");
  (void)write("wedge.bin", gltf_buffer());
  const TriangleMesh mesh = load_mesh_file(write("roots.gltf", text), {MeshUp::kZ, 1.0});
  EXPECT_EQ(mesh.triangles.size(), 8U);
  expect_box(mesh, {-1.0F, 0.0F, 0.0F}, {5.0F, 2.0F, 3.0F});
}

// Verifies TS-SIL-350.
TEST_F(MeshFile, WhatGltfIsNotReadIsRefusedByName) {
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = gltf("wedge.bin");
    return text.replace(text.find(part), part.size(), other);
  };
  (void)write("wedge.bin", gltf_buffer());
  expect_refused(write("quantized.gltf", with(R"("componentType":5126)", R"("componentType":5123)")),
                 {"KHR_mesh_quantization", "export it without"});
  const std::string version = R"({"version":"2.0"})";
  expect_refused(
      write("meshopt.gltf", with(version, version + R"(,"extensionsUsed":["EXT_meshopt_compression"])")),
      {"EXT_meshopt_compression", "export it without"});
  expect_refused(
      write("copies.gltf", with(version, version + R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])")),
      {"EXT_mesh_gpu_instancing", "written out"});
}

TEST_F(MeshFile, UnknownOrCorruptContentIsRefused) {
  expect_refused(write("notes.txt", "not a mesh\n"), {"cannot be read"});
  expect_refused(write("broken.gltf", "{\"asset\":"), {"cannot be read"});
  const std::string whole = stl(wedge_triangles());
  expect_refused(write("truncated.stl", whole.substr(0, whole.size() - 60)), {"cannot be read"});
  expect_refused(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n"), {});
}

TEST_F(MeshFile, FileWithoutTrianglesIsRefused) {
  expect_refused(write("none.stl", stl({})), {});
  expect_refused(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), {});
}

TEST_F(MeshFile, NotANumberIsRefusedAndCounted) {
  auto triangles = wedge_triangles();
  triangles[2][4] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(write("nan.stl", stl(triangles)), {"1 of", "not finite", "nan"});
  triangles[2][4] = std::numeric_limits<float>::infinity();
  expect_refused(write("inf.stl", stl(triangles)), {"1 of", "not finite", "inf"});
}

std::vector<float> without_area(int i) {
  if (i % 2 == 0) return {0, 0, 0, 1, 0, 0, 1, 0, 0};  // two equal corners
  return {0, 0, 0, 1, 0, 0, 3, 0, 0};                  // three on a line
}

// Verifies TS-SIL-350.
TEST_F(MeshFile, TrianglesWithoutAreaAreLeftOutAndCounted) {
  auto triangles = wedge_triangles();
  triangles.insert(triangles.begin(), without_area(1));  // reaches farther than the others
  triangles[0][6] = 50.0F;
  const TriangleMesh mesh = load_mesh_file(write("flat.stl", stl(triangles)));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.left_out, 1U);
  EXPECT_EQ(mesh.vertices_trf_m.size(), 4U) << "its corner does not count for the radius";
  EXPECT_EQ(left_out_note(mesh), "1 of 5 triangles (20 %) has no area and is left out: no ray hits it");
  EXPECT_EQ(left_out_note(load_mesh_file(write("whole.stl", stl(wedge_triangles())))), "");
}

// Verifies TS-SIL-350.
TEST_F(MeshFile, ManyTrianglesWithoutAreaAreRefused) {
  auto triangles = wedge_triangles();
  triangles.push_back(without_area(0));
  triangles.push_back(without_area(1));
  expect_refused(write("flat.stl", stl(triangles)), {"2 of 6 triangles (33.33 %)", "no area", "20 %"});
  expect_refused(write("none.stl", stl({without_area(0), without_area(1)})), {"2 of 2", "no area"});
}

// Of the panels' marks the right ones stay.
TEST_F(MeshFile, PanelsStayMarkedBesideTrianglesWithoutArea) {
  (void)write("file.mtl", "newmtl bus\nnewmtl panel\n");
  const TriangleMesh mesh = load_mesh_file(write(
      "panel.obj",
      "mtllib file.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl bus\nf 1 1 2\nf 1 2 3\nf 2 3 4\nf 1 3 4\n"
      "f 1 4 2\nusemtl panel\nf 1 2 4\n"));
  EXPECT_EQ(mesh.left_out, 1U);
  ASSERT_EQ(mesh.is_panel.size(), 5U);
  EXPECT_EQ(std::count(mesh.is_panel.begin(), mesh.is_panel.end(), 1), 1);
}

TEST_F(MeshFile, SizeBeyondTheSensorIsRefusedWithTheLimit) {
  expect_refused(write("large.stl", stl(wedge_triangles(7.0F))), {"21 m", "20 m", "--mesh-scale"});
  expect_refused(write("small.stl", stl(wedge_triangles(0.001F))), {"0.003 m", "0.1 m", "--mesh-scale"});
}

}  // namespace
}  // namespace tumblesight::sim
