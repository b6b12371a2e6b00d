#include "gnc/registration/pose_tracker.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/pose_choice.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kTrackedPoses = 2;         // from so many on the motion predicts the next pose
constexpr int kPosesOfAMotionModel = 3;  // from so many on they tell motion models apart
constexpr int kPosesOfALongTrack = 7;  // from so many on the predicted motion is a very good start of the fit
constexpr std::int64_t kDisagreement_q8 = 90;  // from here on another motion model is tried

// Limits of the verdict.
constexpr int kVerifiedPoses = 3;
constexpr std::int64_t kLongestToTellRate_ns = 7'500'000'000;  // between poses; as of the network's track
constexpr std::int32_t kLeastLlr_q8 = 8 * 256;                 // of the track, conservative
constexpr std::int32_t kMostAgainstTrack_q8 = 6 * 256;         // in a frame
constexpr std::int64_t kMostDisagreement_q8 = 3 * 256;
constexpr std::uint32_t kLargestSigma_urad = 17'453;  // a degree

// A pose whose silhouette is not where the frame shows one is known less well.
void discount(const PoseEvidence& evidence, PoseMeasurement& measurement) {
  if (evidence.fits_silhouette()) return;
  const int shift = evidence.fits_silhouette(3) ? 4 : 8;
  for (std::int32_t& element : measurement.information) element >>= shift;
}

// Whether the poses tell the rate: farther apart, the target may have made a turn more or less between them.
bool tells_rate(const PoseHistory& history) {
  for (std::size_t i = 1; i < static_cast<std::size_t>(history.count); ++i)
    if (history.poses[i - 1].age_ns - history.poses[i].age_ns <= kLongestToTellRate_ns) return true;
  return false;
}

PoseDoubts doubts_of(const PoseFrame& frame, const Matrix3<Fixed>& r_lrf_trf, const PoseEstimate& estimate) {
  const PoseEvidence& evidence = estimate.evidence;
  PoseDoubts doubts = 0;
  if (!evidence.fits_ranges()) doubts |= kPoseRanges;
  if (!evidence.fits_returns() || !evidence.fits_silhouette()) doubts |= kPoseOutline;
  if (estimate.conservative_llr_q8 < kLeastLlr_q8) doubts |= kPoseAmbiguous;
  if (estimate.poses < kVerifiedPoses || estimate.disagreement_q8 > kMostDisagreement_q8)
    doubts |= kPoseMotion;
  for (std::size_t i = 0; i < 3; ++i)
    if (estimate.covariance.sigma[i] > kLargestSigma_urad) doubts |= kPoseUncertain;
  if (is_another_attitude(r_lrf_trf, frame.network.r_lrf_trf)) doubts |= kPoseNetwork;
  return doubts;
}

// The motion at which the fit begins.
PoseMotion start_of_fit(const PoseFrame& frame, const PoseMotion& predicted, const Pose& pose,
                        bool is_tracked) {
  PoseMotion start;
  start.turning.r_lrf_trf = pose.r_lrf_trf;
  start.turning.rate_lrf = is_tracked ? predicted.turning.rate_lrf : frame.network.rate_lrf;
  start.origin_lrf_um = pose.origin_lrf_um;
  if (is_tracked) start.velocity_um_period = predicted.velocity_um_period;
  return start;
}

// The motion model that is compared with the track's in this frame: the network's, or the next one of all.
int challenger_of(const PoseFrame& frame, PoseTrackerState& state) {
  const int next = clamp(state.challenger, 0, 2 * kMotionModels) + 1;  // memory may be damaged
  state.challenger = next < 2 * kMotionModels ? next : 0;
  const int turn = clamp<int>(state.challenger / 2, 0, kMotionModels - 1);
  const bool is_networks_turn = state.challenger % 2 == 0 && frame.network_motion_model != state.motion_model;
  return clamp<int>(is_networks_turn ? frame.network_motion_model : turn, 0, kMotionModels - 1);
}

