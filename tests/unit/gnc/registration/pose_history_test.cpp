#include "gnc/registration/pose_history.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "gnc/attitude/motion.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 matrix_of(const std::array<std::int32_t, kElements>& information) {
  Matrix6 matrix;
  for (int i = 0; i < kUnknowns; ++i)
    for (int k = 0; k <= i; ++k) matrix(i, k) = matrix(k, i) = information[element(i, k)] / 16.0;
  return matrix;
}

PoseMeasurement marked(std::int32_t mark) {
  PoseMeasurement measurement;
  measurement.pose.origin_lrf_um = {mark, 0, 0};
  return measurement;
}
int mark_of(const PoseHistory& history, int index) {
  return history.poses[static_cast<std::size_t>(index)].pose.origin_lrf_um[0];
}

TEST(PoseHistory, ForgetsTheOldest) {
  const auto history = std::make_unique<PoseHistory>();
  for (int i = 0; i < PoseHistory::kMost + 3; ++i) history->add(marked(i));
  ASSERT_EQ(history->count, PoseHistory::kMost);
  for (int i = 0; i < PoseHistory::kMost; ++i) EXPECT_EQ(mark_of(*history, i), i + 3);
}

TEST(PoseHistory, RemovesThePosesThatAreNamed) {
  for (unsigned bits = 0; bits < 32; ++bits) {
    const auto history = std::make_unique<PoseHistory>();
    for (int i = 0; i < 5; ++i) history->add(marked(i));
    history->remove(bits);
    int kept = 0;
    for (int i = 0; i < 5; ++i) {
      if (((bits >> i) & 1U) != 0) continue;
      ASSERT_LT(kept, history->count);
      EXPECT_EQ(mark_of(*history, kept++), i);
    }
    EXPECT_EQ(history->count, kept);
  }
}

TEST(PoseHistory, ForgetsPosesThatAreTooOld) {
  const auto history = std::make_unique<PoseHistory>();
  history->add(marked(1));
  history->advance(kNominalPeriod_ns, Matrix3<Fixed>::Identity());
  history->add(marked(2));
  history->advance(15 * kNominalPeriod_ns, Matrix3<Fixed>::Identity());
  ASSERT_EQ(history->count, 2);  // exactly 16 periods
  history->advance(1, Matrix3<Fixed>::Identity());
  ASSERT_EQ(history->count, 1);
  EXPECT_EQ(mark_of(*history, 0), 2);
  EXPECT_EQ(history->poses[0].age_ns, 15 * kNominalPeriod_ns + 1);
}

TEST(PoseHistory, ForgetsAllPosesAfterAnyLongTime) {
  for (const std::int64_t elapsed_ns : {PoseHistory::kOldest_ns + 1, INT64_MAX}) {
    const auto history = std::make_unique<PoseHistory>();
    history->add(marked(1));
    history->advance(kNominalPeriod_ns, Matrix3<Fixed>::Identity());
    history->advance(elapsed_ns, Matrix3<Fixed>::Identity());
    EXPECT_EQ(history->count, 0) << elapsed_ns;
  }
}

TEST(PoseHistory, TurnsWithTheSensor) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Matrix6 root = Matrix6::NullaryExpr([&random] { return random.uniform(-100.0, 100.0); });
    const Matrix6 information = root * root.transpose();
    const ExactPose pose{random.rotation(), {1.0, 40.0, -2.0}};
    NormalEquations equations;
    for (int row = 0; row < kUnknowns; ++row)
      for (int column = 0; column <= row; ++column)
        equations.information[element(row, column)] = std::llround(4096.0 * information(row, column));
    const auto history = std::make_unique<PoseHistory>();
    history->add(measured_pose(fixed(pose), equations));
    const Matrix6 before = matrix_of(history->poses[0].information);
    const Pose turn = fixed({random.rotation(), {0.0, 0.0, 0.0}});
    history->advance(kNominalPeriod_ns, turn.r_lrf_trf);

    const Eigen::Matrix3d r = exact(turn).r_lrf_trf;
    Matrix6 both = Matrix6::Zero();
    both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = r;
    const Matrix6 after = matrix_of(history->poses[0].information);
    EXPECT_LT((after - both * before * both.transpose()).cwiseAbs().maxCoeff(), 1e-5 * before.norm() + 0.2);
    const ExactPose found = exact(history->poses[0].pose);
    EXPECT_LT((found.r_lrf_trf - r * pose.r_lrf_trf).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((found.origin_m - r * pose.origin_m).norm(), 1e-5);
  }
}

TEST(PoseHistory, StaysAsItIsInALrfThatDoesNotTurn) {
  Random random(2);
  const auto history = std::make_unique<PoseHistory>();
  PoseMeasurement measurement;
  for (std::int32_t& value : measurement.information) value = random.below(1 << 24) - (1 << 23);
  history->add(measurement);
  for (int i = 0; i < 10; ++i) history->advance(kNominalPeriod_ns, Matrix3<Fixed>::Identity());
  EXPECT_EQ(history->poses[0].information, measurement.information);
}

TEST(MeasuredPose, AQuarterOfTheInformationCountsUpToALimit) {
  constexpr double kDegree = M_PI / 180.0;
  for (const double sigma_deg : {10.0, 1.0, 0.1, 0.03, 0.001}) {
    NormalEquations equations;
    const double information = std::pow(sigma_deg * kDegree, -2.0);
    equations.information[element(0, 0)] = std::llround(4096.0 * information);
    equations.information[element(4, 4)] = std::llround(4096.0 * 0.5 * information);
    const Matrix6 used = matrix_of(measured_pose(Pose(), equations).information);
    const double limited = std::min(0.25 * information, std::pow(0.05 * kDegree, -2.0));
    EXPECT_NEAR(used(0, 0), limited + 1.0, 0.01 * limited + 0.2) << sigma_deg;
    EXPECT_NEAR(used(4, 4), 0.5 * limited + 1.0, 0.01 * limited + 0.2) << sigma_deg;
    EXPECT_EQ(used(1, 1), 1.0);  // a radian, of what the frame says nothing about
  }
}

}  // namespace
}  // namespace tumblesight::gnc
