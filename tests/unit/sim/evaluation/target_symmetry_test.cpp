// Verifies TS-SIL-390.
#include "sim/evaluation/target_symmetry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/math/angles.hpp"
#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();
const Eigen::Quaterniond kTruth = turned(70.0, {1.0, -2.0, 0.5});

double left_deg(const Eigen::Quaterniond& estimate, const TargetSymmetry& symmetry) {
  return kDegPerRad * angular_error_rad(kTruth, nearest_equivalent(estimate, kTruth, symmetry));
}

TEST(TargetSymmetry, WithoutOneAnEstimateKeepsItsBits) {
  const Eigen::Quaterniond estimate(0.1, -0.7, 0.3, 0.2);  // not even a unit quaternion
  EXPECT_EQ(nearest_equivalent(estimate, kTruth, {}).coeffs(), estimate.coeffs());
  EXPECT_TRUE(TargetSymmetry().is_none());
  EXPECT_EQ(to_string(TargetSymmetry()), "");
}

TEST(TargetSymmetry, EveryQuarterTurnAboutTheAxisIsRight) {
  const TargetSymmetry symmetry({{kZ, 4}});
  EXPECT_EQ(symmetry.turns_trf().size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Quaterniond same = kTruth * turned(90.0 * i, kZ);
    EXPECT_NEAR(left_deg(same, symmetry), 0.0, 1e-6) << i;
    EXPECT_NEAR(left_deg(same * turned(3.0, kX), symmetry), 3.0, 1e-6) << i;
    EXPECT_NEAR(left_deg(Eigen::Quaterniond(-(same * turned(50.0, kZ)).coeffs()), symmetry), 40.0, 1e-6);
  }
  EXPECT_NEAR(left_deg(kTruth * turned(180.0, kX), symmetry), 180.0, 1e-6)
      << "upside down is another attitude";
}

// The turn is in the axes of the target, not of the sensor.
TEST(TargetSymmetry, TurnsTheTargetAboutItsOwnAxis) {
  const TargetSymmetry symmetry({{kZ, 2}});
  EXPECT_NEAR(left_deg(kTruth * turned(180.0, kZ), symmetry), 0.0, 1e-6);
  EXPECT_GT(left_deg(turned(180.0, kZ) * kTruth, symmetry), 20.0);
}

TEST(TargetSymmetry, OfABodyOfRevolutionOnlyTheDirectionOfTheAxisCounts) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.6, 0.0, 0.8);
  const TargetSymmetry symmetry({{axis, kAnyTurn}});
  for (const double about_deg : {0.0, 33.3, 180.0, 271.0}) {
    for (const double tilt_deg : {0.0, 12.0, 90.0, 179.0}) {
      const Eigen::Quaterniond estimate = kTruth * turned(tilt_deg, kY) * turned(about_deg, axis);
      EXPECT_NEAR(left_deg(estimate, symmetry), tilt_deg, 1e-6)
          << about_deg;  // y is perpendicular to the axis
    }
  }
}

TEST(TargetSymmetry, OfABodyOfRevolutionWithAHalfTurnAcrossTheAxisHasNoSense) {
  const TargetSymmetry symmetry({{kZ, kAnyTurn}, {kX, 2}, {kY, 2}, {kZ, 3}});
  EXPECT_EQ(symmetry.turns_trf().size(), 2U);
  EXPECT_NEAR(left_deg(kTruth * turned(179.0, kY) * turned(77.0, kZ), symmetry), 1.0, 1e-6);
  EXPECT_NEAR(left_deg(kTruth * turned(90.0, kY), symmetry), 90.0, 1e-6);
}

TEST(TargetSymmetry, SeveralAxesGenerateTheirGroup) {
  EXPECT_EQ(TargetSymmetry({{kZ, 4}, {kX, 2}}).turns_trf().size(), 8U) << "a square prism";
  EXPECT_EQ(TargetSymmetry({{kX, 2}, {kY, 2}}).turns_trf().size(), 4U) << "a box";
  const Eigen::Vector3d corner = Eigen::Vector3d(1.0, 1.0, 1.0).normalized();
  EXPECT_EQ(TargetSymmetry({{kZ, 4}, {corner, 3}}).turns_trf().size(), 24U) << "a cube";
  const Eigen::Vector3d vertex = Eigen::Vector3d(0.0, 1.0, 0.5 + std::sqrt(1.25)).normalized();
  EXPECT_EQ(TargetSymmetry({{vertex, 5}, {corner, 3}}).turns_trf().size(), 60U) << "an icosahedron";
  EXPECT_EQ(TargetSymmetry({{kZ, 60}}).turns_trf().size(), 60U);
}

// A cube: no attitude is more than about 62.8 degrees off.
TEST(TargetSymmetry, FindsTheNearestOfAGroup) {
  const TargetSymmetry cube({{kZ, 4}, {kX, 4}});
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond estimate =
        kTruth * turned(1.9 * i, {std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i)});
    EXPECT_LE(left_deg(estimate, cube), 62.81) << i;
  }
}

TEST(TargetSymmetry, IsReadFromAxesAndFolds) {
  EXPECT_EQ(to_string(target_symmetry_from({"z:4", "x:2"})), "1/4 turn about z, 1/2 turn about x");
  EXPECT_EQ(to_string(target_symmetry_from({"-0.0,3,4:any"})), "any turn about (-0.00, 0.60, 0.80)");
  EXPECT_EQ(target_symmetry_from({"0.5,0.5,0.7:2"}).turns_trf().size(), 2U);
  EXPECT_EQ(target_symmetry_from({"z:4", "0.58,0.58,0.58:3"}).turns_trf().size(), 24U) << "few digits";
  EXPECT_TRUE(target_symmetry_from({}).is_none());
}

TEST(TargetSymmetry, NamesWhatIsWrongWithIt) {
  const auto fault_of = [](const std::vector<std::string>& texts) -> std::string {
    try {
      (void)target_symmetry_from(texts);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  for (const char* text : {"", "z", "z:", ":2", "z:1", "z:61", "z:-2", "z:2.5", "w:2", "1,2:2", "1,2,3,4:2",
                           "0,0,0:2", "1,nan,0:2", "1,inf,0:2", "1,,0:2", "z:4:2", "z: 4"})
    EXPECT_EQ(fault_of({text}).find("'" + std::string(text) + "' is not AXIS:FOLD"), 0U) << text;
  EXPECT_NE(fault_of({"z:7", "x:3"}).find("more than 60 attitudes look the same"), std::string::npos);
  EXPECT_NE(fault_of({"z:any", "x:any"}).find("is a sphere"), std::string::npos);
  EXPECT_NE(fault_of({"z:any", "x:3"}).find("is a sphere"), std::string::npos);
  EXPECT_NE(fault_of({"z:any", "1,0,1:2"}).find("is a sphere"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
