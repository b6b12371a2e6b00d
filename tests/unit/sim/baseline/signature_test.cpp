// Signatures are centred on the returns, so the position in the frame does not matter, and rotate with
// the target.
#include "sim/baseline/signature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/sensor/flash_lidar.hpp"
#include "tests/unit/sim/baseline/jointed_arm.hpp"

namespace tumblesight::sim {
namespace {

Signature signature_at(const Eigen::Quaterniond& q_lrf_trf, double range_m,
                       const Eigen::Vector2d& offset_swaths, double roll_rad = 0.0) {
  const TriangleMesh mesh = jointed_arm();
  FrameTruth truth{q_lrf_trf, Eigen::Vector3d::Zero(), range_m};
  truth.offset_swaths = offset_swaths;
  const auto scan = scan_of(FlashLidar(mesh).true_ranges(truth, 128, swath_m(mesh)));
  return signature_of(*scan, scan->towards, roll_rad, mesh.radius_m());
}

double nothing_in_common(const Signature& a) {
  Signature empty;
  empty.known.fill(-1);
  return difference(empty, a, 1.0);
}

const Eigen::Quaterniond kAttitude = Eigen::Quaterniond(0.7, -0.2, 0.3, 0.5).normalized();

TEST(Signature, RotatesWithTheTargetAboutTheBoresight) {
  const Signature turned_by_hand = signature_at(kAttitude, 40.0, Eigen::Vector2d::Zero(), 0.5 * M_PI);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()));
  const Signature turned_target = signature_at(turn * kAttitude, 40.0, Eigen::Vector2d::Zero());
  const Signature upright = signature_at(kAttitude, 40.0, Eigen::Vector2d::Zero());
  const Signature permuted = quarter_turned(upright);
  EXPECT_LT(difference(permuted, turned_by_hand, 1.0), 1e-3 * nothing_in_common(upright));
  EXPECT_LT(difference(permuted, turned_target, 1.0), 0.02 * nothing_in_common(upright));
  EXPECT_GT(difference(permuted, upright, 1.0), 0.3 * nothing_in_common(upright));
}

TEST(Signature, DependsNeitherOnThePositionInTheFrameNorOnTheRange) {
  const Signature centred = signature_at(kAttitude, 80.0, Eigen::Vector2d::Zero());
  // Off the boresight by v = (right, 1, up) the target shows another side, unless it is rotated with the
  // view.
  const double swath = swath_m(jointed_arm());
  const Eigen::Vector3d towards(0.1 * swath, 60.0, -0.08 * swath);
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), towards);
  const Signature beside = signature_at(turn * kAttitude, 60.0, Eigen::Vector2d(0.1, -0.08));
  EXPECT_LT(difference(beside, centred, 1.0), 0.03 * nothing_in_common(centred));
}

TEST(Signature, ComparesOnlyTheKnownCellsOfTheMeasuredOne) {
  const Signature rendered = signature_at(kAttitude, 40.0, Eigen::Vector2d::Zero());
  Signature measured = rendered;
  for (int i = 0; i < Signature::kCells / 2; ++i)
    measured.known[i] = measured.cover[i] = measured.depth[i] = 0;
  EXPECT_EQ(difference(measured, rendered, 1.0), 0.0);
}

}  // namespace
}  // namespace tumblesight::sim
