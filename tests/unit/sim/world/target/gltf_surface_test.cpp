#include "sim/world/target/gltf_surface.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/target/mesh_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedByte = 5121;

// A wedge with its corners at (0,0,0), (1,0,0), (0,2,0), (0,0,3), under a node.
struct Craft {
  json scene =
      json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[],"bufferViews":[]})");
  std::string binary;

  Craft() {
    add<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, kFloat, "VEC3", 4);
    add<std::uint16_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, kUnsignedShort, "SCALAR", 12);
  }

  template <typename T>
  std::size_t add(const std::vector<T>& values, int type, const char* shape, std::size_t count) {
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const std::size_t size = values.size() * sizeof(T);
    scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}});
    binary.append(reinterpret_cast<const char*>(values.data()), size);
    scene["accessors"].push_back({{"bufferView", scene["bufferViews"].size() - 1},
                                  {"componentType", type},
                                  {"count", count},
                                  {"type", shape}});
    return scene["accessors"].size() - 1;
  }

  json& primitive() { return scene["meshes"][0]["primitives"][0]; }

  // All vertices hang on the joint that a node moves by (0, 0, 10).
  void hang_on_a_joint() {
    const std::size_t joints = add<std::uint8_t>(std::vector<std::uint8_t>(16, 0), kUnsignedByte, "VEC4", 4);
    const std::size_t weights =
        add<float>({1, 0, 0, 0, 1, 0, 0, 0, .5F, .5F, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 4);
    primitive()["attributes"]["JOINTS_0"] = joints;
    primitive()["attributes"]["WEIGHTS_0"] = weights;
    scene["nodes"] = json::parse(R"([{"mesh":0,"skin":0,"translation":[5,0,0]},{"translation":[0,0,10]}])");
    scene["scenes"][0]["nodes"] = {0, 1};
    scene["skins"] = json::parse(R"([{"joints":[1]}])");
  }

  std::string gltf(const std::string& uri) {
    scene["buffers"] = json::array({{{"byteLength", binary.size()}, {"uri", uri}}});
    return scene.dump();
  }
  std::string glb() {
    scene["buffers"] = json::array({{{"byteLength", binary.size()}}});
    std::string text = scene.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    return "glTF" + u32(2) + u32(28 + text.size() + binary.size()) + u32(text.size()) + "JSON" + text +
           u32(binary.size()) + std::string("BIN\0", 4) + binary;
  }
  static std::string u32(std::size_t value) {
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8U * i) & 0xFFU);
    return bytes;
  }
};

class GltfSurface : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.path(name), std::ios::binary) << bytes;
    return folder_.path(name);
  }
  TriangleMesh mesh_of(Craft craft) const {
    return load_mesh_file(write("craft.glb", craft.glb()), {MeshUp::kZ, 1.0});
  }
  // The refusal; empty if it is read.
  static std::string said(const std::string& path) {
    try {
      (void)load_mesh_file(path);
      return {};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
  std::string said(Craft craft) const { return said(write("craft.glb", craft.glb())); }

  TemporaryFolder folder_;
};

void expect_box(const TriangleMesh& mesh, const Eigen::Vector3f& min, const Eigen::Vector3f& max) {
  const Eigen::AlignedBox3f box = bounding_box(mesh);
  EXPECT_LT((box.min() - min).norm(), 1e-5F) << box.min().transpose();
  EXPECT_LT((box.max() - max).norm(), 1e-5F) << box.max().transpose();
}

// Negative if the sides that the triangles show are inside.
double signed_volume_m3(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_trf_m;
    volume += v[a].cast<double>().dot(v[b].cast<double>().cross(v[c].cast<double>())) / 6.0;
  }
  return volume;
}

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

