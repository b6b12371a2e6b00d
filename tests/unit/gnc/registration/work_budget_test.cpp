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

TEST(WorkBudget, APartThatExhaustsItLeavesNothingForOthers) {
  WorkBudget budget;
  budget.begin(100);
  EXPECT_TRUE(budget.covers(100));
  EXPECT_FALSE(budget.covers(101));
  EXPECT_TRUE(budget.spend(60));
  EXPECT_TRUE(budget.end_part());
  EXPECT_EQ(budget.left(), 40);
  EXPECT_FALSE(budget.spend(41));
  EXPECT_FALSE(budget.covers(0));
  EXPECT_FALSE(budget.end_part());
  EXPECT_FALSE(budget.is_exhausted()) << "the frame goes on";
  EXPECT_EQ(budget.left(), 0);
  EXPECT_TRUE(budget.covers(0));
  EXPECT_FALSE(budget.covers(1));
}

// Passes at a look: 0 is the first one. `looks`: how many there were.
class DeadlineAtALook final : public Deadline {
 public:
  explicit DeadlineAtALook(int look) : look_(look) {}
  bool has_passed() override { return looks++ >= look_; }
  int looks = 0;

 private:
  int look_;
};

TEST(WorkBudget, LooksAtItsDeadlineWhenItBeginsToSpendAndThenRegularly) {
  DeadlineAtALook deadline(4);
  WorkBudget budget;
  budget.begin(WorkBudget::kOfAFrame, &deadline);
  EXPECT_EQ(deadline.looks, 0);
  EXPECT_TRUE(budget.spend(1));
  EXPECT_EQ(deadline.looks, 1);
  EXPECT_TRUE(budget.spend(WorkBudget::kBetweenLooks - 1));
  EXPECT_EQ(deadline.looks, 1);
  EXPECT_TRUE(budget.spend(1));
  EXPECT_EQ(deadline.looks, 2);
  EXPECT_TRUE(budget.spend(5 * WorkBudget::kBetweenLooks));
  EXPECT_EQ(deadline.looks, 3) << "once per charge";
  EXPECT_TRUE(budget.spend(WorkBudget::kBetweenLooks));
  EXPECT_FALSE(budget.is_late());
  EXPECT_FALSE(budget.spend(WorkBudget::kBetweenLooks));
  EXPECT_TRUE(budget.is_late());
  EXPECT_TRUE(budget.is_exhausted());
}

TEST(WorkBudget, NothingIsLeftAfterItsDeadline) {
  DeadlineAtALook deadline(0);
  WorkBudget budget;
  budget.begin(100, &deadline);
  EXPECT_FALSE(budget.spend(1));
  EXPECT_EQ(budget.left(), 0);
  budget.give_back(50);
  EXPECT_TRUE(budget.is_exhausted());
  EXPECT_FALSE(budget.end_part());
  budget.give_back(50);
  EXPECT_EQ(budget.left(), 0) << "for other parts of the frame either";
  EXPECT_FALSE(budget.spend(1));
  EXPECT_TRUE(budget.is_late());
  EXPECT_EQ(deadline.looks, 1) << "time does not run back";
  budget.begin(100);
  EXPECT_FALSE(budget.is_late());
  EXPECT_TRUE(budget.spend(100));
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
  EXPECT_GT(most, WorkBudget::kOfAFrame * 9 / 10);
  EXPECT_LE(most, WorkBudget::kOfAFrame);
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
        origin_um(state.motion.origin_lrf_um),
        numbers{state.motion_model, state.owes_comparison} {
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.history.count); ++i)
      ages_ns.push_back(state.history.poses[i].age_ns);
  }
  bool operator==(const Known& other) const {
    return llr_q8 == other.llr_q8 && conservative_llr_q8 == other.conservative_llr_q8 &&
           origin_um == other.origin_um && numbers == other.numbers && ages_ns == other.ages_ns;
  }
  std::int32_t llr_q8, conservative_llr_q8;
  std::array<std::int32_t, 3> origin_um;
  std::array<int, 2> numbers;
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
  PoseTrackerState begun_;
  Eigen::Matrix3d second_;
};

