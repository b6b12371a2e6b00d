#include "gnc/registration/work_budget.hpp"

#include <algorithm>

#include "tests/support/expensive_mesh.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

TEST(WorkBudget, IsExhaustedWhenMoreIsSpentThanItHad) {
  WorkBudget budget;
  budget.begin(100);
  EXPECT_TRUE(budget.spend(60));
  EXPECT_EQ(budget.left(), 40);
  EXPECT_TRUE(budget.spend(40));
  EXPECT_FALSE(budget.is_exhausted());
  EXPECT_FALSE(budget.spend(5));
  EXPECT_TRUE(budget.is_exhausted());
  EXPECT_FALSE(budget.spend(0));
  EXPECT_FALSE(budget.spend(WorkBudget::kMostBeyond)) << "and stays so";
  EXPECT_EQ(budget.left(), -5);
  budget.begin(100);
  EXPECT_FALSE(budget.is_exhausted());
}

class WorkOfAFrame : public TrackPose {
 protected:
  WorkOfAFrame() { rate_ = {0.0, 0.02, 0.01}; }
  void take_expensive(const ExpensiveMesh& mesh) {
    Body sheet;
    sheet.radius_m = 3.0;
    const double half_m = 3.0 * mesh.half_side / SurfaceMesh::kRadius;
    sheet.add_plate(-half_m, half_m, -half_m, half_m, 0.0);
    take(sheet);
    section_.bytes().assign(SurfaceMesh::kMaxBytes, 0);
    make_expensive_mesh(mesh, section_.bytes().data());
    ASSERT_TRUE(SurfaceMesh::is_sound(section_.bytes().data(), section_.bytes().size()));
  }
  // Right of a column nothing returns, so that surfaces are dark.
  void lose_right_of(int first) {
    for (int row = 0; row < sensor_.rays; ++row) {
      for (int column = first; column < sensor_.rays; ++column) {
        frame_->image->ranges[static_cast<std::size_t>(row * sensor_.rays + column)] = 0;
        frame_->mask->rows[static_cast<std::size_t>(row)]
                          [static_cast<std::size_t>(column / RayMask::kColumnsPerWord)] &=
            ~(0x8000'0000U >> (column % RayMask::kColumnsPerWord));
      }
    }
  }
  // A frame with a network that is off and offers a second attitude. Returns the work.
  std::int32_t track_hard() {
    const PoseEstimate estimate =
        track(random_.vector(0.1), rotation_of(random_.vector(1.0)) * truth_.r_lrf_trf, 900'000);
    const WorkBudget& budget = scratch_->refinement.budget;
    EXPECT_GE(budget.left(), -WorkBudget::kMostBeyond);
    if (budget.is_exhausted()) {
      ++exhausted_;
      EXPECT_FALSE(estimate.is_verified());
    }
    return WorkBudget::kOfAFrame - budget.left();
  }

  int exhausted_ = 0;
};

// Verifies TS-TIM-120.
// A random search among images at the limits of the format and frames of them.
TEST_F(WorkOfAFrame, NoImageAndFrameTakeMoreThanTheBudget) {
  std::int32_t most = 0;
  for (int i = 0; i < trials(12); ++i) {
    ExpensiveMesh mesh;
    mesh.reach = 1 + random_.below(random_.happens(0.5) ? 6 : 40);
    mesh.half_side = 8'000 + random_.below(15'000);
    mesh.shows_both_sides = random_.happens(0.3);
    take_expensive(mesh);
    *state_ = {};
    truth_.r_lrf_trf = rotation_of(random_.vector(0.3));
    lost_ = random_.uniform(0.0, 0.5);
    const int lost_from = random_.happens(0.7) ? 40 + random_.below(60) : sensor_.rays;
    for (int frame = 0; frame < 4; ++frame) {
      see();
      lose_right_of(lost_from);
      most = std::max(most, track_hard());
    }
  }
  EXPECT_GT(exhausted_, 0);
  EXPECT_GT(most, WorkBudget::kOfAFrame / 2);
  RecordProperty("most_work", most);
}

TEST_F(WorkOfAFrame, ABodyOfAFewTrianglesExhaustsNothing) {
  for (int frame = 0; frame < 6; ++frame) {
    see();
    const std::int32_t work = track_hard();
    EXPECT_GT(work, 0) << frame;
    EXPECT_LT(work, WorkBudget::kOfAFrame / 2) << frame;
  }
  EXPECT_EQ(exhausted_, 0);
}

// The same frames give the same work.
TEST_F(WorkOfAFrame, IsTheSameForTheSameFrame) {
  see();
  const Eigen::Matrix3d second = rotation_of({0.0, 0.0, 1.0}) * truth_.r_lrf_trf;
  track({0.0, 0.02, 0.0}, second, 500'000);
  const std::int32_t left = scratch_->refinement.budget.left();
  *state_ = {};
  track({0.0, 0.02, 0.0}, second, 500'000);
  EXPECT_EQ(scratch_->refinement.budget.left(), left);
}

// A budget that is enough does not change the result; any smaller one gives no pose.
TEST_F(WorkOfAFrame, EndsARefinementThatItDoesNotCover) {
  see();
  const auto view = view_of(*frame_, kDepth_m, body_.radius_m);
  RefinementScratch& scratch = scratch_->refinement;
  scratch.surface.vertices = vertices_.get();
  const auto refined = [&](std::int32_t budget) {
    Refinement result;
    scratch.budget.begin(budget);
    refine(section_.mesh(), *view, fixed(truth_), {}, scratch, result);
    return result;
  };
  const Refinement whole = refined(0x7FFF'FFFF);
  const std::int32_t work = 0x7FFF'FFFF - scratch.budget.left();
  ASSERT_TRUE(whole.is_complete);
  const Refinement enough = refined(work);
  EXPECT_TRUE(enough.is_complete);
  EXPECT_TRUE(enough.pose.r_lrf_trf == whole.pose.r_lrf_trf);
  EXPECT_EQ(enough.pose.origin_lrf_um, whole.pose.origin_lrf_um);
  for (std::int32_t budget = work - 1; budget >= 0; budget -= work / 50) {
    EXPECT_FALSE(refined(budget).is_complete) << budget;
    EXPECT_TRUE(scratch.budget.is_exhausted()) << budget;
    EXPECT_GE(scratch.budget.left(), -WorkBudget::kMostBeyond) << budget;
  }
}

// The frame says nothing of the pose then: what was known goes on, with a doubt.
TEST_F(WorkOfAFrame, LeavesATrackAsItWas) {
  for (int frame = 0; frame < 6; ++frame) {
    see();
    track_hard();
  }
  const std::int32_t proven_q8 = state_->proven_q8;
  const int poses = state_->history.count;
  ASSERT_GT(poses, 2);
  take_expensive({30, 19'000, false});
  see();
  const PoseEstimate estimate =
      track({0.0, 0.02, 0.0}, rotation_of({0.0, 0.0, 1.0}) * truth_.r_lrf_trf, 900'000);
  ASSERT_TRUE(scratch_->refinement.budget.is_exhausted());
  EXPECT_NE(estimate.doubts & kPoseCoasts, 0U);
  EXPECT_NE(estimate.doubts & kPoseAmbiguous, 0U);
  EXPECT_FALSE(estimate.is_verified());
  EXPECT_EQ(state_->history.count, poses);
  EXPECT_LE(state_->proven_q8, proven_q8);
}

}  // namespace
}  // namespace tumblesight::gnc
