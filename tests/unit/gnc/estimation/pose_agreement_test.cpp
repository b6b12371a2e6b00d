#include "gnc/estimation/pose_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tumblesight::gnc {
namespace {

double real_of(Fixed value) {
  return std::ldexp(value.raw(), -24);
}

QuaternionQ30 turned_about_x(double angle_rad) {
  return {static_cast<std::int32_t>(std::lround(std::ldexp(std::cos(angle_rad / 2.0), 30))),
          static_cast<std::int32_t>(std::lround(std::ldexp(std::sin(angle_rad / 2.0), 30))), 0, 0};
}

// Verifies TS-EST-192.
TEST(PoseAgreement, OfAPoseIsTheAngleToItAndItsOwnUncertainty) {
  PoseEstimate pose;
  pose.doubts = kPoseMotion;
  pose.state.q_lrf_trf = turned_about_x(0.4);
  pose.covariance.sigma = {};
  for (const double angle_rad : {0.0, 0.0005, 0.02, 0.1, 0.349}) {
    for (const std::uint32_t sigma_urad : {0U, 525U, 20'000U}) {
      pose.covariance.sigma[0] = pose.covariance.sigma[2] = sigma_urad;
      ErrorEvidence evidence;
      add_pose(pose, turned_about_x(0.4 + angle_rad), evidence);
      EXPECT_TRUE(evidence.has_pose);
      EXPECT_TRUE(evidence.lacks_motion);
      EXPECT_NEAR(real_of(evidence.pose_error_rad), std::hypot(angle_rad, std::sqrt(2.0) * 1e-6 * sigma_urad),
                  1e-4)
          << angle_rad << ' ' << sigma_urad;
    }
  }
}

TEST(PoseAgreement, TakesNothingOfAPoseThatIsNotKnownOrOnlyPredicted) {
  for (const PoseDoubts doubts : {kPoseUnknown, kPoseCoasts, kPoseCoasts | kPoseMotion}) {
    PoseEstimate pose;
    pose.doubts = doubts;
    ErrorEvidence evidence;
    add_pose(pose, kIdentityQ30, evidence);
    EXPECT_FALSE(evidence.has_pose);
    EXPECT_FALSE(evidence.lacks_motion);
  }
}

// Whatever damaged memory holds.
TEST(PoseAgreement, OfADamagedPoseStaysWithinItsLimits) {
  PoseEstimate pose;
  pose.doubts = 0;
  pose.covariance.sigma.fill(0xFFFF'FFFFU);
  pose.state.q_lrf_trf = {0x7FFF'FFFF, -0x7FFF'FFFF, 0x7FFF'FFFF, 0x7FFF'FFFF};
  ErrorEvidence evidence;
  add_pose(pose, {-0x7FFF'FFFF, 0x7FFF'FFFF, -0x7FFF'FFFF, 0x7FFF'FFFF}, evidence);
  EXPECT_GE(evidence.pose_error_rad.raw(), 0);
  EXPECT_LT(evidence.pose_error_rad, Fixed(16.0));
}

// Each bit goes where it belongs, and those that do not count for the network's attitude go nowhere.
TEST(PoseAgreement, IsReadFromThePosesDoubts) {
  for (PoseDoubts doubts = 0; doubts < 256; ++doubts) {
    PoseEstimate pose;
    pose.doubts = doubts & ~(kPoseUnknown | kPoseCoasts);
    ErrorEvidence evidence;
    add_pose(pose, kIdentityQ30, evidence);
    EXPECT_TRUE(evidence.has_pose);
    EXPECT_EQ(evidence.ranges_disagree, (doubts & kPoseRanges) != 0);
    EXPECT_EQ(evidence.silhouette_disagrees, (doubts & kPoseOutline) != 0);
    EXPECT_EQ(evidence.lacks_motion, (doubts & kPoseMotion) != 0);
    EXPECT_EQ(evidence.is_far, (doubts & kPoseNetwork) != 0);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
