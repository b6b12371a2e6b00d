#include "gnc/registration/work_budget.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "tests/support/expensive_mesh.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

TEST(WorkBudget, IsExhaustedWhenMoreIsWantedThanIsLeft) {
  WorkBudget budget;
  budget.begin(100);
  EXPECT_TRUE(budget.spend(60));
  EXPECT_EQ(budget.left(), 40);
  EXPECT_TRUE(budget.spend(40));
  EXPECT_TRUE(budget.spend(0));
  EXPECT_FALSE(budget.is_exhausted());
  EXPECT_FALSE(budget.spend(1));
  EXPECT_TRUE(budget.is_exhausted());
  EXPECT_FALSE(budget.spend(0)) << "and stays so";
  EXPECT_FALSE(budget.spend(0x7FFF'FFFF));
  EXPECT_EQ(budget.left(), 0);
  budget.give_back(50);
  EXPECT_TRUE(budget.is_exhausted()) << "whatever is given back";
  budget.begin(100);
  EXPECT_FALSE(budget.is_exhausted());
}

TEST(WorkBudget, WhatIsGivenBackCanBeSpent) {
  WorkBudget budget;
  budget.begin(100);
  EXPECT_TRUE(budget.spend(90));
  budget.give_back(30);
  EXPECT_EQ(budget.left(), 40);
  EXPECT_TRUE(budget.spend(40));
  EXPECT_FALSE(budget.spend(1));
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
  }
}

// What a track knows.
struct Known {
  explicit Known(const PoseTrackerState& state)
      : llr_q8(state.llr_q8),
        conservative_llr_q8(state.conservative_llr_q8),
        origin_um(state.motion.origin_lrf_um) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.history.count); ++i)
      ages_ns.push_back(state.history.poses[i].age_ns);
  }
  bool operator==(const Known& other) const {
    return llr_q8 == other.llr_q8 && conservative_llr_q8 == other.conservative_llr_q8 &&
           origin_um == other.origin_um && ages_ns == other.ages_ns;
  }
  std::int32_t llr_q8, conservative_llr_q8;
  std::array<std::int32_t, 3> origin_um;
  std::vector<std::int64_t> ages_ns;
};

