// From about ten degrees and some tens of centimetres off the true pose, the alignment converges to it.
#include "sim/baseline/alignment.hpp"

#include <gtest/gtest.h>

#include "tests/unit/sim/baseline/jointed_arm.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kDegree = 0.017453292519943295;

struct Aligned {
  double error_deg;
  double error_m;
  double residual_m;
  double residual_before_m;
};

// Noise-free, target off the boresight, start 12 degrees and 0.4 m away.
Aligned align(AlignmentPairs pairs, int iterations) {
  const TriangleMesh mesh = jointed_arm();
  const FlashLidar lidar(mesh);
  const double swath = swath_m(mesh);
  FrameTruth truth{Eigen::Quaterniond(0.5, 0.4, -0.6, 0.2).normalized(), Eigen::Vector3d::Zero(), 35.0};
  truth.offset_swaths = Eigen::Vector2d(0.1, 0.05);
  const auto scan = scan_of(lidar.true_ranges(truth, 128, swath));
  const Eigen::Vector3d origin_m(0.1 * swath, 35.0, 0.05 * swath);
  const Eigen::AngleAxisd off(12.0 * kDegree, Eigen::Vector3d(1.0, -2.0, 1.5).normalized());
  const TargetPose start{off * truth.q_lrf_trf, origin_m + Eigen::Vector3d(0.2, -0.3, 0.15)};
  const Alignment alignment(lidar, swath, pairs);
  const TargetPose end = alignment.refine(*scan, SilhouetteField(*scan), start, 128, iterations);
  return {end.q_lrf_trf.angularDistance(truth.q_lrf_trf) / kDegree, (end.origin_lrf_m - origin_m).norm(),
          alignment.residual_m(*scan, end, 128), alignment.residual_m(*scan, start, 128)};
}

TEST(Alignment, ConvergesToThePoseOfTheFrame) {
  const Aligned aligned = align(AlignmentPairs::kRangesAndSilhouette, 20);
  EXPECT_LT(aligned.error_deg, 0.5);
  EXPECT_LT(aligned.error_m, 0.02);
  EXPECT_LT(aligned.residual_m, 0.3 * aligned.residual_before_m);
}

TEST(Alignment, ConvergesWithRangesOnlyIfThereIsNoNoise) {
  const Aligned aligned = align(AlignmentPairs::kRangesOnly, 30);
  EXPECT_LT(aligned.error_deg, 1.0);
  EXPECT_LT(aligned.error_m, 0.1);
}

}  // namespace
}  // namespace tumblesight::sim
