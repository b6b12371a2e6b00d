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
    R"("accessors":[{"count":3},{"count":3},{"count":6}]})";

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
  EXPECT_NO_THROW(check_glb(write(glb("JSON", kTriangle + "  "))));
  EXPECT_NO_THROW(check_glb(write(glb("JSON", kTriangle + std::string(2, '\0'))))) << "padded with zeros";
  EXPECT_EQ(said_with(R"(,"indices":2,"mode":4)", ""), "") << "triangles without indices";
  EXPECT_EQ(said_with(R"("mode":4)", R"("mode":5)"), "") << "a strip";
}

// Found by fuzzing: a strip without corners is 2^32 - 2 triangles to Assimp.
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
    file.insert(file.rfind(']'), R"(,{"count":2})");
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
  EXPECT_NE(said_with(R"({"count":3})", "7").find("accessor 0 is not an object"), std::string::npos);
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

}  // namespace
}  // namespace tumblesight::sim
