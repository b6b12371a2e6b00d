#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

const std::string kTriangle =
    R"({"asset":{"version":"2.0"},)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"mode":4}]}],)"
    R"("accessors":[{"componentType":5126,"count":3,"type":"VEC3"},{"componentType":5126,"count":3,"type":"VEC3"},)"
    R"({"componentType":5123,"count":6,"type":"SCALAR"}]})";

class GltfCheck : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }

  std::string write(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary) << bytes;
    return path_;
  }

  // The message for the triangle with one part of its text replaced; empty if it passes.
  std::string said_with(const std::string& part, const std::string& other) const {
    std::string text = kTriangle;
    EXPECT_NE(text.find(part), std::string::npos) << part;
    text.replace(text.find(part), part.size(), other);
    return said([&] { check_gltf(write(text)); });
  }

  template <typename Check>
  static std::string said(const Check& check) {
    try {
      check();
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  const std::string path_ =
      (fs::temp_directory_path() / ("tumblesight_gltf_check_" + std::to_string(::getpid()))).string();
};

std::string glb(const std::string& kind, const std::string& json) {
  std::string bytes = "glTF";
  for (const std::uint32_t number :
       {2U, static_cast<std::uint32_t>(20 + json.size()), static_cast<std::uint32_t>(json.size())}) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 0xffU);
  }
  return bytes + kind + json;
}

TEST_F(GltfCheck, WholeFilesPass) {
  EXPECT_NO_THROW(check_gltf(write(kTriangle)));
  EXPECT_NO_THROW(check_gltf(write(" \n" + kTriangle + "\n")));
  EXPECT_NO_THROW(check_gltf(write("\xEF\xBB\xBF" + kTriangle))) << "a byte order mark";
  EXPECT_NO_THROW(check_glb(write(glb("JSON", kTriangle + "  "))));
  EXPECT_NO_THROW(check_glb(write(glb("JSON", kTriangle + std::string(2, '\0'))))) << "padded with zeros";
  EXPECT_EQ(said_with(R"(,"indices":2,"mode":4)", ""), "") << "triangles without indices";
  EXPECT_EQ(said_with(R"("mode":4)", R"("mode":5)"), "") << "a strip";
}

// Found by fuzzing: a strip without corners is 2^32 - 2 triangles if nobody checks.
TEST_F(GltfCheck, PrimitivesHaveCorners) {
  EXPECT_NE(
      said_with(R"("attributes":{"POSITION":0,"NORMAL":1})", R"("attributes":{"NORMAL":1})").find("POSITION"),
      std::string::npos);
  EXPECT_NE(said_with(R"("attributes")", R"("atributes")").find("mesh 0's primitive 0 has no \"attributes\""),
            std::string::npos);
  for (const char* mode : {"4", "5", "6"}) {
    const std::string text = std::string(R"("indices":3,"mode":)") + mode;
    std::string file = kTriangle;
    file.replace(file.find(R"("indices":2,"mode":4)"), text.size(), text);
    file.insert(file.rfind(']'), R"(,{"componentType":5123,"count":2,"type":"SCALAR"})");
    const std::string message = said([&] { check_gltf(write(file)); });
    EXPECT_NE(message.find("2 corners, fewer than 3"), std::string::npos) << mode << ": " << message;
  }
}

TEST_F(GltfCheck, IndicesOutOfRangeAreRefused) {
  EXPECT_NE(said_with(R"("POSITION":0)", R"("POSITION":3)").find("POSITION is 3, not a whole number below 3"),
            std::string::npos);
  EXPECT_NE(said_with(R"("indices":2)", R"("indices":-1)").find("indices is -1"), std::string::npos);
  EXPECT_NE(said_with(R"("NORMAL":1)", R"("NORMAL":2)").find("attributes of different counts"),
            std::string::npos);
  EXPECT_NE(said_with(R"("mode":4)", R"("mode":7)").find("mode is 7"), std::string::npos);
  EXPECT_NE(said_with(R"("count":3)", R"("count":3.0)").find("accessor 0's count is 3.0"), std::string::npos);
  EXPECT_NE(said_with(R"("count":3)", R"("kount":3)").find("accessor 0 has no \"count\""), std::string::npos);
  EXPECT_NE(said_with(R"([{"componentType":5126,"count":3,"type":"VEC3"})", "[7")
                .find("accessor 0 is not an object"),
            std::string::npos);
  EXPECT_NE(said_with(R"([{"primitives")", R"([1,{"primitives")").find("mesh 0 is not an object"),
            std::string::npos);
}

