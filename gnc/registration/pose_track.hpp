// A track of poses: what each frame brings, what is kept from frame to frame, and the working memory. Its
// poses are chosen by pose_choice.hpp, and it is advanced by pose_tracker.hpp.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/registration/placement.hpp"
#include "gnc/registration/pose_evidence.hpp"
#include "gnc/registration/pose_fit.hpp"
#include "gnc/registration/refinement.hpp"

namespace tumblesight::gnc {

// What is the same for all frames.
struct PoseTarget {
  SurfaceMesh mesh;
  std::uint32_t radius_mm;
  RangeNoise noise;
};
// One frame, and what the network says of it.
struct PoseFrame {
  const RangeImage& image;
  const RayMask& mask;              // its returns of the target
  std::int64_t elapsed_ns;          // since the last frame of the track
  Matrix3<Fixed> r_now_last;        // turn of the LRF since then: v_lrf now = r_now_last v_lrf last
  Motion<Fixed> network;            // its attitude and rate
  Matrix3<Fixed> second_r_lrf_trf;  // its second attitude
  std::uint32_t second_odds_ppm;    // against the first; 0: there is none
  std::array<std::int32_t, 3> centroid_lrf_mm;  // of the returns
  const MotionModels<Fixed>& motion_models;
  int network_motion_model;  // that the network's track follows
};

struct PoseTrackerState {
  PoseHistory history;
  PoseMotion motion;              // at the last frame; valid if there is a pose
  int motion_model = kSpinModel;  // under which the poses agree best, so far
  int challenger = kTumbleModel;  // the motion model that is compared with it next
  // 1: the budget of the last frame did not cover the comparison with another attitude. In the next one it
  // goes first.
  int owes_comparison = 0;
  // Log-likelihood ratio of the attitude that it follows to the others, and as much of it as is proven; never
  // more [nats].
  std::int32_t llr_q8 = 0, conservative_llr_q8 = 0;
};

// A pose with what speaks for it.
struct PoseCandidate {
  Refinement refinement;
  PoseEvidence evidence;
};
// Working memory. The caller holds it, so that nothing large is on the stack; it need not be initialized.
// The vertices of the drawn surface lie apart.
struct PoseScratch {
  FrameView view;
  RefinementScratch refinement;
  PlacementScratch placement;
  PoseCandidate best, other;
  bool is_uncompared;      // the frame's comparison with another attitude was not covered
  WorkBudget fit_reserve;  // held back for the one fit that every frame makes
  PoseFitResult fit, other_fit;
};

}  // namespace tumblesight::gnc
