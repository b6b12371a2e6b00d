// `tumblesight mesh`: what it shows of a file, its exit status, the files that it writes, and the warnings
// before training.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "sim/cli/mesh_warnings.hpp"
#include "sim/inspection/write_mesh.hpp"
#include "sim/world/target/mesh_file.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"
#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

TEST(Mesh, RefusesWrongArgumentsInOneLine) {
  const Workplace here;
  write_mesh(here.path("craft.stl"), sound_mesh());
  for (const auto& [arguments, code, message] : std::vector<std::tuple<std::string, int, std::string>>{
           {"", 2, "FILE (or --mission) is required"},
           {"none.stl", 1, "no such file"},
           {"craft.stl --mesh-up x", 2, "must be one of y, z, not 'x'"},
           {"craft.stl --mesh-scale 0", 2, "from 1e-06 to 1e+06"},
           {"craft.stl --fix out.glb", 2, "must end in .stl or .obj, not 'out.glb'"},
           {"craft.stl --origin 0,0,1", 2, "--origin requires --fix"},
           {"craft.stl --keep-strays", 2, "--keep-strays requires --fix"},
           {"craft.stl --fix ./craft.stl", 2, "--fix: './craft.stl' is also the file of FILE"},
           {"craft.stl --json x --html x", 2, "is also the file of"}}) {
    const Outcome outcome = here.run("mesh " + arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments << outcome.errors;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << arguments << ": " << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  }
}

// Verifies TS-SIL-360.
TEST(Mesh, ShowsASoundMeshAndWritesPageAndJson) {
  const Workplace here;
  write_mesh(here.path("craft.stl"), sound_mesh());
  const Outcome outcome = here.run("mesh craft.stl --mesh-up z --html craft.html --json craft.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors << outcome.output;
  for (const char* part : {"radius", "centre of surface", "principal axis", "from +x: +y right, +z up", "@"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part;
  const auto json = nlohmann::json::parse(content(here.path("craft.json")));
  EXPECT_EQ(json.at("triangles"), sound_mesh().triangles.size());
  EXPECT_EQ(json.at("likely_units").at(0).at("name"), "metres");
  EXPECT_NE(content(here.path("craft.html")).find("From -z"), std::string::npos);
}

// Verifies TS-SIL-360.
TEST(Mesh, AMeshInMillimetresIsOfNoUseUntilItsUnitIsGiven) {
  const Workplace here;
  write_mesh(here.path("craft.stl"), moved(times(sound_mesh(), 1000.0F), {0.0F, 0.0F, 3000.0F}));
  const Outcome wrong = here.run("mesh craft.stl --mesh-up z --json wrong.json");
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_NE(wrong.output.find("in millimetres (--mesh-scale"), std::string::npos) << wrong.output;
  EXPECT_EQ(nlohmann::json::parse(content(here.path("wrong.json"))).at("findings").at(0).at("key"), "size");
  const Outcome fixed = here.run(
      "mesh craft.stl --mesh-up z --mesh-scale 0.001 --fix fixed.obj --origin 0,0,3 --json right.json");
  EXPECT_EQ(fixed.exit_code, 0) << fixed.output;
  EXPECT_NE(fixed.output.find("use it with --mesh-up z"), std::string::npos) << fixed.output;
  EXPECT_EQ(nlohmann::json::parse(content(here.path("right.json"))).at("findings").at(0).at("key"), "origin");
  const TriangleMesh mesh = load_mesh_file(here.path("fixed.obj"), {MeshUp::kZ, 1.0});
  EXPECT_NEAR(mesh.radius_m(), sound_mesh().radius_m(), 1e-3);
}

TEST(Mesh, AnOriginFarFromTheSurfaceIsRefused) {
  const Workplace here;
  write_mesh(here.path("craft.stl"), sound_mesh());
  for (const auto& [origin, message] : {std::pair{"nan,0,0", "--origin"},
                                        {"0,inf,0", "--origin"},
                                        {"0,1e30,0", "--origin"},
                                        {"1000,0,0", "m from the middle of the surface"},
                                        {"0,0", "--origin"}}) {
    const Outcome outcome =
        here.run(std::string("mesh craft.stl --mesh-up z --fix fixed.stl --origin ") + origin);
    EXPECT_EQ(outcome.exit_code, 2) << origin;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << origin << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(here.path("fixed.stl"))) << origin;
  }
}

std::string warnings_of(const TriangleMesh& mesh, const MeshArguments& arguments) {
  ::testing::internal::CaptureStderr();
  print_mesh_warnings(arguments, {mesh});
  return ::testing::internal::GetCapturedStderr();
}

// Verifies TS-SIL-360.
TEST(MeshWarnings, AreOneLinePerFindingAndNameTheCommandThatShowsMore) {
  MeshArguments arguments;
  arguments.meshes = {"craft.stl"};
  arguments.mesh_up = "z";
  const TriangleMesh stray = with(sound_mesh(), box_at(6.0F, 0.0F, 0.0F, {0.05F, 0.05F, 0.05F}));
  const std::string warnings = warnings_of(stray, arguments);
  EXPECT_EQ(warnings.find("warning: mesh 'craft.stl': Detached from the rest: 1 part of 12 triangles"), 0U)
      << warnings;
  EXPECT_NE(warnings.find("`tumblesight mesh craft.stl --mesh-up z --mesh-scale 1`"), std::string::npos)
      << warnings;
  EXPECT_EQ(std::count(warnings.begin(), warnings.end(), '\n'), 2) << warnings;
  EXPECT_EQ(warnings_of(sound_mesh(), arguments), "");
  arguments.meshes = {"parametric"};
  EXPECT_EQ(warnings_of(stray, arguments), "") << "the meshes that ship are known";
}

}  // namespace
}  // namespace tumblesight::sim