// The node of a part with a skin does not place it.
TEST_F(GltfSurface, JointsPlaceThePartsWithASkin) {
  Craft craft;
  craft.hang_on_a_joint();
  expect_box(mesh_of(craft), {0, 0, 10}, {1, 2, 13});
  const std::size_t inverse =
      craft.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -10, 1}, kFloat, "MAT4", 1);
  craft.scene["skins"][0]["inverseBindMatrices"] = inverse;
  expect_box(mesh_of(craft), {0, 0, 0}, {1, 2, 3});
  craft.scene["nodes"][0]["children"] = {2};
  craft.scene["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(mesh_of(craft).triangles.size(), 8U) << "the same mesh without the skin, below the node";
  expect_box(mesh_of(craft), {0, 0, 0}, {6, 2, 3});
}

TEST_F(GltfSurface, ASkinThatCannotBeAppliedIsRefused) {
  Craft craft;
  craft.hang_on_a_joint();
  Craft other = craft;
  other.primitive()["attributes"].erase("WEIGHTS_0");
  EXPECT_SAYS(said(other), "WEIGHTS_0 are missing");
  other = craft;
  other.binary[other.scene["bufferViews"][2]["byteOffset"].get<std::size_t>()] = 3;
  EXPECT_SAYS(said(other), "mesh 0's primitive 0's vertex 0 names joint 3, and its skin has 1");
  other = craft;
  other.scene["skins"][0]["joints"] = {9};
  EXPECT_SAYS(said(other), "skin 0's joint is 9");
}

TEST_F(GltfSurface, MorphTargetsAreAppliedWithTheirDefaultWeights) {
  Craft craft;
  const std::size_t moved = craft.add<float>({0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0}, kFloat, "VEC3", 4);
  craft.primitive()["targets"] = json::array({{{"POSITION", moved}}});
  craft.scene["nodes"][0]["translation"] = {0, 0, 1};
  expect_box(mesh_of(craft), {0, 0, 1}, {1, 2, 4});
  craft.scene["meshes"][0]["weights"] = {0.5};
  expect_box(mesh_of(craft), {0, 0, 1}, {3, 2, 4});
  craft.scene["nodes"][0]["weights"] = {1.0};
  expect_box(mesh_of(craft), {0, 0, 1}, {5, 2, 4});
  craft.scene["nodes"][0]["weights"] = {0.0};
  expect_box(mesh_of(craft), {0, 0, 1}, {1, 2, 4});
  craft.scene["nodes"][0]["weights"] = {1.0, 1.0};
  EXPECT_SAYS(said(craft), "1 morph targets, and its mesh or node has 2 weights");
}

// Parts of one assembly would shift against each other.
TEST_F(GltfSurface, LargeTranslationsOfAChainOfNodesCancelExactly) {
  Craft craft;
  craft.scene["nodes"] = json::parse(
      R"([{"children":[1],"translation":[-5411932.681,0,0]},{"mesh":0,"translation":[5411932.981,0,0]}])");
  expect_box(mesh_of(craft), {0.3F, 0, 0}, {1.3F, 2, 3});
  craft.scene["nodes"][1]["translation"] = {5411932.701, 0, 0};
  expect_box(mesh_of(craft), {0.02F, 0, 0}, {1.02F, 2, 3});
}

TEST_F(GltfSurface, LargePositionsAndTheTranslationThatBringsThemBackCancelExactly) {
  Craft craft;
  craft.primitive()["attributes"]["POSITION"] =
      craft.add<float>({5411932, 0, 0, 5411933, 0, 0, 5411932, 2, 0, 5411932, 0, 3}, kFloat, "VEC3", 4);
  craft.scene["nodes"][0]["translation"] = {-5411931.7, 0, 0};
  expect_box(mesh_of(craft), {0.3F, 0, 0}, {1.3F, 2, 3});
}

TEST_F(GltfSurface, TheOriginIsMovedBeforeAnythingIsRounded) {
  Craft craft;
  craft.scene["nodes"][0]["translation"] = {5411932.681, 0, 0};
  const std::string path = write("craft.glb", craft.glb());
  expect_box(load_mesh_file(path, {MeshUp::kZ, 1.0, Eigen::Vector3d(5411932.381, 0, 0)}), {0.3F, 0, 0},
             {1.3F, 2, 3});
}

