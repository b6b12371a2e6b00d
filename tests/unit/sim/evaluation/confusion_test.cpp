#include "sim/evaluation/confusion.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

// The truth rotated about the target's z axis, then by `blur_deg` about some axis.
FrameResult confused(double about_z_deg, double blur_deg) {
  FrameResult made = result_with(0, 9, 0.0, 0.0);
  made.rcnn = turned(blur_deg, {0.2, -0.9, 0.4}) * made.truth * turned(about_z_deg, {0.0, 0.0, 1.0});
  return made;
}

TEST(Confusion, DistinguishesTheSymmetricAttitudesOfNear) {
  const std::vector<FrameResult> results{confused(0.0, 1.0),   confused(0.0, 3.0),   confused(90.0, 2.0),
                                         confused(180.0, 4.0), confused(-90.0, 5.0), confused(45.0, 0.0)};
  const Confusion found = confusion(results, Estimator::kRcnn, near_symmetries("near_shoemaker"));
  EXPECT_EQ(found.names, (std::vector<std::string>{"right", "+90°", "180°", "−90°"}));
  EXPECT_EQ(found.count, 6U);
  EXPECT_DOUBLE_EQ(found.shares[0], 2.0 / 6.0);
  for (int i = 1; i < 4; ++i) EXPECT_DOUBLE_EQ(found.shares[static_cast<std::size_t>(i)], 1.0 / 6.0) << i;
  EXPECT_DOUBLE_EQ(found.none, 1.0 / 6.0);
  EXPECT_NEAR(found.blur_deg, (1.0 + 3.0 + 2.0 + 4.0 + 5.0 + 45.0) / 6.0, 1e-9);
}

// A rotation about the LiDAR's z axis instead of the target's is not a confusion of symmetric attitudes.
TEST(Confusion, RotatesInTheTargetsFrame) {
  FrameResult made = result_with(0, 9, 0.0, 0.0);
  made.rcnn = turned(90.0, {0.0, 0.0, 1.0}) * made.truth;
  const Confusion found = confusion({made}, Estimator::kRcnn, near_symmetries("near_shoemaker"));
  EXPECT_DOUBLE_EQ(found.none, 1.0);
}

TEST(Confusion, OfATargetWithoutSymmetriesIsOneRightAttitude) {
  const Confusion found =
      confusion({confused(180.0, 0.0), confused(0.0, 19.0)}, Estimator::kRcnn, near_symmetries("mine"));
  EXPECT_EQ(found.shares, std::vector<double>{0.5});
  EXPECT_DOUBLE_EQ(found.none, 0.5);
  EXPECT_NEAR(found.blur_deg, 0.5 * (180.0 + 19.0), 1e-9);
}

TEST(Confusion, CountsAMissingEstimateAsNone) {
  FrameResult missing = confused(0.0, 0.0);
  missing.valid = false;
  const Confusion found = confusion({missing}, Estimator::kRcnn, near_symmetries("magellan"));
  EXPECT_EQ(found.shares.size(), 2U);
  EXPECT_DOUBLE_EQ(found.none, 1.0);
  EXPECT_DOUBLE_EQ(found.blur_deg, 180.0);
}

}  // namespace
}  // namespace tumblesight::sim
