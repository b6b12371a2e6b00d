#include "sim/adoption/mesh_gate.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

MeshInspection found_with(const std::string& key, Severity severity) {
  MeshInspection found;
  found.core_radius_m = 3.0;
  found.centred_radius_m = 2.9;
  found.findings.push_back({key, severity, "what was found", "what to do"});
  return found;
}

// Verifies TS-TRN-080.
TEST(MeshGate, FaultsStopAndLikelyMistakesSpeakAgainstGo) {
  const Mission mission;
  EXPECT_EQ(mesh_gate(mission, found_with("sphere", Severity::kFault)).faults.size(), 1U);
  for (const char* key : {"unit", "up", "strays", "marker", "hidden"}) {
    const MeshGate gate = mesh_gate(mission, found_with(key, Severity::kWarning));
    ASSERT_EQ(gate.doubts.size(), 1U) << key;
    EXPECT_NE(gate.doubts.front().find(std::string("accept = [\"") + key + "\"]"), std::string::npos);
  }
  for (const char* key : {"reach", "triangles", "symmetry"})
    EXPECT_TRUE(mesh_gate(mission, found_with(key, Severity::kWarning)).doubts.empty()) << key;
  EXPECT_EQ(mesh_gate(mission, found_with("open", Severity::kNote)).remarks.size(), 1U);
}

TEST(MeshGate, AnOriginSpeaksAgainstGoWhereAThirdOfTheResolutionIsLost) {
  MeshInspection found = found_with("origin", Severity::kWarning);
  EXPECT_TRUE(mesh_gate({}, found).doubts.empty());
  found.centred_radius_m = 1.9;
  EXPECT_EQ(mesh_gate({}, found).doubts.size(), 1U);
}

TEST(MeshGate, WhatTheMissionAcceptsIsARemark) {
  Mission mission;
  mission.accept = {"strays"};
  const MeshGate accepted = mesh_gate(mission, found_with("strays", Severity::kWarning));
  EXPECT_TRUE(accepted.doubts.empty());
  EXPECT_EQ(accepted.remarks.size(), 1U);
}

TEST(MeshGate, ASymmetryIsNoFaultOnceTheMissionStatesIt) {
  Mission mission;
  EXPECT_EQ(mesh_gate(mission, found_with("symmetry", Severity::kFault)).faults.size(), 1U);
  mission.symmetry = {"z:4"};
  EXPECT_TRUE(mesh_gate(mission, found_with("symmetry", Severity::kFault)).faults.empty());
  EXPECT_EQ(mesh_gate(mission, found_with("sphere", Severity::kFault)).faults.size(), 1U)
      << "of a sphere no attitude can be told";
}

TEST(MeshGate, PanelsOfWhichTheMissionSaysNothingAreRemarkedUpon) {
  MeshInspection found;
  found.panels = 2;
  EXPECT_EQ(mesh_gate({}, found).remarks.size(), 1U);
  Mission mission;
  mission.panels = JointLimits{0.0, 0.0};
  EXPECT_TRUE(mesh_gate(mission, found).remarks.empty());
}

// Of a ball of iron of a radius of 2 m: 0.4 * 7870 * 4/3 pi 2^3 * 2^2.
TEST(MeshGate, AnInertiaOfMoreThanABallOfIronIsAFault) {
  MeshInspection found;
  found.radius_m = 2.0;
  Mission mission;
  mission.inertia = InertiaElements{400.0, 380.0, 300.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(mesh_gate(mission, found).faults.empty());
  mission.inertia = InertiaElements{4.21e5, 4.21e5, 4.21e5, 0.0, 0.0, 0.0};
  EXPECT_TRUE(mesh_gate(mission, found).faults.empty());
  mission.inertia = InertiaElements{4.23e5, 4.21e5, 4.21e5, 0.0, 0.0, 0.0};
  ASSERT_EQ(mesh_gate(mission, found).faults.size(), 1U);
  EXPECT_NE(mesh_gate(mission, found).faults.front().find("give it in kg m2"), std::string::npos);
}

TEST(MeshGate, PanelsThatTurnMustBeFoundInTheMesh) {
  Mission mission;
  mission.panels = JointLimits{-90.0, 90.0};
  EXPECT_EQ(mesh_gate(mission, MeshInspection{}).faults.size(), 1U);
  MeshInspection found;
  found.panels = 1;
  EXPECT_TRUE(mesh_gate(mission, found).faults.empty());
}

}  // namespace
}  // namespace tumblesight::sim