// The rate that leads from one pose to the next; zero for more than 150 degrees.
Vector3<Fixed> rate_between(const PoseMeasurement& first, const PoseMeasurement& second) {
  const Matrix3<Fixed> turn =
      product<Fixed>(second.pose.r_lrf_trf, Matrix3<Fixed>(first.pose.r_lrf_trf.transpose()));
  Vector3<Fixed> rate = rotation_vector<Fixed>(turn, constant<Fixed>(kVersineOf150Degrees));
  const std::int64_t elapsed_ns = max<std::int64_t>(1, first.age_ns - second.age_ns);
  for (int i = 0; i < 3; ++i)
    rate[i] = Fixed::from_raw(divide(rate[i].raw() * kNominalPeriod_ns, elapsed_ns));
  return rate;
}

// Fits the poses under the motion model of the track. What the frame has held back for it is enough, whatever
// the rate; the rest is given back.
void fit_by_reserve(const PoseFrame& frame, const PoseMotion& start, int iterations, PoseScratch& scratch,
                    const PoseTrackerState& state) {
  const auto motion_model = static_cast<std::size_t>(clamp(state.motion_model, 0, kMotionModels - 1));
  fit_motion(state.history, frame.motion_models[motion_model], scratch.view.target_radius_um, start,
             iterations, scratch.fit_reserve, scratch.fit);
  scratch.refinement.budget.give_back(scratch.fit_reserve.left());
}

// Fits the poses under a motion model, into scratch.other_fit. False: the budget of the frame does not cover
// it.
bool fit_by_budget(const PoseFrame& frame, int motion_model, const PoseMotion& start, int iterations,
                   PoseScratch& scratch, const PoseTrackerState& state) {
  WorkBudget& budget = scratch.refinement.budget;
  fit_motion(state.history,
             frame.motion_models[static_cast<std::size_t>(clamp(motion_model, 0, kMotionModels - 1))],
             scratch.view.target_radius_um, start, iterations, budget, scratch.other_fit);
  return budget.end_part();
}

int iterations_for(int poses) {
  return poses >= kPosesOfALongTrack ? 1 : poses >= kPosesOfARate ? 2 : kMostIterations;
}

// Under the motion model of the track. If the rate at the start does not lead back to the pose before, the
// rate between these two is tried.
void fit_under_motion_model(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
                            const PoseTrackerState& state) {
  const int count = state.history.count;
  fit_by_reserve(frame, start, iterations_for(count), scratch, state);
  if (count < 2 || ((scratch.fit.against >> (count - 2)) & 1U) == 0) return;
  const auto newest = static_cast<std::size_t>(count - 1);
  PoseMotion other_start = start;
  other_start.turning.rate_lrf = rate_between(state.history.poses[newest - 1], state.history.poses[newest]);
  if (!fit_by_budget(frame, state.motion_model, other_start, kMostIterations, scratch, state)) return;
  if (scratch.other_fit.disagreement_q8 < scratch.fit.disagreement_q8) scratch.fit = scratch.other_fit;
}

// If the poses do not agree, another motion model is tried. The motion models take turns.
void try_other_motion_model(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
                            PoseTrackerState& state) {
  if (state.history.count < kPosesOfAMotionModel || scratch.fit.disagreement_q8 <= kDisagreement_q8) return;
  const int challenger_before = state.challenger;
  const int motion_model = challenger_of(frame, state);
  if (!fit_by_budget(frame, motion_model, start, kMostIterations, scratch, state)) {
    state.challenger = challenger_before;  // its turn comes again
    return;
  }
  if (scratch.other_fit.disagreement_q8 >= scratch.fit.disagreement_q8 * 3 / 4) return;
  state.motion_model = motion_model;
  scratch.fit = scratch.other_fit;
}

// Fits the motion to the others. False: the budget does not cover it, and the motion is still that of all.
bool forget(std::uint32_t poses, const PoseFrame& frame, PoseScratch& scratch, PoseTrackerState& state) {
  if (poses == 0) return true;
  state.history.remove(poses);
  if (!fit_by_budget(frame, state.motion_model, scratch.fit.motion, 1, scratch, state)) return false;
  scratch.fit = scratch.other_fit;
  return true;
}

// Fits the motion to the poses and forgets those that do not agree with it, except the newest. False: the
// newest does not agree, or the motion is not that of the poses that were kept.
bool fit_track(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
               PoseTrackerState& state) {
  fit_under_motion_model(frame, start, scratch, state);
  try_other_motion_model(frame, start, scratch, state);
  const std::uint32_t newest = std::uint32_t{1} << (state.history.count - 1);
  const bool newest_agrees = (scratch.fit.against & newest) == 0;
  const bool is_fitted = forget(scratch.fit.against & ~newest, frame, scratch, state);
  state.motion = scratch.fit.motion;
  return newest_agrees && is_fitted;
}