// Whatever the budget, the frame gives a pose of its own or leaves the track as it was. One that was not
// compared is ambiguous. From some budget on nothing is left out any more.
TEST_P(EveryBudget, GivesAPoseOrLeavesTheTrackAlone) {
  begin_track(GetParam());
  const PoseEstimate whole = track_with(0x7FFF'FFFF);
  const std::int32_t work = 0x7FFF'FFFF - scratch_->refinement.budget.left();
  const Known with_frame(*state_);
  track_with(0);
  const Known without_frame(*state_);
  EXPECT_EQ(without_frame.ages_ns.size(), static_cast<std::size_t>(begun_.history.count));
  EXPECT_EQ(without_frame.llr_q8, begun_.llr_q8);
  int poses = 0, none = 0;
  for (std::int32_t budget = 2 * work; budget >= 0; budget -= std::max(1, work / 60)) {
    const PoseEstimate estimate = track_with(budget);
    const bool is_exhausted = scratch_->refinement.budget.is_exhausted();
    const bool is_measured = (estimate.doubts & (kPoseCoasts | kPoseUnknown)) == 0;
    EXPECT_EQ(is_measured, !is_exhausted) << budget;
    const Known known(*state_);
    if (is_exhausted) {
      ++none;
      EXPECT_EQ(estimate.doubts & kPoseAmbiguous, kPoseAmbiguous) << budget;
      EXPECT_EQ(known, without_frame) << budget;
    } else {
      ++poses;
      constexpr int kWithoutAlternative_q8 = 4 * 256;
      EXPECT_LE(known.llr_q8, std::max(with_frame.llr_q8, begun_.llr_q8 + kWithoutAlternative_q8)) << budget;
      EXPECT_LE(known.conservative_llr_q8,
                std::max(with_frame.conservative_llr_q8, begun_.conservative_llr_q8 + kWithoutAlternative_q8))
          << budget;
    }
    if (scratch_->is_uncompared) {
      EXPECT_EQ(estimate.doubts & kPoseAmbiguous, kPoseAmbiguous) << budget;
    }
    // Nothing depends on what other stages left in the memory.
    const PoseEstimate again = track_with(budget, 0x3C);
    EXPECT_EQ(again.doubts, estimate.doubts) << budget;
    EXPECT_EQ(again.state.origin_lrf_um, estimate.state.origin_lrf_um) << budget;
    EXPECT_EQ(Known(*state_), known) << budget;
  }
  EXPECT_GT(poses, 10);
  EXPECT_GT(none, 5);
  EXPECT_EQ(track_with(2 * work).doubts, whole.doubts);
  EXPECT_EQ(Known(*state_), with_frame);
}
INSTANTIATE_TEST_SUITE_P(AfterFrames, EveryBudget, testing::Values(0, 1, 2, 3, 5, 8, 11));

// Whenever the deadline passes, the frame gives a pose of its own or leaves the track as it was.
TEST_P(EveryBudget, GivesAPoseOrLeavesTheTrackAloneWheneverTheDeadlinePasses) {
  begin_track(GetParam());
  budget_ = WorkBudget::kOfAFrame;
  const auto track_until = [&](int look) {
    *state_ = begun_;
    DeadlineAtALook deadline(look);
    deadline_ = &deadline;
    const PoseEstimate estimate = track({0.5, 0.2, 0.0}, second_, 900'000);
    deadline_ = nullptr;
    EXPECT_EQ(estimate.is_cut_short, deadline.looks > look) << look;
    return std::pair(estimate, deadline.looks);
  };
  const auto [whole, looks] = track_until(1'000'000);
  const Known with_frame(*state_);
  ASSERT_GT(looks, 5);
  track_until(0);
  const Known without_frame(*state_);
  EXPECT_EQ(without_frame.llr_q8, begun_.llr_q8);
  EXPECT_EQ(without_frame.ages_ns.size(), static_cast<std::size_t>(begun_.history.count));
  int poses = 0, none = 0;
  for (int look = 0; look < looks; ++look) {
    const PoseEstimate estimate = track_until(look).first;
    EXPECT_TRUE(estimate.is_cut_short) << look;
    const bool is_measured = (estimate.doubts & (kPoseCoasts | kPoseUnknown)) == 0;
    ++(is_measured ? poses : none);
    if (is_measured) continue;
    EXPECT_EQ(estimate.doubts & kPoseAmbiguous, kPoseAmbiguous) << look;
    EXPECT_EQ(Known(*state_), without_frame) << look;
  }
  EXPECT_GT(poses, 0);
  EXPECT_GT(none, 3);
  const PoseEstimate again = track_until(looks).first;
  EXPECT_FALSE(again.is_cut_short);
  EXPECT_EQ(again.doubts, whole.doubts);
  EXPECT_EQ(Known(*state_), with_frame);
}

// What is still done after the deadline, with the most expensive images and after long coasts: at most what
// lies between two looks and one charge, of which that of a fit over sixteen periods is the largest.
TEST_F(WorkOfAFrame, LooksAtTheDeadlineOftenEnough) {
  class LargestGap final : public Deadline {
   public:
    explicit LargestGap(const WorkBudget& budget) : budget_(budget) {}
    bool has_passed() override {
      if (last_left_ >= 0) largest = std::max(largest, last_left_ - budget_.left());
      last_left_ = budget_.left();
      return false;
    }
    std::int32_t largest = 0;

   private:
    const WorkBudget& budget_;
    std::int32_t last_left_ = -1;
  };
  std::int32_t largest = 0;
  for (const int reach : {1, 3, 20}) {
    ExpensiveMesh mesh;
    mesh.reach = reach;
    take_expensive(mesh);
    *state_ = {};
    truth_.r_lrf_trf = rotation_of(random_.vector(0.3));
    for (int frame = 0; frame < 4; ++frame) {
      see();
      lose_right_of(frame % 2 == 0 ? 64 : sensor_.rays);
      LargestGap gap(scratch_->refinement.budget);
      deadline_ = &gap;
      track_hard();
      deadline_ = nullptr;
      largest = std::max(largest, gap.largest);
      period_ns_ = kNominalPeriod_ns * (frame == 1 ? 15 : 1);
    }
  }
  EXPECT_GT(largest, 2 * WorkBudget::kBetweenLooks);
  EXPECT_LE(largest, WorkBudget::kBetweenLooks + 4'000'000);
  RecordProperty("largest_work_between_looks", largest);
}

// A track outlives frames that exhaust the budget, and what was proven does not grow by them.
TEST_F(WorkOfAFrame, ATrackCoastsOverExhaustedFrames) {
  track_frames(6);
  const Known before(*state_);
  ASSERT_GT(before.ages_ns.size(), 3U);
  budget_ = 8'000'000;
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

// Where the budget does not cover both, a frame that contradicts its track is searched at the network's
// attitude, and compared with another one in the next frame. A frame that is not compared proves nothing.
TEST_F(WorkOfAFrame, SearchAndComparisonTakeTurns) {
  track_frames(4);
  state_->llr_q8 = state_->conservative_llr_q8 = 20 * 256;
  const PoseTrackerState begun = *state_;
  noise_ = 3.0;  // so that nothing explains the frame
  see();
  const Eigen::Matrix3d second = rotation_of({0.0, 0.0, 1.0}) * truth_.r_lrf_trf;
  const auto track_with = [&](std::int32_t budget, bool owes) {
    *state_ = begun;
    state_->owes_comparison = owes ? 1 : 0;
    budget_ = budget;
    track({0.1, 0.0, 0.0}, second, 900'000);
    return budget - scratch_->refinement.budget.left();
  };
  const std::int32_t both = track_with(0x7FFF'FFFF, false);
  EXPECT_EQ(state_->owes_comparison, 0);
  const std::int32_t llr_of_both_q8 = state_->llr_q8;
  EXPECT_NE(llr_of_both_q8, begun.llr_q8);

  // The largest budget that does not cover both. The fit of the motion is held back until the end.
  std::int32_t one = 2 * both;
  while (one > 0 && state_->owes_comparison == 0) track_with(one -= both / 100, false);
  ASSERT_GT(one, both / 2);
  track_with(one, false);
  EXPECT_EQ(state_->owes_comparison, 1);
  EXPECT_TRUE(scratch_->is_uncompared);
  EXPECT_EQ(state_->llr_q8, begun.llr_q8);
  EXPECT_LE(state_->conservative_llr_q8, begun.conservative_llr_q8);

  track_with(one, true);
  EXPECT_EQ(state_->owes_comparison, 0);
  EXPECT_FALSE(scratch_->is_uncompared);
  EXPECT_NE(state_->llr_q8, begun.llr_q8);

  track_with(0x7FFF'FFFF, true);
  EXPECT_EQ(state_->llr_q8, llr_of_both_q8) << "a budget that covers both needs no turns";

  // A comparison that is never covered does not keep the search from its turn.
  std::int32_t searched = 0;
  for (std::int32_t budget = both; budget > 0; budget -= both / 50) {
    track_with(budget, true);
    if (scratch_->refinement.budget.is_exhausted() || !scratch_->is_uncompared) continue;
    EXPECT_EQ(state_->owes_comparison, 0) << budget;
    ++searched;
  }
  EXPECT_GT(searched, 0);
}

// A track whose alternative is never compared is never verified, whatever it has proven.
TEST_F(WorkOfAFrame, ATrackThatIsNotComparedIsNotVerified) {
  track_frames(6);
  state_->llr_q8 = state_->conservative_llr_q8 = 32 * 256;
  const auto track_with = [&](std::int32_t budget) {
    budget_ = budget;
    see();
    return track({0.0, 0.01, 0.0}, rotation_of({0.0, 0.0, 1.0}) * truth_.r_lrf_trf, 900'000);
  };
  ASSERT_TRUE(track_with(0x7FFF'FFFF).is_verified());
  // The least that covers the frame without its comparison.
  const PoseTrackerState begun = *state_;
  const ExactPose pose = truth_;
  std::int32_t budget = 4'000'000;
  for (bool is_covered = false; !is_covered; budget += 500'000) {
    *state_ = begun;
    truth_ = pose;
    is_covered = (track_with(budget).doubts & kPoseCoasts) == 0;
  }
  for (int frame = 0; frame < 6; ++frame) {
    const PoseEstimate estimate = track_with(budget);
    EXPECT_TRUE(scratch_->is_uncompared) << frame;
    EXPECT_EQ(estimate.doubts & kPoseAmbiguous, kPoseAmbiguous) << frame;
  }
}

}  // namespace
}  // namespace tumblesight::gnc
