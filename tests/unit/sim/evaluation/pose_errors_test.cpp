// Errors of registered poses, in closed form and over rendered sequences.
#include "sim/evaluation/pose_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/experiment/experiment.hpp"
#include "sim/experiment/monte_carlo.hpp"
#include "sim/model/model_file.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwath_m = 8.0;
constexpr double kQuantile = 12.5916;  // chi square, six degrees of freedom, 95 %

FrameTruth truth() {
  FrameTruth made;
  made.q_lrf_trf = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  made.rate_lrf_rad_s = {0.1, -0.05, 0.2};
  made.range_m = 40.0;
  made.offset_swaths = {0.125, -0.25};  // 1 m, -2 m
  made.velocity_lrf_m_s = {0.01, -0.25, 0.02};
  return made;
}

std::int32_t micro(double value) {
  return static_cast<std::int32_t>(std::lround(1e6 * value));
}

std::array<std::int32_t, 3> micro(const Eigen::Vector3d& vector) {
  return {micro(vector.x()), micro(vector.y()), micro(vector.z())};
}

// Off by the given turn and move [rad, m]; one unit of standard deviation each.
StatedPose pose_off_by(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& move_m) {
  StatedPose pose;
  pose.doubts = 0;
  const double angle = turn_rad.norm();
  const Eigen::Vector3d axis =
      angle > 0.0 ? Eigen::Vector3d(turn_rad / angle) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  const Eigen::Quaterniond q = Eigen::AngleAxisd(angle, axis) * truth().q_lrf_trf;
  const auto q30 = [](double part) { return static_cast<std::int32_t>(std::lround(std::ldexp(part, 30))); };
  pose.state.q_lrf_trf = {q30(q.w()), q30(q.x()), q30(q.y()), q30(q.z())};
  pose.state.origin_lrf_um = micro(Eigen::Vector3d(1.0, 40.0, -2.0) + move_m);
  pose.state.rate_lrf_urad_s = micro(truth().rate_lrf_rad_s);
  pose.state.velocity_lrf_um_s = micro(truth().velocity_lrf_m_s);
  pose.covariance.sigma.fill(1000);  // 1 mrad, 1 mrad/s, 1 mm, 1 mm/s
  return pose;
}

// Place of the correlation of unknown `row` with an earlier one.
std::size_t place(int row, int column) {
  return static_cast<std::size_t>(row * (row - 1) / 2 + column);
}

TEST(PoseErrors, AreZeroForTheTruth) {
  const PoseErrors errors =
      pose_errors(pose_off_by(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()), truth(), kSwath_m);
  EXPECT_TRUE(errors.known);
  EXPECT_TRUE(errors.verified);
  EXPECT_LT(errors.turn_deg, 1e-6);
  EXPECT_LT(errors.across_m + errors.along_m, 1e-6);
  EXPECT_LT(errors.rate_deg_s, 1e-4);
  EXPECT_LT(errors.velocity_m_s, 1e-6);
  EXPECT_TRUE(errors.inside_95);
}

TEST(PoseErrors, AreThoseOfEachPart) {
  StatedPose pose = pose_off_by({0.0, 0.02, 0.0}, {0.003, -0.2, 0.004});
  pose.state.rate_lrf_urad_s[1] += micro(0.01);
  pose.state.velocity_lrf_um_s[0] += micro(0.03);
  pose.state.velocity_lrf_um_s[2] -= micro(0.04);
  const PoseErrors errors = pose_errors(pose, truth(), kSwath_m);
  EXPECT_NEAR(errors.turn_deg, 0.02 * kDegPerRad, 1e-6);
  EXPECT_NEAR(errors.across_m, 0.005, 1e-6);
  EXPECT_NEAR(errors.along_m, 0.2, 1e-6);
  EXPECT_NEAR(errors.rate_deg_s, 0.01 * kDegPerRad, 1e-4);
  EXPECT_NEAR(errors.velocity_m_s, 0.05, 2e-6);
  EXPECT_FALSE(errors.inside_95);
}

TEST(PoseErrors, DoNotDependOnTheSignOfTheQuaternion) {
  StatedPose pose = pose_off_by({0.001, 0.0, 0.0}, Eigen::Vector3d::Zero());
  for (std::int32_t& part : pose.state.q_lrf_trf) part = -part;
  const PoseErrors errors = pose_errors(pose, truth(), kSwath_m);
  EXPECT_NEAR(errors.turn_deg, 0.001 * kDegPerRad, 1e-6);
  EXPECT_TRUE(errors.inside_95);
}

// Verifies TS-SIL-390.
TEST(PoseErrors, AreToTheNearestAttitudeThatLooksTheSame) {
  // A quarter turn about the target's z, and 1 mrad.
  const Eigen::Vector3d z_lrf = truth().q_lrf_trf * Eigen::Vector3d::UnitZ();
  const StatedPose pose = pose_off_by((kPi / 2.0 + 0.001) * z_lrf, Eigen::Vector3d::Zero());
  EXPECT_NEAR(pose_errors(pose, truth(), kSwath_m).turn_deg, 90.0573, 1e-3);
  const PoseErrors errors = pose_errors(pose, truth(), kSwath_m, target_symmetry_from({"z:4"}));
  EXPECT_NEAR(errors.turn_deg, 0.001 * kDegPerRad, 1e-5);
  EXPECT_TRUE(errors.inside_95);
}

