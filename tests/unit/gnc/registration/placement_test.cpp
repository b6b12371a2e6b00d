// Where a target of known attitude is put in a frame.
#include "gnc/registration/placement.hpp"

#include <gtest/gtest.h>

#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

constexpr Sensor kSensor{64, 20.0};
constexpr double kDepth_m = 15.0;
// At the target; a block of the search is four of them.
const double kRay_m = 2.0 * kDepth_m * kSensor.tan_half_fov() / kSensor.rays;

class Placement : public testing::Test {
 protected:
  Placement() { truth_.origin_m = {0.4, kDepth_m, -0.3}; }

  // The target at its true attitude, and where it is put from `guess_m` for its origin.
  Eigen::Vector3d placed_m(const Eigen::Vector3d& guess_m) {
    const auto view = view_of(frame_, kDepth_m, body_.radius_m, {30, 0});
    Pose pose = fixed({truth_.r_lrf_trf, guess_m});
    place(MeshSection(body_).mesh(), *view, surface_, *scratch_, pose, surface_.budget);
    EXPECT_TRUE(pose.r_lrf_trf == fixed(truth_).r_lrf_trf);
    return exact(pose).origin_m;
  }
  void see(double first_column = 0.0) {
    frame_ = Frame(kSensor);
    const auto depths_m = cast(body_, truth_, kSensor);
    for (int row = 0; row < kSensor.rays; ++row)
      for (int column = static_cast<int>(first_column); column < kSensor.rays; ++column) {
        const double depth_m = depths_m[static_cast<std::size_t>(row * kSensor.rays + column)];
        if (depth_m != kNothing) frame_.add(row, column, depth_m * ray(kSensor, row, column).norm());
      }
  }
  // The middle of the returns, which the flight code starts from.
  Eigen::Vector3d middle_m() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (int row = 0; row < kSensor.rays; ++row)
      for (int column = 0; column < kSensor.rays; ++column) {
        if (!frame_.mask->has(row, column)) continue;
        sum += ray(kSensor, row, column) * kDepth_m;
        ++count;
      }
    return sum / count;
  }
  void expect_near_truth(const Eigen::Vector3d& found_m, double rays, double along_m) {
    const Eigen::Vector3d off_m = found_m - truth_.origin_m;
    EXPECT_LT(std::hypot(off_m.x(), off_m.z()), rays * kRay_m) << off_m.transpose();
    EXPECT_LT(std::abs(off_m.y()), along_m) << off_m.transpose();
  }

  Body body_ = lopsided_body();
  ExactPose truth_;
  Frame frame_{kSensor};
  Rendering surface_;
  std::unique_ptr<PlacementScratch> scratch_ = std::make_unique<PlacementScratch>();
};

TEST_F(Placement, PutsTheMiddleOfAWholeTargetOnThatOfItsReturns) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    truth_.r_lrf_trf = random.rotation();
    see();
    expect_near_truth(placed_m(middle_m()), 2.0, 0.1);
  }
}

// A bus between two panels, the left one of which is dark: the middles are off by half of its distance.
TEST_F(Placement, FindsATargetOfWhichAPartSendsNothingBack) {
  body_ = Body();
  body_.radius_m = 1.5;
  body_.add_box({-0.3, -0.2, -0.35}, {0.3, 0.2, 0.35});
  body_.add_plate(-1.3, -0.5, -0.25, 0.25, 0.0);
  body_.add_plate(0.5, 1.3, -0.25, 0.25, 0.0);
  const double left_end = on_screen(kSensor, truth_.origin_m - Eigen::Vector3d(0.4, 0.0, 0.0)).x();
  see(left_end);
  const Eigen::Vector3d start_m = middle_m();
  EXPECT_GT((start_m - truth_.origin_m).norm(), 4.0 * kRay_m) << "the middle is no place for it";
  expect_near_truth(placed_m(start_m), 2.5, 0.1);
}

// A plate of five by four rays in front of the target's far end.
TEST_F(Placement, IsNotDrawnAsideByAnotherBody) {
  truth_.r_lrf_trf = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  see();
  const Eigen::Vector3d whole_m = placed_m(middle_m());
  for (int row = 4; row < 20; ++row)
    for (int column = 2; column < 16; ++column) frame_.add(row, column, kDepth_m);
  const Eigen::Vector3d start_m = middle_m();
  EXPECT_GT((start_m - truth_.origin_m).head<1>().norm(), 4.0 * kRay_m)
      << "the other body draws the middle aside";
  const Eigen::Vector3d found_m = placed_m(start_m);
  EXPECT_LT(std::hypot(found_m.x() - whole_m.x(), found_m.z() - whole_m.z()), 4.0 * kRay_m)
      << found_m.transpose();
}

TEST_F(Placement, LeavesAPlaceWithoutReturnsOrOutOfViewAsItIs) {
  frame_.hide(0, 0, 5.0);
  const Eigen::Vector3d guess_m(0.5, kDepth_m, 0.25);
  EXPECT_LT((placed_m(guess_m) - guess_m).norm(), 1e-5);
  see();
  const Eigen::Vector3d aside_m(12.0, kDepth_m, 0.0);
  EXPECT_LT((placed_m(aside_m) - aside_m).norm(), 1e-5);
}

}  // namespace
}  // namespace tumblesight::gnc
