#include "sim/world/target/gltf_draco.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

#include "sim/world/target/mesh_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

#ifdef TUMBLESIGHT_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace tumblesight::sim {
namespace {

constexpr int kPosition = 0;  // the number of the attribute in the compressed mesh

std::string u32(std::size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  return bytes;
}

// One compressed part at half size under a node that doubles it and moves it by (0.5, 0, 0).
std::string glb(std::string binary, std::size_t vertices, std::size_t corners, int position = kPosition) {
  const std::size_t size = binary.size();
  binary.resize((size + 3) / 4 * 4, '\0');
  std::string text =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],
"extensionsRequired":["KHR_draco_mesh_compression"],"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[0.5,0,0]},{"mesh":0,"scale":[2,2,2]}],
"materials":[{"name":"solar cells","normalTexture":{"index":7}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0,"extensions":
{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":)" +
      std::to_string(position) + R"(}}}}]}],"accessors":[{"componentType":5126,"count":)" +
      std::to_string(vertices) + R"(,"type":"VEC3"},{"componentType":5125,"count":)" +
      std::to_string(corners) + R"(,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
      std::to_string(size) + R"(}],"buffers":[{"byteLength":)" + std::to_string(binary.size()) + "}]}";
  text.append((4 - text.size() % 4) % 4, ' ');
  return "glTF" + u32(2) + u32(28 + text.size() + binary.size()) + u32(text.size()) + "JSON" + text +
         u32(binary.size()) + std::string("BIN\0", 4) + binary;
}

class GltfDraco : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.path(name), std::ios::binary) << bytes;
    return folder_.path(name);
  }
  static std::string said(const std::function<void()>& call) {
    try {
      call();
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
  TemporaryFolder folder_;
};

#ifndef TUMBLESIGHT_HAS_DRACO

TEST_F(GltfDraco, WithoutADecoderTheErrorSaysWhatToInstall) {
  const std::string message = said([&] { (void)load_mesh_file(write("a.glb", glb("data", 4, 12))); });
  EXPECT_NE(message.find("Draco"), std::string::npos) << message;
  EXPECT_NE(message.find("libdraco-dev"), std::string::npos) << message;
}

#else

using Corner = std::array<float, 3>;

std::string compressed(const std::vector<std::array<Corner, 3> >& triangles) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(triangles.size()));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(i)),
                                      triangles[i][0].data(), triangles[i][1].data(), triangles[i][2].data());
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("Draco refused the mesh");
  return {buffer.data(), buffer.size()};
}

const std::vector<std::array<Corner, 3> > kWedge{{{{0, 0, 0}, {0, 2, 0}, {1, 0, 0}}},
                                                 {{{0, 0, 0}, {1, 0, 0}, {0, 0, 3}}},
                                                 {{{0, 0, 0}, {0, 0, 3}, {0, 2, 0}}},
                                                 {{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}}};

// Verifies TS-SIL-350.
TEST_F(GltfDraco, IsReadWithNodesAndNamesOfMaterials) {
  const TriangleMesh mesh = load_mesh_file(write("wedge.glb", glb(compressed(kWedge), 4, 12)));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.is_panel, std::vector<std::uint8_t>(4, 1));
  const Eigen::AlignedBox3f box = bounding_box(mesh);
  EXPECT_LT((box.min() - Eigen::Vector3f(0.5F, -6.0F, 0.0F)).norm(), 1e-3F) << box.min().transpose();
  EXPECT_LT((box.max() - Eigen::Vector3f(2.5F, 0.0F, 4.0F)).norm(), 1e-3F) << box.max().transpose();
}

// Some readers give up beyond 65,536 vertices in a part.
// Verifies TS-SIL-350.
TEST_F(GltfDraco, LargePartsAreRead) {
  std::vector<std::array<Corner, 3> > strip;
  constexpr int kTriangles = 70'000;
  for (int i = 0; i < kTriangles; ++i) {
    const float x = 1e-4F * static_cast<float>(i);
    strip.push_back({{{x, 0.0F, 0.0F}, {x + 5e-5F, 0.0F, 0.0F}, {x, 1.0F, 0.0F}}});
  }
  const TriangleMesh mesh =
      load_mesh_file(write("large.glb", glb(compressed(strip), 3 * kTriangles, 3 * kTriangles)));
  EXPECT_EQ(mesh.triangles.size() + mesh.left_out, static_cast<std::size_t>(kTriangles));
}

// Verifies TS-SIL-350.
TEST_F(GltfDraco, DamagedDataIsRefusedByName) {
  const std::string whole = compressed(kWedge);
  for (const std::string& data :
       {whole.substr(0, whole.size() / 2), std::string("nothing of the kind"), std::string()}) {
    const std::string message = said([&] { (void)load_mesh_file(write("damaged.glb", glb(data, 4, 12))); });
    EXPECT_NE(message.find("Draco"), std::string::npos) << message;
    EXPECT_NE(message.find("export it again, without compression"), std::string::npos) << message;
  }
  EXPECT_NE(
      said([&] { (void)load_mesh_file(write("other.glb", glb(whole, 4, 12, 5))); }).find("no positions"),
      std::string::npos);
}

#endif

}  // namespace
}  // namespace tumblesight::sim