// One frame, again and again with another budget. `begun`: how many frames the track has had before.
class EveryBudget : public WorkOfAFrame, public testing::WithParamInterface<int> {
 protected:
  void begin_track(int frames) {
    lost_ = 0.2;
    for (int i = 0; i < frames; ++i) track_next();
    see();
    if (frames % 2 != 0) lose_right_of(60);
    second_ = rotation_of({0.3, -0.4, 0.2}) * truth_.r_lrf_trf;
    begun_ = *state_;
  }
  // With a network that disagrees with the track.
  PoseEstimate track_with(std::int32_t budget, int left_in_scratch = 0xA5) {
    *state_ = begun_;
    budget_ = budget;
    left_in_scratch_ = left_in_scratch;
    return track({0.5, 0.2, 0.0}, second_, 900'000);
  }
  // That is not exhausted. More than the work of the frame: what is held back is given back late.
  std::int32_t least_budget() {
    std::int32_t too_little = 0, enough = WorkBudget::kOfAFrame;
    while (enough - too_little > 1) {
      const std::int32_t middle = too_little + (enough - too_little) / 2;
      track_with(middle);
      (scratch_->refinement.budget.is_exhausted() ? too_little : enough) = middle;
    }
    return enough;
  }
  PoseTrackerState begun_;
  Eigen::Matrix3d second_;
};

TEST_P(EveryBudget, GivesAWholeFrameOrNone) {
  begin_track(GetParam());
  const PoseEstimate whole = track_with(WorkBudget::kOfAFrame);
  ASSERT_FALSE(scratch_->refinement.budget.is_exhausted());
  const Known with_frame(*state_);
  const PoseEstimate none = track_with(0);
  const Known without_frame(*state_);
  EXPECT_EQ(without_frame.ages_ns.size(), static_cast<std::size_t>(begun_.history.count));
  EXPECT_EQ(without_frame.llr_q8, begun_.llr_q8);
  EXPECT_EQ(none.doubts & kPoseAmbiguous, kPoseAmbiguous);
  EXPECT_NE(none.doubts & (kPoseCoasts | kPoseUnknown), 0U);
  const std::int32_t work = least_budget();
  EXPECT_EQ(track_with(work).doubts, whole.doubts);
  EXPECT_EQ(Known(*state_), with_frame);
  for (std::int32_t budget = work - 1; budget > 0; budget -= work / 60) {
    const PoseEstimate estimate = track_with(budget);
    EXPECT_TRUE(scratch_->refinement.budget.is_exhausted()) << budget;
    EXPECT_EQ(estimate.doubts & kPoseAmbiguous, kPoseAmbiguous) << budget;
    const Known known(*state_);
    // At the end only fits of the motion are left out.
    const bool is_measured = (estimate.doubts & (kPoseCoasts | kPoseUnknown)) == 0;
    if (is_measured) {
      EXPECT_EQ(known.llr_q8, with_frame.llr_q8) << budget;
      EXPECT_EQ(estimate.evidence.cost_q8(), whole.evidence.cost_q8()) << budget;
    } else {
      EXPECT_EQ(known, without_frame) << budget;
    }
    // Nothing depends on what other stages left in the memory.
    const PoseEstimate again = track_with(budget, 0x3C);
    EXPECT_EQ(again.doubts, estimate.doubts) << budget;
    EXPECT_EQ(again.state.origin_lrf_um, estimate.state.origin_lrf_um) << budget;
    EXPECT_EQ(Known(*state_), known) << budget;
  }
}
INSTANTIATE_TEST_SUITE_P(AfterFrames, EveryBudget, testing::Values(0, 1, 2, 3, 5, 8, 11));

// A track outlives frames that exhaust the budget, and what was proven does not grow by them.
TEST_F(WorkOfAFrame, ATrackCoastsOverExhaustedFrames) {
  track_frames(6);
  const Known before(*state_);
  ASSERT_GT(before.ages_ns.size(), 3U);
  budget_ = 5'000'000;
  for (int i = 0; i < 4; ++i) {
    see();
    const PoseEstimate estimate = track({0.5, 0.2, 0.0}, truth_.r_lrf_trf, 900'000);
    EXPECT_EQ(estimate.doubts & (kPoseCoasts | kPoseAmbiguous), kPoseCoasts | kPoseAmbiguous);
    EXPECT_EQ(state_->llr_q8, before.llr_q8);
    EXPECT_EQ(state_->conservative_llr_q8, before.conservative_llr_q8);
    EXPECT_EQ(static_cast<std::size_t>(state_->history.count), before.ages_ns.size());
  }
  budget_ = WorkBudget::kOfAFrame;
  EXPECT_EQ(track_next().doubts & kPoseCoasts, 0U);
}

// A frame that has taken much before an alternative is compared compares it in fewer steps. Surfaces that
// take more and more work show where this begins: there the work falls, before it exceeds the budget.
TEST_F(WorkOfAFrame, LongFramesCompareAnAlternativeShortly) {
  budget_ = 0x7FFF'FFFF;
  std::int32_t before = 0, work = 0;
  for (int half_side = 4'250; work >= before - before / 20; half_side += 250) {
    before = work;
    ExpensiveMesh mesh;
    mesh.half_side = half_side;
    take_expensive(mesh);
    *state_ = {};
    truth_.r_lrf_trf = Eigen::Matrix3d::Identity();
    rate_.setZero();
    track_frames(3);
    noise_ = 3.0;  // so that nothing explains the frame
    see();
    noise_ = 1.0;
    track({0.1, 0.0, 0.0}, rotation_of({0.0, 0.0, 1.0}), 900'000);
    work = budget_ - scratch_->refinement.budget.left();
    ASSERT_LT(work, WorkBudget::kOfAFrame) << half_side;
  }
  EXPECT_GT(before, WorkBudget::kOfAFrame * 3 / 4);
}

}  // namespace
}  // namespace tumblesight::gnc