// Of a motion that has coasted since the last pose: what is not known of the rates adds to turn and position.
void make_coasting_covariance(const PoseFrame& frame, const PoseTrackerState& state, PoseScratch& scratch,
                              PoseCovariance& covariance) {
  const PoseMeasurement& last = state.history.poses[static_cast<std::size_t>(state.history.count - 1)];
  PoseMotion start = state.motion;
  start.turning.r_lrf_trf = last.pose.r_lrf_trf;
  start.origin_lrf_um = last.pose.origin_lrf_um;
  fit_by_reserve(frame, start, 1, scratch, state);
  make_covariance(scratch.fit, state.history.count, scratch.view.target_radius_um, covariance);
  constexpr std::int64_t kPerMillisecond = 1'000'000;
  const std::int64_t elapsed_ms = divide(max<std::int64_t>(0, last.age_ns), kPerMillisecond);
  for (std::size_t i = 0; i < covariance.sigma.size(); i += 6) {
    for (std::size_t k = i; k < i + 3; ++k) {
      const std::int64_t grown = divide(covariance.sigma[k + 3] * elapsed_ms, 1000) + covariance.sigma[k];
      covariance.sigma[k] = static_cast<std::uint32_t>(min<std::int64_t>(grown, 0x7FFF'FFFF));
    }
  }
}

// Memory may be damaged.
void limit_damage(PoseTrackerState& state) {
  state.history.count = clamp(state.history.count, 0, PoseHistory::kMost);
  state.llr_q8 = limited_llr_q8(state.llr_q8);
  state.conservative_llr_q8 = min(limited_llr_q8(state.conservative_llr_q8), state.llr_q8);
  state.owes_comparison = clamp(state.owes_comparison, 0, 1);
  if (state.history.count == 0) state.motion = {};
}

// Poses and motion to the time of the frame.
void advance(const PoseFrame& frame, PoseTrackerState& state) {
  state.motion = later_pose(state, frame.motion_models, frame.elapsed_ns, frame.r_now_last);
  state.history.advance(frame.elapsed_ns, frame.r_now_last);
}

// One fit is always made: of the pose of this frame, or of a track that coasts.
void begin_budgets(const PoseTrackerState& state, std::int32_t budget, Deadline* deadline,
                   PoseScratch& scratch) {
  const std::int32_t reserve = work_of_fit(state.history, iterations_for(state.history.count + 1));
  scratch.fit_reserve.begin(reserve);
  scratch.refinement.budget.begin(budget, deadline);
  scratch.refinement.budget.spend(work::kFrame + reserve);
  scratch.refinement.dearest_step = 0;
  scratch.is_uncompared = false;
}

// False: registration does not work in this frame.
bool view_target(const PoseTarget& target, const PoseFrame& frame, bool is_tracked, PoseScratch& scratch,
                 const PoseTrackerState& state) {
  const std::int32_t depth_um = is_tracked ? state.motion.origin_lrf_um[1] : frame.centroid_lrf_mm[1] * 1000;
  return target.mesh.is_known() &&
         make_frame_view(frame.image, frame.mask, depth_um, target.radius_mm, target.noise, scratch.view);
}

void forget_track(PoseTrackerState& state) {
  state.history.count = 0;
  state.llr_q8 = state.conservative_llr_q8 = 0;
  state.owes_comparison = 0;
}

// Registers the frame at the predicted pose or at the attitudes of the network. False: its motion is not that
// of the track.
bool register_frame(const PoseTarget& target, const PoseFrame& frame, bool is_tracked, PoseScratch& scratch,
                    PoseTrackerState& state, PoseEstimate& estimate) {
  const int poses_before = state.history.count;
  const std::int32_t llr_before_q8 = state.llr_q8, conservative_before_q8 = state.conservative_llr_q8;
  const int owed_before = state.owes_comparison;
  if (is_tracked) {
    is_tracked = follow_track(target, frame, scratch, state);
  } else {
    start_track(target, frame, scratch, state);
  }
  // Not all was compared: such a frame says nothing.
  const bool is_cut_short = scratch.refinement.budget.is_exhausted();
  if (is_cut_short) {
    scratch.best.evidence = {};
    state.history.count = poses_before;
    state.llr_q8 = llr_before_q8;
    state.conservative_llr_q8 = conservative_before_q8;
    state.owes_comparison = owed_before;
  }
  estimate.evidence = scratch.best.evidence;
  estimate.conservative_llr_q8 = state.conservative_llr_q8;
  estimate.doubts = is_cut_short || scratch.is_uncompared ? kPoseAmbiguous : 0;
  return is_tracked;
}

// Fits the motion to the poses with that of this frame, or lets the track coast if it has none. False: there
// is no pose yet.
bool estimate_motion(const PoseFrame& frame, bool is_tracked, PoseScratch& scratch, PoseTrackerState& state,
                     PoseEstimate& estimate) {
  const PoseCandidate& best = scratch.best;
  const bool is_measured = best.refinement.is_complete && best.evidence.blocks > 0;
  if (!is_measured) {
    const bool is_known = state.history.count > 0;
    estimate.doubts |= is_known ? kPoseCoasts : kPoseUnknown;
    if (is_known) make_coasting_covariance(frame, state, scratch, estimate.covariance);
    return is_known;
  }
  PoseMeasurement measurement = measured_pose(best.refinement.pose, best.refinement.equations);
  discount(best.evidence, measurement);
  state.history.add(measurement);
  if (!fit_track(frame, start_of_fit(frame, state.motion, best.refinement.pose, is_tracked), scratch, state))
    estimate.doubts |= kPoseMotion;
  estimate.disagreement_q8 = scratch.fit.disagreement_q8;
  make_covariance(scratch.fit, max(1, state.history.count), scratch.view.target_radius_um,
                  estimate.covariance);
  return true;
}

// Registers the frame and fits the motion of the track.
void estimate_pose(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch, bool is_tracked,
                   PoseTrackerState& state, PoseEstimate& estimate) {
  const std::int32_t llr_before_q8 = state.llr_q8;
  is_tracked = register_frame(target, frame, is_tracked, scratch, state, estimate);
  if (!estimate_motion(frame, is_tracked, scratch, state, estimate)) return;
  if (!tells_rate(state.history)) estimate.doubts |= kPoseMotion;
  if (llr_before_q8 - state.llr_q8 > kMostAgainstTrack_q8) estimate.doubts |= kPoseAmbiguous;
  estimate.poses = state.history.count;
  estimate.state = pose_state(state.motion);
  estimate.doubts |= doubts_of(frame, state.motion.turning.r_lrf_trf, estimate);
}

}  // namespace

PoseState pose_state(const PoseMotion& motion) {
  PoseState state;
  state.q_lrf_trf = quaternion_from_rotation(motion.turning.r_lrf_trf);
  state.origin_lrf_um = motion.origin_lrf_um;
  state.rate_lrf_urad_s = rate_urad_s(motion.turning.rate_lrf);
  constexpr std::int64_t kTenthsPerPeriod = kNominalPeriod_ns / 100'000'000;
  for (std::size_t i = 0; i < 3; ++i)
    state.velocity_lrf_um_s[i] =
        static_cast<std::int32_t>(divide(motion.velocity_um_period[i] * std::int64_t{10}, kTenthsPerPeriod));
  return state;
}

PoseMotion later_pose(const PoseTrackerState& state, const MotionModels<Fixed>& motion_models,
                      std::int64_t elapsed_ns, const Matrix3<Fixed>& r_now_last) {
  const auto motion_model = static_cast<std::size_t>(clamp(state.motion_model, 0, kMotionModels - 1));
  return later_motion(state.motion, motion_models[motion_model], elapsed_ns, r_now_last);
}

void track_pose(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                ScreenVertices& vertices, PoseTrackerState& state, PoseEstimate& estimate,
                std::int32_t budget, Deadline* deadline) {
  estimate = {};
  scratch.refinement.surface.vertices = &vertices;
  limit_damage(state);
  advance(frame, state);
  begin_budgets(state, budget, deadline, scratch);
  const bool is_tracked = state.history.count >= kTrackedPoses;
  if (!view_target(target, frame, is_tracked, scratch, state)) {
    forget_track(state);
    return;
  }
  estimate_pose(target, frame, scratch, is_tracked, state, estimate);
  estimate.is_cut_short = scratch.refinement.budget.is_late();
}

}  // namespace tumblesight::gnc