TEST_F(GltfSurface, MorphTargetsAndJointsCancelExactlyToo) {
  Craft craft;
  const std::vector<float> far{4e6F, 0, 0, 4e6F, 0, 0, 4e6F, 0, 0, 4e6F, 0, 0};
  craft.primitive()["targets"] = json::array({{{"POSITION", craft.add<float>(far, kFloat, "VEC3", 4)}}});
  craft.scene["meshes"][0]["weights"] = {0.3};
  craft.scene["nodes"][0]["translation"] = {-1199999.7, 0, 0};
  expect_box(mesh_of(craft), {0.3F, 0, 0}, {1.3F, 2, 3});
  craft.hang_on_a_joint();
  craft.scene["nodes"][1]["translation"] = {-1199999.7, 0, 0};
  expect_box(mesh_of(craft), {0.3F, 0, 0}, {1.3F, 2, 3});
}

// By the standard, triangles below a mirroring node are turned round.
TEST_F(GltfSurface, MirroredPartsKeepTheirOutside) {
  Craft craft;
  const double plain_m3 = signed_volume_m3(mesh_of(craft));
  EXPECT_NEAR(std::abs(plain_m3), 1.0, 1e-6);
  craft.scene["nodes"][0]["scale"] = {-1, 1, 1};
  EXPECT_NEAR(signed_volume_m3(mesh_of(craft)), plain_m3, 1e-6);
}

// A loop over all nodes for each node would take minutes.
TEST_F(GltfSurface, ManyNodesAndJointsTakeTimeInProportion) {
  Craft craft;
  craft.hang_on_a_joint();
  constexpr std::size_t kNodes = 3000;
  json roots = json::array(), joints = json::array();
  for (std::size_t i = 0; i < kNodes; ++i) {
    craft.scene["nodes"][i] = {{"mesh", 0}, {"skin", 0}};
    roots.push_back(i);
    joints.push_back(i);
  }
  craft.scene["scenes"] = json::array({{{"nodes", roots}}});
  for (std::size_t i = 0; i < kNodes; ++i) craft.scene["scenes"].push_back({{"nodes", json::array()}});
  craft.scene["skins"][0]["joints"] = joints;
  EXPECT_EQ(mesh_of(craft).triangles.size(), 4 * kNodes);
}

TEST_F(GltfSurface, SparseAccessorsAreApplied) {
  Craft craft;
  const std::size_t place = craft.add<std::uint16_t>({1}, kUnsignedShort, "SCALAR", 1);
  const std::size_t other = craft.add<float>({7, 0, 0}, kFloat, "VEC3", 1);
  craft.scene["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", place}, {"componentType", kUnsignedShort}}},
      {"values", {{"bufferView", other}}}};
  expect_box(mesh_of(craft), {0, 0, 0}, {7, 2, 3});
  craft.binary[craft.scene["bufferViews"][place]["byteOffset"].get<std::size_t>()] = 4;
  EXPECT_SAYS(said(craft), "replaces element 4 of 4");
}

TEST_F(GltfSurface, StripsFansAndInterleavedPositionsAreRead) {
  Craft craft;
  craft.primitive().erase("indices");
  const double slope_m2 = 3.5;  // of the side that no edge of the axes bounds
  for (const auto& [mode, area] : {std::pair{5, 1.0 + slope_m2}, std::pair{6, 1.0 + 3.0}}) {
    craft.primitive()["mode"] = mode;
    EXPECT_EQ(mesh_of(craft).triangles.size(), 2U) << mode;
    EXPECT_NEAR(area_m2(mesh_of(craft)), area, 1e-6) << mode;
  }
  Craft interleaved;
  const std::vector<float> with_normals{0, 0, 0, 9, 9, 9, 1, 0, 0, 9, 9, 9,
                                        0, 2, 0, 9, 9, 9, 0, 0, 3, 9, 9, 9};
  const std::size_t positions = interleaved.add<float>(with_normals, kFloat, "VEC3", 4);
  interleaved.scene["bufferViews"][positions]["byteStride"] = 24;
  interleaved.primitive()["attributes"]["POSITION"] = positions;
  expect_box(mesh_of(interleaved), {0, 0, 0}, {1, 2, 3});
}

