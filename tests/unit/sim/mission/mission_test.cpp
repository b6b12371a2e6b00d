#include "sim/mission/mission.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/hostile_files.hpp"

namespace tumblesight::sim {
namespace {

const std::vector<std::string> kConditionNames{"nominal", "degraded", "occluded", "tumbling"};

// A folder with a mesh file, which a mission may name.
class MissionFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("mission_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "craft.stl") << "solid\nendsolid\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Mission read(const std::string& text) const {
    return mission_from_toml(text, (folder_ / "craft.toml").string(), kConditionNames);
  }
  std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "not refused";
  }
  static std::string with(const std::string& more) {
    return "name = \"craft\"\nmesh = \"craft.stl\"\n" + more;
  }

  std::filesystem::path folder_;
};

// Verifies TS-TRN-090.
TEST_F(MissionFile, NeedsOnlyNameAndMesh) {
  const Mission mission = read(with(""));
  EXPECT_EQ(mission.name, "craft");
  EXPECT_EQ(mission.title, "craft");
  EXPECT_EQ(mission.mesh.file, (folder_ / "craft.stl").string()) << "relative to the mission";
  EXPECT_EQ(mission.mesh.up, "y");
  EXPECT_EQ(mission.mesh.scale, 1.0);
  EXPECT_FALSE(mission.inertia);
  EXPECT_FALSE(mission.panels) << "the file does not say";
  EXPECT_EQ(mission.sensor, "paper");
  EXPECT_FALSE(mission.ranges_m);
  EXPECT_EQ(mission.minutes, 60.0);
  EXPECT_EQ(mission.goals.at("nominal").network_mean_deg, 3.0);
  EXPECT_EQ(mission.goals.at("degraded").pose_mean_deg, 0.6);
}

TEST_F(MissionFile, TakesEveryKey) {
  std::ofstream(folder_ / "mine.json") << "{}";
  const Mission mission =
      read(with("title = \"The Craft\"\nup = \"z\"\nunit = \"mm\"\norigin = [0, 0.5, -1]\n"
                "inertia = [410, 380, 300, 0, -2, 5]\nsymmetry = [\"z:4\"]\naccept = [\"strays\"]\n"
                "sensor = \"mine.json\"\nranges_m = [15, 80]\nlargest_rate_deg_s = 5\nminutes = 20\n"
                "[panels]\nturn_deg = [-90, 45]\n[conditions]\nnominal = 2\noccluded = 3\n"
                "[goals.nominal]\npose_mean_deg = 0.1\n[goals.occluded]\nverified = 0.9\n"));
  EXPECT_EQ(mission.title, "The Craft");
  EXPECT_EQ(mission.mesh.up, "z");
  EXPECT_EQ(mission.mesh.scale, 0.001);
  EXPECT_EQ(mission.mesh.origin_trf_m, (std::array<double, 3>{0.0, 0.5, -1.0}));
  ASSERT_TRUE(mission.inertia);
  EXPECT_EQ(mission.inertia->xz, -2.0);
  EXPECT_EQ(mission.symmetry, std::vector<std::string>{"z:4"});
  EXPECT_EQ(mission.accept, std::vector<std::string>{"strays"});
  EXPECT_EQ(mission.sensor, (folder_ / "mine.json").string());
  EXPECT_EQ(mission.ranges_m->farthest_m, 80.0);
  EXPECT_EQ(mission.largest_rate_deg_s, 5.0);
  EXPECT_EQ(mission.minutes, 20.0);
  EXPECT_EQ(mission.panels->lowest_deg, -90.0);
  EXPECT_EQ(mission.conditions.at("occluded"), 3);
  EXPECT_EQ(mission.goals.at("nominal").pose_mean_deg, 0.1);
  EXPECT_EQ(mission.goals.at("nominal").network_mean_deg, 3.0) << "the default stays";
  EXPECT_EQ(mission.goals.at("occluded").verified, 0.9);
}

TEST_F(MissionFile, InertiaComesAsRowsToo) {
  const Mission mission = read(with("inertia = [[410, 1, 2], [1, 380, 3], [2, 3, 300]]\n"));
  ASSERT_TRUE(mission.inertia);
  EXPECT_EQ(tensor_of(*mission.inertia), (Eigen::Matrix3d() << 410, 1, 2, 1, 380, 3, 2, 3, 300).finished());
}

// The closed form: R I R^T with x = X, y = -Z, z = Y.
TEST_F(MissionFile, InertiaInTheAxesOfTheFileIsTurned) {
  const Mission mission = read(with("inertia_axes = \"file\"\ninertia = [410, 380, 300, 4, -2, 5]\n"));
  Eigen::Matrix3d r_trf_file, in_file;
  r_trf_file << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  in_file << 410, 4, -2, 4, 380, 5, -2, 5, 300;
  EXPECT_EQ(tensor_of(*mission.inertia), r_trf_file * in_file * r_trf_file.transpose());
  const Mission z_up =
      read(with("up = \"z\"\ninertia_axes = \"file\"\ninertia = [410, 380, 300, 4, -2, 5]\n"));
  EXPECT_EQ(tensor_of(*z_up.inertia), in_file) << "the axes of a z-up file are those of the TRF";
}

// Verifies TS-TRN-090.
TEST_F(MissionFile, WhatIsWrongIsNamedWithLineLimitsAndRemedy) {
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"mesh = \"craft.stl\"\n", {"craft.toml", "name is missing", "1 to 31 characters"}},
      {"name = \"Craft 1\"\nmesh = \"craft.stl\"\n", {"line 1", "name is 'Craft 1'", "a-z, 0-9 and _"}},
      {"name = \"craft\"\n", {"mesh is missing", "relative to the mission's folder"}},
      {"name = \"craft\"\nmesh = \"other.stl\"\n", {"line 2", "there is no file", "other.stl"}},
      {with("up = \"x\"\n"), {"line 3", "up is 'x'", "\"y\" or \"z\""}},
      {with("scale = 0\n"), {"scale is 0", "1e-06 to 1e+06"}},
      {with("scale = 1\nunit = \"mm\"\n"), {"unit and scale say the same"}},
      {with("inertia = [1, 2]\n"), {"inertia is [ 1, 2 ]", "Ixx, Iyy, Izz"}},
      {with("inertia = [1, 1, 9, 0, 0, 0]\n"), {"no rigid body", "sum of the other two"}},
      {with("inertia = [[1, 2, 0], [0, 1, 0], [0, 0, 1]]\n"), {"symmetric tensor"}},
      {with("ranges_m = [50, 20]\n"), {"ranges_m", "nearest, farthest"}},
      {with("minutes = 0\n"), {"minutes is 0", "from 0.5 to 10000"}},
      {with("[panels]\nturn_deg = [10, 20]\n"), {"panels.turn_deg", "0 (as in the mesh) between"}},
      {with("[conditions]\nfoggy = 1\n"), {"conditions.foggy", "nominal, degraded"}},
      {with("[conditions]\nnominal = 0\n"), {"weight above 0"}},
      {with("[goals.nominal]\nmean = 1\n"), {"no key 'goals.nominal.mean'", "network_mean_deg"}},
      {with("[goals.nominal]\nverified = 2\n"), {"goals.nominal.verified is 2", "from 0 to 1"}},
      {with("accept = [\"orgin\"]\n"), {"accept", "unit, up, origin"}},
      {with("largest_rate_deg_s = 0\n"), {"largest_rate_deg_s is 0", "from 0.1 to 20"}},
      {with("inertias = [1]\n"),
       {"line 3", "no key 'inertias'", "the file has name, title", "did you mean 'inertia'?"}},
      {"name = \"craft\"\nmehs = \"craft.stl\"\n", {"line 2", "no key 'mehs'", "did you mean 'mesh'?"}},
      {with("[goal]\n"), {"line 3", "no key 'goal'", "did you mean 'goals'?"}},
      {with("[goals.nominal]\nnetwork_mean = 3\n"), {"no key 'goals.nominal.network_mean'"}},
      {with("[conditions]\nnominl = 3\n"), {"did you mean 'nominal'?"}},
      {with("name = 3"), {"craft.toml, line 3"}},
      {"name = \"craft\"\nmesh = \"parametric\"\nup = \"z\"\n", {"up is for mesh files"}},
  };
  for (const auto& c : cases) {
    const std::string message = refusal(c.text);
    for (const std::string& part : c.parts)
      EXPECT_NE(message.find(part), std::string::npos)
          << c.text << "\n  " << message << "\n  lacks: " << part;
  }
}

TEST_F(MissionFile, TheFirstMissionOfTheHelpCanBeRead) {
  std::ofstream(folder_ / "craft.glb") << "x";
  EXPECT_EQ(read(kFirstMission).name, "craft");
}

TEST(Mission, AFileThatCannotBeReadIsNamed) {
  EXPECT_THROW((void)read_mission("/no/such.toml", {}), std::invalid_argument);
  EXPECT_THROW((void)read_mission("/", {}), std::invalid_argument);
}

TEST(Mission, IsRefusedUnreadIfItIsNoFileOrTooLarge) {
  expect_all_refused(".toml", [](const std::string& path) { (void)read_mission(path, {}); });
}

}  // namespace
}  // namespace tumblesight::sim
