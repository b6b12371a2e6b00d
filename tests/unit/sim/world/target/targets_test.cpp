#include "sim/world/target/targets.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sim/world/target/mesh_file.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

// Verifies TS-TRN-090.
TEST(Targets, AreMissionsThatShip) {
  for (const Mission& mission : shipped_missions()) {
    EXPECT_EQ(mission_named(mission.name, {}).file, mission.file);
    EXPECT_EQ(mission_named(mission.file, {}).name, mission.name);
    EXPECT_TRUE(mission.inertia) << mission.name;
    EXPECT_TRUE(mission.panels) << mission.name;
    EXPECT_EQ(target_by_name(mission.name).name, mission.name);
  }
  EXPECT_THROW((void)mission_named("sputnik", {}), std::invalid_argument);
}

// A network is for what is in the hash: another name, mesh, axis, unit, origin, inertia or panel is another
// one.
TEST(Targets, AMissionIsIdentifiedByWhatItsNetworkIsTrainedFor) {
  const Mission magellan = mission_named("magellan", {});
  std::set<std::uint32_t> hashes{mission_crc32(magellan)};
  const auto expect_another = [&hashes](const Mission& mission, const char* what) {
    EXPECT_TRUE(hashes.insert(mission_crc32(mission)).second) << what;
  };
  Mission other = magellan;
  other.name = "sacd_aquarius";
  expect_another(other, "name");
  other = magellan;
  other.inertia->xx += 1.0;
  expect_another(other, "inertia");
  other = magellan;
  other.panels = JointLimits{0.0, 0.0};
  expect_another(other, "panels");
  const std::string path = testing::TempDir() + "mission_crc32.stl";
  std::ofstream(path) << "a mesh";
  other = magellan;
  other.mesh.file = path;
  expect_another(other, "mesh");
  other.mesh.up = "z";
  expect_another(other, "axis");
  other.mesh.scale = 0.001;
  expect_another(other, "unit");
  other.mesh.origin_trf_m[2] = 0.1;
  expect_another(other, "origin");
  std::ofstream(path) << "another mesh";
  expect_another(other, "content of the mesh");

  other = magellan;
  other.minutes = 5.0;
  other.title = "M";
  other.goals.clear();
  EXPECT_EQ(mission_crc32(other), mission_crc32(magellan)) << "goals and time do not change the network";
}

TEST(Targets, HaveTheirAxesAndOriginInTheInterfaceDocument) {
  std::ostringstream document;
  document << std::ifstream(TUMBLESIGHT_SOURCE_DIR "/docs/icd.md").rdbuf();
  for (const std::string& name : target_names())
    EXPECT_NE(document.str().find("\n| " + name + " | "), std::string::npos) << name;
}

TEST(Targets, AreFoundByNameValidAndFitTheSensor) {
  const std::vector<std::string> names = target_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "a key stands twice";
  for (const std::string& name : names) {
    EXPECT_TRUE(std::regex_match(name, std::regex("[a-z0-9_]{1,31}"))) << name;
    const TriangleMesh mesh = target_by_name(name);
    EXPECT_EQ(mesh.name, name);
    EXPECT_GT(mesh.triangles.size(), 1000U) << name;
    EXPECT_LT(mesh.triangles.size(), 7000U) << name;
    EXPECT_TRUE(is_sound(mesh)) << name;
    EXPECT_LT(mesh.radius_m(), kMaxMeshRadius_m) << name;
  }
}

TEST(Targets, UnknownNameIsRefusedWithTheKnownOnes) {
  const std::function<void()> calls[] = {[] { (void)target_by_name("sputnik"); },
                                         [] { (void)inertia_kg_m2("sputnik"); }};
  for (const auto& call : calls) {
    try {
      call();
      FAIL() << "no exception";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("sputnik"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("near_shoemaker"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("sacd_aquarius_stowed"), std::string::npos);
    }
  }
}

TEST(Targets, HaveADisplayNameAndOthersKeepTheirKey) {
  EXPECT_EQ(display_name("near_shoemaker"), "NEAR Shoemaker");
  EXPECT_EQ(display_name("mine"), "mine");
  EXPECT_EQ(find_target("mine"), nullptr);
  EXPECT_EQ(find_target("magellan")->quasi_symmetry_about_z, 2);
}

TEST(Targets, HaveJointsThatReachTheMeshsOwnPosition) {
  for (const std::string& name : target_names()) {
    EXPECT_LE(joint_limits(name).lowest_deg, 0.0) << name;
    EXPECT_GE(joint_limits(name).highest_deg, 0.0) << name;
  }
  EXPECT_EQ(joint_limits("near_shoemaker").highest_deg, 0.0) << "fixed";
  EXPECT_EQ(joint_limits("magellan").highest_deg, 180.0);
  EXPECT_EQ(joint_limits("mine").lowest_deg, -180.0);
}

// Symmetric, positive definite, and no principal moment exceeds the sum of the others.
TEST(Targets, InertiasAreThoseOfRigidBodies) {
  for (const std::string& name : target_names()) {
    const Eigen::Matrix3d inertia = inertia_kg_m2(name);
    EXPECT_EQ(inertia, inertia.transpose()) << name;
    const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
    EXPECT_GT(moments[0], 0.0) << name;
    EXPECT_LT(moments[2], moments[0] + moments[1]) << name;
  }
}

TEST(Targets, InertiasAreThePapers) {
  Eigen::Matrix3d near;
  near << 372.38, -2.86, -2.95, -2.86, 372.45, -4.42, -2.95, -4.42, 316.17;
  EXPECT_EQ(inertia_kg_m2("near_shoemaker"), near);
  Eigen::Matrix3d magellan;
  magellan << 3266.61, 2.62, 36.17, 2.62, 4772.03, -42.65, 36.17, -42.65, 2897.59;
  EXPECT_EQ(inertia_kg_m2("magellan"), magellan);
  // Given in y-up axes; ours are x, -z, y of those.
  Eigen::Matrix3d aquarius_y_up;
  aquarius_y_up << 2644.24, 972.97, -2.10, 972.97, 1329.64, 11.49, -2.10, 11.49, 3086.41;
  Eigen::Matrix3d r_trf_y_up;
  r_trf_y_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_EQ(inertia_kg_m2("sacd_aquarius"), r_trf_y_up * aquarius_y_up * r_trf_y_up.transpose());
  EXPECT_EQ(inertia_kg_m2("sacd_aquarius_stowed"), inertia_kg_m2("sacd_aquarius"));
}

}  // namespace
}  // namespace tumblesight::sim