// Exporters write a space of the name as %20; some forget to.
TEST_F(GltfSurface, AddressesOfBuffersAreDecoded) {
  Craft craft;
  (void)write("my craft.bin", craft.binary);
  (void)write("a%20b.bin", craft.binary);
  for (const char* uri : {"my%20craft.bin", "my craft.bin", "a%20b.bin", "./my%20craft.bin"})
    EXPECT_EQ(said(write("craft.gltf", craft.gltf(uri))), "") << uri;
}

TEST_F(GltfSurface, BuffersMayLieBelowTheFolderAndNotOutside) {
  Craft craft;
  std::filesystem::create_directories(folder_.path("here/textures"));
  for (const char* name : {"a.bin", "here/a.bin", "here/textures/a.bin", "here/..a.bin"})
    (void)write(name, craft.binary);
  for (const char* uri : {"textures/a.bin", "textures/../a.bin", "./a.bin", "..a.bin"})
    EXPECT_EQ(said(write("here/craft.gltf", craft.gltf(uri))), "") << uri;
  for (const char* uri :
       {"../a.bin", "%2E%2E/a.bin", "..%2Fa.bin", "textures/../../a.bin", "./../here/a.bin", ".."})
    EXPECT_SAYS(said(write("here/craft.gltf", craft.gltf(uri))), "in its folder or below") << uri;
  EXPECT_SAYS(said(write("here/craft.gltf", craft.gltf("a.bin%00"))), "a zero byte");
}