TEST_F(GltfCheck, AmbiguousJsonIsRefused) {
  EXPECT_NE(said_with(R"("mode":4)", R"("mode":4,"mode":5)").find("\"mode\" twice"), std::string::npos);
  EXPECT_NE(
      said_with(R"("mode":4)", R"("extras":)" + std::string(40, '[') + std::string(40, ']')).find("32 deep"),
      std::string::npos);
  EXPECT_NE(said_with("}]}", "}]").find("damaged"), std::string::npos);
  EXPECT_NE(said_with(R"("2.0")", R"("1.0")").find("not glTF 2"), std::string::npos);
  EXPECT_NE(said([&] { check_gltf(write("[]")); }).find("with {"), std::string::npos);
  EXPECT_NE(said([&] { check_glb(write(glb("BIN ", kTriangle))); }).find("not JSON"), std::string::npos);
}

// Only the surface of such a file would be another one.
TEST_F(GltfCheck, RequiredExtensionsAreReadOrRefusedByName) {
  const auto with = [this](const std::string& members) {
    return said_with(R"("meshes")", members + R"(,"meshes")");
  };
  const std::string unknown = with(R"("extensionsRequired":["ACME_curved_surfaces"])");
  EXPECT_NE(unknown.find("'ACME_curved_surfaces'"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("Read are KHR_draco_mesh_compression"), std::string::npos) << unknown;
  EXPECT_NE(with(R"("extensionsRequired":[7])").find("not a name"), std::string::npos);
  EXPECT_NE(with(R"("extensionsRequired":["KHR_meshopt_compression"])").find("without compression"),
            std::string::npos);
  EXPECT_EQ(with(R"("extensionsUsed":["ACME_curved_surfaces"])"), "");
  for (const char* read : {"KHR_texture_transform", "KHR_materials_unlit", "KHR_draco_mesh_compression"})
    EXPECT_EQ(with(R"("extensionsRequired":[")" + std::string(read) + "\"]"), "") << read;
  const std::string hostile = with(R"("extensionsRequired":["\u001b[31m)" + std::string(5000, 'x') + "\"]");
  EXPECT_LT(hostile.size(), 400U);
  EXPECT_EQ(hostile.find('\x1b'), std::string::npos);
}

// Without its instances or its data such a file would be another body.
TEST_F(GltfCheck, ExtensionsThatAreUsedAndNotDeclaredAreRefusedToo) {
  const auto with = [this](const std::string& members) {
    return said_with(R"("meshes")", members + R"(,"meshes")");
  };
  EXPECT_NE(with(R"("nodes":[{},{"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}}}])")
                .find("uses EXT_mesh_gpu_instancing"),
            std::string::npos);
  EXPECT_NE(
      with(R"("bufferViews":[{"extensions":{"EXT_meshopt_compression":{}}}])").find("without compression"),
      std::string::npos);
  EXPECT_EQ(with(R"("nodes":[{"extensions":{"ACME_names":{}}}])"), "");
}

TEST_F(GltfCheck, PositionsAndIndicesAreOfTheTypesThatTheStandardGivesThem) {
  const std::string positions = R"({"componentType":5126,"count":3,"type":"VEC3"})";
  const auto with = [&](const std::string& other) { return said_with(positions, other); };
  EXPECT_NE(with(R"({"componentType":5126,"count":3,"type":"VEC2"})").find("POSITION is \"VEC2\", not VEC3"),
            std::string::npos);
  EXPECT_NE(with(R"({"componentType":5126,"count":3})").find("has no \"type\""), std::string::npos);
  EXPECT_NE(with(R"({"count":3,"type":"VEC3"})").find("has no \"componentType\""), std::string::npos);
  EXPECT_NE(with(R"({"componentType":5124,"count":3,"type":"VEC3"})").find("5124"), std::string::npos);
  EXPECT_NE(
      said_with(R"("componentType":5123)", R"("componentType":5126)").find("indices's componentType is 5126"),
      std::string::npos);
  EXPECT_NE(said_with(R"("count":6)", R"("count":7)").find("7 corners"), std::string::npos);
}

