#include "sim/inspection/write_mesh.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "sim/world/target/mesh_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

TEST(WriteMesh, RefusesOtherEndings) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(folder.path("mesh.glb"), sound_mesh()), std::invalid_argument);
}

TEST(WriteMesh, NamesItsFileOfMaterials) {
  EXPECT_EQ(materials_of("out/mesh.obj"), "out/mesh.mtl");
}

TEST(WriteMesh, IsReadAgainWithZUpInMetres) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = sound_mesh();
  for (const char* name : {"mesh.stl", "mesh.OBJ"}) {
    write_mesh(folder.path(name), mesh);
    const TriangleMesh again = load_mesh_file(folder.path(name), {MeshUp::kZ, 1.0});
    EXPECT_EQ(again.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_NEAR(again.radius_m(), mesh.radius_m(), 1e-5) << name;
    EXPECT_TRUE(again.is_panel.empty()) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path("mesh.mtl")));
}

TEST(WriteMesh, AnObjKeepsTheMarksOfPanels) {
  const TemporaryFolder folder;
  TriangleMesh mesh = sound_mesh();
  mesh.is_panel.assign(mesh.triangles.size(), 0);
  for (std::size_t i = 12; i < 24; ++i) mesh.is_panel[i] = 1;  // the wing
  write_mesh(folder.path("mesh.obj"), mesh);
  const TriangleMesh again = load_mesh_file(folder.path("mesh.obj"), {MeshUp::kZ, 1.0});
  ASSERT_EQ(again.is_panel.size(), mesh.triangles.size());
  EXPECT_EQ(std::count(again.is_panel.begin(), again.is_panel.end(), 1), 12);
}

}  // namespace
}  // namespace tumblesight::sim