// RFC 2397 and RFC 3986: the case of a scheme does not matter.
TEST_F(GltfSurface, DataInTheAddressIsReadInAnyCase) {
  Craft craft;
  craft.scene["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 48}});
  craft.primitive().erase("indices");
  craft.primitive()["mode"] = 5;
  const std::string zeros(64, 'A');
  for (const char* start : {"data:;base64,", "DATA:application/octet-stream;BASE64,"}) {
    craft.scene["buffers"] =
        json::array({{{"byteLength", 72}, {"uri", "a.bin"}}, {{"byteLength", 48}, {"uri", start + zeros}}});
    (void)write("a.bin", craft.binary);
    EXPECT_EQ(said(write("a.gltf", craft.scene.dump())), "") << start;
  }
}

TEST_F(GltfSurface, PartsThatAreHiddenAreLeftOutAndSaid) {
  Craft craft;
  craft.scene["extensionsUsed"] = craft.scene["extensionsRequired"] = {"KHR_node_visibility"};
  craft.scene["nodes"] = json::parse(R"([{"mesh":0},
      {"extensions":{"KHR_node_visibility":{"visible":false}},"children":[2]},{"mesh":0,"translation":[5,0,0]},
      {"extensions":{"KHR_node_visibility":{"visible":true}},"mesh":0,"translation":[0,5,0]}])");
  craft.scene["scenes"][0]["nodes"] = {0, 1, 3};
  EXPECT_EQ(mesh_of(craft).triangles.size(), 8U);
  expect_box(mesh_of(craft), {0, 0, 0}, {1, 7, 3});
  EXPECT_SAYS(gltf_remark(write("craft.glb", craft.glb())), "The parts of 1 node are hidden");
  craft.scene["scenes"][0]["nodes"] = {1};
  EXPECT_SAYS(said(craft), "KHR_node_visibility hides all 1 nodes");
  craft.scene["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = "no";
  EXPECT_SAYS(said(craft), "node 1's KHR_node_visibility");
}

TEST_F(GltfSurface, NodesThatFlattenTheirPartsAreNamed) {
  Craft craft;
  craft.scene["nodes"] = json::parse(R"([{"children":[1]},{"mesh":0}])");
  for (const json& scale : {json{0, 0, 0}, json{1, 1, 0}, json{1, 0, 0}}) {
    craft.scene["nodes"][0]["scale"] = scale;
    EXPECT_SAYS(said(craft), "because node 0 makes them flat: its scale is " + scale.dump());
  }
  craft.scene["nodes"][0] = {{"children", {1}}, {"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  EXPECT_SAYS(said(craft), "because node 0 makes them flat: its matrix is singular");
  Craft plane;  // a scale of zero across a plane changes nothing
  plane.primitive()["indices"] = plane.add<std::uint16_t>({0, 1, 2}, kUnsignedShort, "SCALAR", 3);
  plane.scene["nodes"][0]["scale"] = {1, 1, 0};
  EXPECT_EQ(mesh_of(plane).triangles.size(), 1U);
}

TEST_F(GltfSurface, BuffersThatCannotBeReadAreNamed) {
  Craft craft;
  EXPECT_SAYS(said(write("a.gltf", craft.gltf("other%20part.bin"))),
              "buffer 0 is the file 'other part.bin', which is");
  for (const char* uri :
       {"https://example.org/a.bin", "/etc/hostname", "file:///etc/hostname", "%2Fetc/hostname"})
    EXPECT_SAYS(said(write("a.gltf", craft.gltf(uri))), "relative to this one") << uri;
  ASSERT_EQ(::mkfifo(folder_.path("pipe.bin").c_str(), 0600), 0);
  EXPECT_SAYS(said(write("a.gltf", craft.gltf("pipe.bin"))), "not a file") << "reading it would never end";
  (void)write("short.bin", craft.binary.substr(0, 40));
  EXPECT_SAYS(said(write("a.gltf", craft.gltf("short.bin"))), "has 40 bytes, and its byteLength is 72");
  EXPECT_SAYS(said(write("a.gltf", craft.gltf("data:application/octet-stream;base64,A*"))), "not base64");
  EXPECT_SAYS(said(write("a.gltf", craft.gltf("data:,plain"))), "not base64");
  const std::string hostile = said(write("a.gltf", craft.gltf("\x1b[31m" + std::string(100'000, 'x'))));
  EXPECT_LT(hostile.size(), 600U);
  EXPECT_EQ(hostile.find('\x1b'), std::string::npos);
}

TEST_F(GltfSurface, DataBeyondItsBufferIsRefused) {
  Craft craft;
  const auto said_with = [&](const char* list, std::size_t number, const char* key, const json& value) {
    Craft other = craft;
    other.scene[list][number][key] = value;
    return said(other);
  };
  EXPECT_SAYS(said_with("bufferViews", 0, "byteLength", 100), "buffer view 0 ends at byte 100");
  EXPECT_SAYS(said_with("bufferViews", 0, "byteOffset", 1e6), "buffer view 0's byteOffset");
  EXPECT_SAYS(said_with("bufferViews", 0, "byteLength", nullptr), "buffer view 0's byteLength is null");
  EXPECT_SAYS(said_with("bufferViews", 0, "byteLength", 40),
              "needs 48 bytes of its buffer view, which has 40");
  EXPECT_SAYS(said_with("bufferViews", 0, "buffer", 1), "buffer view 0's buffer is 1");
  EXPECT_SAYS(said_with("bufferViews", 0, "byteStride", 4), "byteStride is too small");
  EXPECT_SAYS(said_with("accessors", 0, "bufferView", 7), "bufferView is 7");
  EXPECT_SAYS(said_with("accessors", 0, "byteOffset", 8), "needs 56 bytes");
  craft.scene["accessors"][0].erase("bufferView");
  EXPECT_SAYS(said(craft), "names no data");
}

TEST_F(GltfSurface, ValuesOfAnotherKindAreRefused) {
  for (const char* path :
       {"/nodes/0/mesh", "/nodes/0/skin", "/nodes", "/scenes/0", "/scenes/0/nodes", "/meshes/0/primitives",
        "/meshes/0/primitives/0", "/meshes/0/primitives/0/attributes", "/bufferViews/0", "/accessors/0",
        "/accessors/0/type", "/buffers"}) {
    for (const json& value : {json("text"), json(-1), json::array({json::object()}), json::object()}) {
      Craft craft;
      craft.scene["buffers"] = json::array({{{"byteLength", craft.binary.size()}}});
      const json::json_pointer at(path);
      if (craft.scene.contains(at) && craft.scene[at] == value) continue;
      craft.scene[at] = value;
      const std::string text = craft.scene.dump();
      const std::string bytes = "glTF" + Craft::u32(2) + Craft::u32(28 + text.size() + craft.binary.size()) +
                                Craft::u32(text.size()) + "JSON" + text + Craft::u32(craft.binary.size()) +
                                std::string("BIN\0", 4) + craft.binary;
      const std::string message = said(write("craft.glb", bytes));
      EXPECT_EQ(message.find("json.exception"), std::string::npos) << path << ": " << message;
      EXPECT_SAYS(message, "craft.glb") << path << " = " << value;
    }
  }
}

TEST_F(GltfSurface, AnIndexWithoutAVertexIsRefused) {
  Craft craft;
  craft.binary[48 + 2 * 5] = 99;
  EXPECT_SAYS(said(craft), "mesh 0's primitive 0 names vertex 99 (index 5), and it has 4 vertices");
}

TEST_F(GltfSurface, ASceneWithoutPartsIsRefusedWithTheReason) {
  Craft craft;
  craft.scene["scenes"][0]["nodes"] = json::array();
  EXPECT_SAYS(said(craft), "its scene holds no parts: none of the 1 meshes of the file stands in scene 0");
  craft.scene["scene"] = 1;
  EXPECT_SAYS(said(craft), "the file's scene is 1");
  craft.scene.erase("scenes");
  EXPECT_SAYS(said(craft), "has no scene");
  Craft empty;
  empty.scene["meshes"][0].erase("primitives");
  EXPECT_SAYS(said(empty), "mesh 0, which stands in node 0, has no primitives");
  Craft lines;
  lines.primitive()["mode"] = 1;
  EXPECT_SAYS(said(lines), "all of points or lines");
}

TEST_F(GltfSurface, RepeatedPartsCountForTheLimitOfTriangles) {
  Craft craft;
  std::vector<std::uint16_t> corners;
  for (int i = 0; i < 60'000; ++i) corners.insert(corners.end(), {0, 1, 2});
  craft.primitive()["indices"] = craft.add<std::uint16_t>(corners, kUnsignedShort, "SCALAR", corners.size());
  json roots = json::array();
  for (int i = 0; i < 100; ++i) {
    roots.push_back(i);
    craft.scene["nodes"][static_cast<std::size_t>(i)] = {{"mesh", 0}};
  }
  craft.scene["scenes"][0]["nodes"] = roots;
  EXPECT_SAYS(said(craft), "more than 5000000 triangles");
}

TEST_F(GltfSurface, WhatIsLeftOutIsSaid) {
  Craft craft;
  EXPECT_EQ(gltf_remark(write("craft.glb", craft.glb())), "");
  craft.scene["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  craft.scene["meshes"].push_back({{"primitives", json::array()}});
  craft.scene["animations"] = json::array({json::object()});
  craft.scene["scenes"].push_back({{"nodes", json::array()}});
  const std::string remark = gltf_remark(write("craft.glb", craft.glb()));
  EXPECT_SAYS(remark, "1 of 2 parts");
  EXPECT_SAYS(remark, "1 of 2 meshes");
  EXPECT_SAYS(remark, "scene 0 of 2");
  EXPECT_SAYS(remark, "nimation");
}

}  // namespace
}  // namespace tumblesight::sim