TEST_F(GltfCheck, NodesFormATree) {
  const auto with = [this](const std::string& nodes, const std::string& scene = R"([{"nodes":[0]}])") {
    return said_with(R"("meshes")", R"("scenes":)" + scene + R"(,"nodes":)" + nodes + R"(,"meshes")");
  };
  EXPECT_EQ(with(R"([{"children":[1]},{"mesh":0}])"), "");
  EXPECT_NE(with(R"([{"children":[1]},{"children":[1]}])").find("two parents, nodes 0 and 1"),
            std::string::npos);
  EXPECT_NE(with(R"([{},{"children":[2]},{"children":[1]}])").find("form a ring"), std::string::npos);
  EXPECT_NE(with(R"([{"children":[0]}])").find("form a ring"), std::string::npos);
  EXPECT_NE(with(R"([{"children":[5]}])").find("node 0's child is 5"), std::string::npos);
  EXPECT_NE(with(R"([{"mesh":3}])").find("node 0's mesh is 3"), std::string::npos);
  EXPECT_NE(with(R"([{"skin":0}])").find("node 0's skin is 0"), std::string::npos);
  EXPECT_NE(with("[{}]", R"([{"nodes":[1]}])").find("scene 0's node is 1"), std::string::npos);
  EXPECT_NE(with("[{}]", R"([{"nodes":[0,0]}])").find("node 0 twice"), std::string::npos);
  EXPECT_NE(with(R"([{"children":[1]},{}])", R"([{"nodes":[0,1]}])").find("a child of node 0"),
            std::string::npos);
}

// Readers recurse with the hierarchy.
TEST_F(GltfCheck, DeepHierarchiesAreRefused) {
  const auto chain = [this](int nodes) {
    std::string text;
    for (int i = 0; i + 1 < nodes; ++i) text += R"({"children":[)" + std::to_string(i + 1) + "]},";
    return said_with(R"("meshes")", R"("nodes":[)" + text + R"({}],"meshes")");
  };
  EXPECT_EQ(chain(200), "");
  EXPECT_NE(chain(300).find("at most 255"), std::string::npos);
  EXPECT_NE(chain(100'000).find("at most 255"), std::string::npos);
  EXPECT_NE(said_with(R"("mode":4)", R"("mode":4,"extras":)" + std::string(100'000, '[')).find("32 deep"),
            std::string::npos);
}

TEST_F(GltfCheck, TransformsAreFinitePlacements) {
  const auto with = [this](const std::string& member) {
    return said_with(R"("meshes")", R"("nodes":[{)" + member + R"(}],"meshes")");
  };
  EXPECT_EQ(with(R"("scale":[-1,1,1],"rotation":[0,0,0,1.001])"), "") << "mirrored";
  EXPECT_NE(with(R"("scale":[1,1])").find("node 0's scale is [1,1], not 3 numbers"), std::string::npos);
  EXPECT_NE(with(R"("translation":[1,null,1])").find("not a finite number"), std::string::npos);
  EXPECT_NE(with(R"("translation":[1e300,0,0])").find("not a finite number"), std::string::npos);
  EXPECT_NE(with(R"("rotation":[0,0,0,0.5])").find("length 1"), std::string::npos);
  EXPECT_NE(with(R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0])").find("not a placement"), std::string::npos);
}

TEST_F(GltfCheck, AGlbFileIsAsLongAsItSays) {
  const auto with = [this](std::size_t at, std::uint32_t value) {
    std::string bytes = glb("JSON", kTriangle);
    for (unsigned i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (8U * i) & 0xFFU);
    return said([&] { check_glb(write(bytes)); });
  };
  EXPECT_NE(with(4, 1).find("its version is 1, not 2"), std::string::npos);
  EXPECT_NE(with(8, 1'000'000).find("larger than the file"), std::string::npos);
  EXPECT_NE(with(8, 100).find("larger than the file"), std::string::npos)
      << "a part beyond the stated length";
  EXPECT_NE(with(12, 0xFFFFFFFFU).find("larger than the file"), std::string::npos);
  EXPECT_NE(with(12, 0).find("damaged"), std::string::npos);
  EXPECT_NO_THROW(check_glb(write(glb("JSON", kTriangle) + "trailing")));
}

TEST_F(GltfCheck, AFileWithTheOtherEndingIsNamed) {
  EXPECT_NE(said([&] { check_gltf(write(glb("JSON", kTriangle))); }).find(".glb"), std::string::npos);
  EXPECT_NE(said([&] { check_glb(write(kTriangle)); }).find(".gltf"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
