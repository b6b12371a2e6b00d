#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "sim/world/target/mesh_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

std::vector<std::string> side_files_of(const TemporaryFolder& here, const std::string& name,
                                       const std::string& text) {
  std::ofstream(here.path(name)) << text;
  return mesh_side_files(here.path(name));
}

// Verifies TS-SIL-160.
TEST(MeshSideFiles, AreTheMaterialsOfAnObj) {
  const TemporaryFolder here;
  const std::vector<std::string> files =
      side_files_of(here, "mine.OBJ", "v 0 0 0\r\n mtllib my paint.mtl\r\nmtllib a.mtl\nf 1 1 1\n");
  for (const char* name : {"mine.mtl", "my paint.mtl", "paint.mtl", "a.mtl"})
    EXPECT_EQ(std::count(files.begin(), files.end(), here.path(name)), 1) << name;
}

// Verifies TS-SIL-160.
TEST(MeshSideFiles, AreBuffersAndImagesOfAGltf) {
  const TemporaryFolder here;
  const std::vector<std::string> files = side_files_of(
      here, "mine.gltf",
      R"({"buffers": [{"uri": "data:,x"}, {"uri": "my%20mesh.bin"}, {}, 7], "images": [{"uri": "100%.png"}]})");
  const std::vector<std::string> expected{here.path("my mesh.bin"), here.path("100%.png")};
  EXPECT_EQ(files, expected);
}

// The reader does not open them.
TEST(MeshSideFiles, AreNoneOutsideOfTheFolder) {
  const TemporaryFolder here;
  EXPECT_TRUE(
      side_files_of(here, "mine.gltf",
                    R"({"buffers": [{"uri": "DATA:,x"}, {"uri": "../a.bin"}, {"uri": "/etc/passwd"}]})")
          .empty());
}

TEST(MeshSideFiles, OfOtherAndOfDamagedFilesAreNone) {
  const TemporaryFolder here;
  EXPECT_TRUE(side_files_of(here, "mine.stl", "mtllib a.mtl\n").empty());
  for (const char* text : {"", "{", "[]", R"({"buffers": 1})", R"({"buffers": [{"uri": 2}]})"})
    EXPECT_TRUE(side_files_of(here, "mine.gltf", text).empty()) << text;
  EXPECT_TRUE(mesh_side_files(here.path("missing.obj")).empty());
  EXPECT_TRUE(mesh_side_files(here.path("")).empty());
}

}  // namespace
}  // namespace tumblesight::sim