TEST(PoseErrors, WithoutAPoseAreAHalfTurn) {
  StatedPose pose = pose_off_by(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  pose.doubts = gnc::kPoseUnknown;
  const PoseErrors errors = pose_errors(pose, truth(), kSwath_m);
  EXPECT_FALSE(errors.known);
  EXPECT_FALSE(errors.verified);
  EXPECT_EQ(errors.turn_deg, 180.0);
  EXPECT_FALSE(errors.inside_95);
}

TEST(PoseErrors, OfADoubtfulPoseAreKnownAndNotVerified) {
  StatedPose pose = pose_off_by(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  pose.doubts = gnc::kPoseMotion;
  const PoseErrors errors = pose_errors(pose, truth(), kSwath_m);
  EXPECT_TRUE(errors.known);
  EXPECT_FALSE(errors.verified);
  EXPECT_LT(errors.turn_deg, 1e-6);
}

bool inside(const StatedPose& pose) {
  return pose_errors(pose, truth(), kSwath_m).inside_95;
}

TEST(PoseEllipsoid, EndsAtTheQuantileAlongEveryAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [&](double length) {
      return Eigen::Vector3d(length * 1e-3 * Eigen::Vector3d::Unit(axis));
    };
    const double edge = std::sqrt(kQuantile);
    EXPECT_TRUE(inside(pose_off_by(along(0.99 * edge), Eigen::Vector3d::Zero()))) << axis;
    EXPECT_FALSE(inside(pose_off_by(along(1.01 * edge), Eigen::Vector3d::Zero()))) << axis;
    EXPECT_TRUE(inside(pose_off_by(Eigen::Vector3d::Zero(), along(0.99 * edge)))) << axis;
    EXPECT_FALSE(inside(pose_off_by(Eigen::Vector3d::Zero(), along(1.01 * edge)))) << axis;
    // Turn and position share one quantile.
    EXPECT_FALSE(inside(pose_off_by(along(0.8 * edge), along(0.8 * edge)))) << axis;
  }
}

// Two errors e with a correlation r: e' C^-1 e = 2 e^2 / (1 + r) if they have the same sign, and
// 2 e^2 / (1 - r) otherwise.
TEST(PoseEllipsoid, FollowsCorrelations) {
  constexpr double kCorrelation = 0.75;
  const auto correlated = [&](double turn, double move, bool swapped) {
    StatedPose pose =
        pose_off_by({swapped ? 0.0 : turn, swapped ? turn : 0.0, 0.0}, {0.0, 0.0, swapped ? 0.0 : move});
    // Turn about x with position along z: unknowns 0 and 8. Turns about x and y: 0 and 1.
    pose.covariance.correlation_q15[place(8, 0)] = static_cast<std::int16_t>(32768 * kCorrelation);
    return inside(pose);
  };
  const double same = 1e-3 * std::sqrt(0.5 * kQuantile * (1.0 + kCorrelation));
  const double opposite = 1e-3 * std::sqrt(0.5 * kQuantile * (1.0 - kCorrelation));
  EXPECT_TRUE(correlated(0.99 * same, 0.99 * same, false));
  EXPECT_FALSE(correlated(1.01 * same, 1.01 * same, false));
  EXPECT_TRUE(correlated(0.99 * opposite, -0.99 * opposite, false));
  EXPECT_FALSE(correlated(1.01 * opposite, -1.01 * opposite, false));
  EXPECT_TRUE(correlated(1e-3 * 0.99 * std::sqrt(kQuantile), 0.0, true)) << "another axis";
}

// Those of rate and velocity do not enter.
TEST(PoseEllipsoid, IsOfTurnAndPosition) {
  StatedPose pose = pose_off_by(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  pose.state.rate_lrf_urad_s[0] += micro(0.5);
  pose.state.velocity_lrf_um_s[0] += micro(0.5);
  EXPECT_TRUE(inside(pose));
}

PoseErrors errors_of(double turn_deg, bool verified, bool inside_95) {
  PoseErrors errors;
  errors.known = true;
  errors.verified = verified;
  errors.turn_deg = turn_deg;
  errors.across_m = 0.01 * turn_deg;
  errors.along_m = 0.02 * turn_deg;
  errors.rate_deg_s = 0.03 * turn_deg;
  errors.velocity_m_s = 0.04 * turn_deg;
  errors.inside_95 = inside_95;
  return errors;
}

TEST(PoseSummary, MatchesFiguresCalculatedByHand) {
  const PoseSummary summary =
      summarise_poses({errors_of(1.0, true, true), errors_of(3.0, true, false), errors_of(8.0, true, false),
                       errors_of(90.0, false, false), PoseErrors()});
  EXPECT_EQ(summary.count, 5U);
  EXPECT_DOUBLE_EQ(summary.known, 0.8);
  EXPECT_DOUBLE_EQ(summary.mean_deg, 282.0 / 5.0);
  EXPECT_DOUBLE_EQ(summary.mean_within_20_deg, 4.0);
  EXPECT_DOUBLE_EQ(summary.median_deg, 8.0);
  EXPECT_DOUBLE_EQ(summary.within_20deg, 0.6);
  EXPECT_DOUBLE_EQ(summary.across_m, 0.04);
  EXPECT_DOUBLE_EQ(summary.along_m, 0.08);
  EXPECT_DOUBLE_EQ(summary.rate_deg_s, 0.12);
  EXPECT_DOUBLE_EQ(summary.velocity_m_s, 0.16);
  EXPECT_DOUBLE_EQ(summary.verified, 0.6);
  EXPECT_DOUBLE_EQ(summary.verified_wrong, 0.2) << "the one 8 degrees off";
  EXPECT_DOUBLE_EQ(summary.inside_95, 1.0 / 3.0) << "of the verified ones";
}

TEST(PoseSummary, HasNoMeanOfWhatThereIsNot) {
  const PoseSummary wrong = summarise_poses({errors_of(30.0, false, false)});
  EXPECT_DOUBLE_EQ(wrong.mean_deg, 30.0);
  EXPECT_TRUE(std::isnan(wrong.mean_within_20_deg));
  EXPECT_TRUE(std::isnan(wrong.across_m));
  EXPECT_TRUE(std::isnan(wrong.velocity_m_s));
  EXPECT_TRUE(std::isnan(wrong.inside_95)) << "none is verified";
  EXPECT_EQ(wrong.verified, 0.0);
  const PoseSummary none = summarise_poses({PoseErrors(), PoseErrors()});
  EXPECT_EQ(none.count, 2U);
  EXPECT_EQ(none.known, 0.0);
  EXPECT_EQ(none.mean_deg, 180.0);
  EXPECT_EQ(summarise_poses({}).count, 0U);
}

TEST(PoseSummary, IsOfOneFrameOfEverySequence) {
  std::vector<FrameResult> results(6);
  for (std::uint32_t i = 0; i < 6; ++i) {
    results[i].sequence = i / 3;
    results[i].frame = i % 3;
    results[i].pose = errors_of(1.0 + i, true, true);
  }
  EXPECT_DOUBLE_EQ(pose_summary(results, 0).mean_deg, 2.5);
  EXPECT_DOUBLE_EQ(pose_summary(results, 2).mean_deg, 4.5);
  EXPECT_EQ(pose_summary(results, 3).count, 0U);
}

class ShippedPoses : public ::testing::Test {
 protected:
  ShippedPoses() {
    subject_.target = "near_shoemaker";
    subject_.mesh_name = kParametricMesh;
    subject_.mesh = target_by_name("near_shoemaker");
    subject_.swath_m = swath_m(subject_.mesh);
    settings_.sequences = 6;
    settings_.frames = 10;
    settings_.baseline_sequences = 0;
    settings_.threads = 2;
  }
  CellResult cell_with(const char* image) {
    subject_.model_name = image;
    subject_.model = read_model_bytes(std::string(TUMBLESIGHT_SOURCE_DIR "/fsw/models/") + image);
    return run_experiment(subject_, settings_, [](std::uint64_t) {}).cells.front();
  }

  Subject subject_;
  ExperimentSettings settings_;
};

TEST_F(ShippedPoses, AreSharperThanTheNetworksAttitudes) {
  const CellResult cell = cell_with("near_shoemaker.tsm");
  EXPECT_EQ(cell.pose.known, 1.0);
  EXPECT_EQ(cell.pose.count, 6U);
  EXPECT_LT(cell.pose.mean_deg, 0.5);
  EXPECT_GT(cell.rcnn.mean_deg, 2.0 * cell.pose.mean_deg);
  EXPECT_LT(cell.pose.across_m, 0.05);
  EXPECT_LT(cell.pose.along_m, 0.05);
  EXPECT_LT(cell.pose.rate_deg_s, 0.1);
  EXPECT_LT(cell.pose.velocity_m_s, 0.01);
  EXPECT_GE(cell.pose.verified, 0.5);
  EXPECT_EQ(cell.pose.verified_wrong, 0.0);
  EXPECT_EQ(cell.pose_first.count, 6U);
  EXPECT_EQ(cell.pose_first.verified, 0.0) << "one pose says nothing of the motion";
}

TEST_F(ShippedPoses, AreNoneWithoutASurfaceInTheImage) {
  settings_.sequences = 2;
  settings_.frames = 2;
  const CellResult cell = cell_with("near_shoemaker.float32.tsm");
  EXPECT_EQ(cell.pose.known, 0.0);
  EXPECT_EQ(cell.pose.mean_deg, 180.0);
  EXPECT_LT(cell.rcnn.median_deg, 180.0);
}

}  // namespace
}  // namespace tumblesight::sim
