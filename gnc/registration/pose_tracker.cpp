#include "gnc/registration/pose_tracker.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kTrackedPoses = 2;  // from so many on the motion predicts the next pose
constexpr int kPosesOfALaw = 3;   // from so many on they tell laws of motion apart
// From so many on the predicted motion is a good start of the fit, and a very good one.
constexpr int kPosesOfARate = 4, kPosesOfALongTrack = 7;
constexpr std::int64_t kDisagreement_q8 = 90;                        // from here on another law is tried
constexpr std::int64_t kLongestStep_ns = 3 * kNominalPeriod_ns / 2;  // between frames without a gap

// Before the track knows a rate: the network's attitude is a degree or two off, and the position that the
// middle of the returns gives is off by some rays where a part of the target is hidden.
constexpr RefinementSettings kFirst{3, 3, 512, 128, 1677722, 8388608};
constexpr RefinementSettings kFull{3, 2, 160, 40, 1677722, 8388608};
// Of another attitude than the track's, at the position of the track. The second from kShort on.
constexpr RefinementSettings kShort{2, 2, 512, 128, 1677722, 8388608};
constexpr RefinementSettings kConfirm{2, 0, 128, 40, 1677722, 8388608};
// At the predicted pose.
constexpr RefinementSettings kTracked{3, 1, 160, 40, 838861, 8388608};
constexpr RefinementSettings kLongTrack{2, 1, 80, 40, 838861, 8388608};  // with a rate, and without a gap

// 1 + 2 cos of the angle between two attitudes that are different ones.
constexpr Fixed kTraceOf2Degrees = constant<Fixed>(2.99878165);
constexpr Fixed kTraceOf6Degrees = constant<Fixed>(2.98904379);
constexpr Fixed kTraceOf20Degrees = constant<Fixed>(2.87938524);

constexpr std::uint32_t kLeastOdds_ppm = 10'000;  // of a second attitude that is worth a look

// Advantages [nats, Q8]. From kSettled_q8 on only the network's own choice is compared with the track.
constexpr std::int32_t kMostOfAFrame_q8 = 16 * 256, kMostOfATrack_q8 = 32 * 256;
constexpr std::int32_t kWithoutAlternative_q8 = 4 * 256;  // of a frame
constexpr std::int32_t kNetworkDisagrees_q8 = 1 * 256;    // against the track, per frame
constexpr std::int32_t kMostOfNetwork_q8 = 4 * 256;       // its odds, in the first frames
constexpr std::int32_t kClear_q8 = 6 * 256;               // after kFirst, for the second attitude
constexpr std::int32_t kLeastAdvantage_q8 = 8 * 256, kSettled_q8 = 16 * 256;

// Limits of the verdict.
constexpr int kVerifiedPoses = 3;
constexpr std::int64_t kLongestToTellRate_ns = 7'500'000'000;  // between poses; as of the network's track
constexpr std::int32_t kLargestMeanSquare_q8 = 410;            // 1.6
constexpr std::uint32_t kMostUnexplained_ppm = 30'000, kMostMissing_ppm = 690'000;
constexpr std::int64_t kMostDisagreement_q8 = 3 * 256;
constexpr std::uint32_t kLargestSigma_urad = 17'453;  // a degree

bool explains(const PoseEvidence& evidence) {
  return evidence.blocks > 0 && evidence.mean_square_q8() <= kLargestMeanSquare_q8 &&
         evidence.unexplained_ppm() <= kMostUnexplained_ppm && evidence.missing_ppm() <= kMostMissing_ppm;
}

bool differs(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b, Fixed trace) {
  return trace_of_transpose_product<Fixed>(a, b) < trace;
}

// Sums over rays: their place and the mean nearness of the blocks that they are in.
struct Middle {
  std::int64_t rays = 0, columns = 0, rows = 0, nearness = 0;
  void add(int row, int column, int count, std::int32_t value) {
    rays += count;
    columns += std::int64_t{count} * column;
    rows += std::int64_t{count} * row;
    nearness += std::int64_t{count} * value;
  }
  std::int64_t mean_q8(std::int64_t sum) const { return divide(sum * 256, max<std::int64_t>(rays, 1)); }
};

// Whether the network's second attitude is another one than this.
bool offers_second(const Matrix3<Fixed>& r_lrf_trf, const PoseFrame& frame) {
  return frame.second_odds_ppm >= kLeastOdds_ppm &&
         differs(r_lrf_trf, frame.second_r_lrf_trf, kTraceOf20Degrees);
}

// A pose with the attitude `r_lrf_trf`, at which the middle of the drawn target is that of the returns.
Pose placed(const PoseTarget& target, const PoseFrame& frame, const Matrix3<Fixed>& r_lrf_trf,
            PoseScratch& scratch) {
  const FrameView& view = scratch.view;
  const RenderedSurface& surface = scratch.refinement.surface;
  Pose pose;
  pose.r_lrf_trf = r_lrf_trf;
  for (std::size_t i = 0; i < 3; ++i) pose.origin_lrf_um[i] = frame.centroid_lrf_mm[i] * 1000;
  render(target.mesh, view, pose, scratch.refinement.surface);
  Middle seen, drawn;
  for (int row = 0; row + 1 < view.rays; row += 2) {
    for (int column = 0; column + 1 < view.rays; column += 2) {
      const int returns =
          rays_of_pair(view.returned.pair(row, column)) + rays_of_pair(view.returned.pair(row + 1, column));
      seen.add(row, column, returns, view.nearness_of_block(row / 2, column / 2));
      if (surface.is_filled(row, column)) drawn.add(row, column, 1, surface.at(row, column));
    }
  }
  if (seen.rays == 0 || drawn.rays == 0) return pose;
  const auto um = [&view](std::int64_t rays_q8) {
    return static_cast<std::int32_t>(
        divide(rays_q8 * view.target_radius_um, max<std::int64_t>(view.rays_per_radius_q8, 1)));
  };
  pose.origin_lrf_um[0] += um(seen.mean_q8(seen.columns) - drawn.mean_q8(drawn.columns));
  pose.origin_lrf_um[2] -= um(seen.mean_q8(seen.rows) - drawn.mean_q8(drawn.rows));
  const std::int64_t nearer_q8 = seen.mean_q8(seen.nearness) - drawn.mean_q8(drawn.nearness);
  pose.origin_lrf_um[1] -=
      static_cast<std::int32_t>((nearer_q8 * view.reference_depth_um) >> (8 + view.shift));
  return pose;
}

void refine_candidate(const PoseTarget& target, const Pose& start, const RefinementSettings& settings,
                      PoseScratch& scratch, PoseCandidate& candidate) {
  refine(target.mesh, scratch.view, start, settings, scratch.refinement, candidate.refinement);
  candidate.evidence = evidence_of(scratch.view, scratch.refinement.surface, scratch.refinement.ranges);
}

// What is compared with the pose of the track.
struct Alternative {
  Matrix3<Fixed> r_lrf_trf;
  bool exists = false;
  bool is_network = false;  // it is the network's choice
};

// Another attitude of the network than this, if it has one: its choice, or its second attitude unless the
// track is settled. The choice also counts if it is not quite the same: the pose may be beside the right one.
Alternative alternative_to(const Matrix3<Fixed>& r_lrf_trf, const PoseFrame& frame, bool is_settled) {
  const Matrix3<Fixed>& choice = frame.network.r_lrf_trf;
  if (differs(r_lrf_trf, choice, kTraceOf20Degrees)) return {choice, true, true};
  if (!is_settled && offers_second(r_lrf_trf, frame)) return {frame.second_r_lrf_trf, true, false};
  return {choice, differs(r_lrf_trf, choice, kTraceOf6Degrees), true};
}

// By how much the first explains the frame better, limited.
std::int32_t advantage_q8(const PoseCandidate& first, const PoseCandidate& second) {
  return clamp<std::int32_t>(second.evidence.cost_q8() - first.evidence.cost_q8(), -kMostOfAFrame_q8,
                             kMostOfAFrame_q8);
}

void add_advantage(std::int32_t more_q8, PoseTrackerState& state) {
  state.advantage_q8 = clamp<std::int32_t>(state.advantage_q8 + more_q8, -kMostOfATrack_q8, kMostOfATrack_q8);
}

// What the network's odds say for its first attitude against its second one [nats, Q8], limited.
std::int32_t network_advantage_q8(std::uint32_t second_odds_ppm) {
  constexpr std::int32_t kNatsPerBit_q8 = 177;
  const int bits_below_one = 20 - highest_bit(second_odds_ppm);
  return clamp<std::int32_t>(bits_below_one * kNatsPerBit_q8, -kMostOfNetwork_q8, kMostOfNetwork_q8);
}

// The first frames of a track: `best` becomes the network's attitude or its second one.
void start_track(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                 PoseTrackerState& state) {
  PoseCandidate& best = scratch.best;
  PoseCandidate& other = scratch.other;
  refine_candidate(target, placed(target, frame, frame.network.r_lrf_trf, scratch), kFirst, scratch, best);
  const bool has_second = offers_second(best.refinement.pose.r_lrf_trf, frame);
  std::int32_t more_q8 = kWithoutAlternative_q8;
  if (has_second) {
    refine_candidate(target, placed(target, frame, frame.second_r_lrf_trf, scratch), kFirst, scratch, other);
    more_q8 = advantage_q8(best, other) + network_advantage_q8(frame.second_odds_ppm);
  }
  if (more_q8 < -kClear_q8) {
    best = other;
    // The pose before, if any, is of the other attitude.
    state.history.count = 0;
  }
  // What spoke for another attitude does not speak for this one.
  const bool goes_on = state.history.count > 0 && !differs(best.refinement.pose.r_lrf_trf,
                                                           state.motion.turning.r_lrf_trf, kTraceOf20Degrees);
  if (!goes_on) state.advantage_q8 = 0;
  add_advantage(more_q8 < 0 && more_q8 >= -kClear_q8 ? more_q8 : abs(more_q8), state);
  const Pose start = best.refinement.pose;
  refine_candidate(target, start, kFull, scratch, best);
}

// Registers the frame at the pose that the motion of the track predicts. After a gap, or if a short
// registration does not explain the frame, in more steps.
void follow_motion(const PoseTarget& target, const PoseFrame& frame, const PoseMotion& predicted,
                   PoseScratch& scratch, const PoseTrackerState& state) {
  const Pose start{predicted.turning.r_lrf_trf, predicted.origin_lrf_um};
  if (state.history.count >= kPosesOfARate && frame.elapsed_ns <= kLongestStep_ns) {
    refine_candidate(target, start, kLongTrack, scratch, scratch.best);
    if (explains(scratch.best.evidence)) return;
  }
  refine_candidate(target, start, kTracked, scratch, scratch.best);
}

// Registers an attitude of the network at the position of the track. Returns by how much the track explains
// the frame better.
std::int32_t compare(const PoseTarget& target, const Alternative& alternative, PoseScratch& scratch) {
  const Pose start{alternative.r_lrf_trf, scratch.best.refinement.pose.origin_lrf_um};
  if (alternative.is_network) {
    refine_candidate(target, start, kFull, scratch, scratch.other);
    return advantage_q8(scratch.best, scratch.other) - kNetworkDisagrees_q8;
  }
  refine_candidate(target, start, kShort, scratch, scratch.other);
  const std::int32_t short_q8 = advantage_q8(scratch.best, scratch.other);
  if (short_q8 >= 0) return short_q8;
  const Pose found = scratch.other.refinement.pose;
  refine_candidate(target, found, kConfirm, scratch, scratch.other);
  return advantage_q8(scratch.best, scratch.other);
}

// A frame of a track whose motion predicts `predicted`. False: the track was given up for another attitude.
bool follow_track(const PoseTarget& target, const PoseFrame& frame, const PoseMotion& predicted,
                  PoseScratch& scratch, PoseTrackerState& state) {
  PoseCandidate& best = scratch.best;
  PoseCandidate& other = scratch.other;
  follow_motion(target, frame, predicted, scratch, state);
  const bool is_settled = state.advantage_q8 >= kSettled_q8;
  const Alternative alternative = alternative_to(best.refinement.pose.r_lrf_trf, frame, is_settled);
  std::int32_t more_q8 = kWithoutAlternative_q8;
  bool has_other = false;  // `other` is another pose of this frame
  if (alternative.exists) {
    const std::int32_t advantage = compare(target, alternative, scratch);
    has_other = differs(best.refinement.pose.r_lrf_trf, other.refinement.pose.r_lrf_trf, kTraceOf2Degrees);
    if (has_other) more_q8 = advantage;
  }
  add_advantage(more_q8, state);
  const bool is_lost = more_q8 < 0 && !explains(best.evidence) && explains(other.evidence);
  if (!has_other || (state.advantage_q8 >= 0 && !is_lost)) return true;
  best = other;
  state.advantage_q8 = abs(state.advantage_q8);
  state.history.count = 0;
  return false;
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
  if (evidence.blocks == 0 || evidence.mean_square_q8() > kLargestMeanSquare_q8) doubts |= kPoseRanges;
  if (evidence.unexplained_ppm() > kMostUnexplained_ppm || evidence.missing_ppm() > kMostMissing_ppm)
    doubts |= kPoseOutline;
  if (estimate.advantage_q8 < kLeastAdvantage_q8) doubts |= kPoseAmbiguous;
  if (estimate.poses < kVerifiedPoses || estimate.disagreement_q8 > kMostDisagreement_q8)
    doubts |= kPoseMotion;
  for (std::size_t i = 0; i < 3; ++i)
    if (estimate.covariance.sigma[i] > kLargestSigma_urad) doubts |= kPoseUncertain;
  if (differs(r_lrf_trf, frame.network.r_lrf_trf, kTraceOf20Degrees)) doubts |= kPoseNetwork;
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

// The law that is compared with the track's in this frame: the network's, or the next one of all.
int challenger_of(const PoseFrame& frame, PoseTrackerState& state) {
  const int next = clamp(state.challenger, 0, 2 * kLaws) + 1;  // memory may be damaged
  state.challenger = next < 2 * kLaws ? next : 0;
  const int turn = clamp<int>(state.challenger / 2, 0, kLaws - 1);
  const bool is_networks_turn = state.challenger % 2 == 0 && frame.network_law != state.law;
  return clamp<int>(is_networks_turn ? frame.network_law : turn, 0, kLaws - 1);
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

// Under the law of the track. If the rate at the start does not lead back to the pose before, the rate
// between these two is tried.
void fit_under_law(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
                   const PoseTrackerState& state) {
  const std::int32_t radius_um = scratch.view.target_radius_um;
  const auto law = static_cast<std::size_t>(clamp(state.law, 0, kLaws - 1));
  const int count = state.history.count;
  const int iterations = count >= kPosesOfALongTrack ? 1 : count >= kPosesOfARate ? 2 : kMostIterations;
  fit_motion(state.history, frame.laws[law], radius_um, start, iterations, scratch.fit);
  if (count < 2 || ((scratch.fit.against >> (count - 2)) & 1U) == 0) return;
  const auto newest = static_cast<std::size_t>(count - 1);
  PoseMotion other_start = start;
  other_start.turning.rate_lrf = rate_between(state.history.poses[newest - 1], state.history.poses[newest]);
  fit_motion(state.history, frame.laws[law], radius_um, other_start, kMostIterations, scratch.other_fit);
  if (scratch.other_fit.disagreement_q8 < scratch.fit.disagreement_q8) scratch.fit = scratch.other_fit;
}

// If the poses do not agree, another law is tried. The laws take turns.
void try_other_law(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
                   PoseTrackerState& state) {
  if (state.history.count < kPosesOfALaw || scratch.fit.disagreement_q8 <= kDisagreement_q8) return;
  const int law = challenger_of(frame, state);
  fit_motion(state.history, frame.laws[static_cast<std::size_t>(law)], scratch.view.target_radius_um, start,
             kMostIterations, scratch.other_fit);
  if (scratch.other_fit.disagreement_q8 >= scratch.fit.disagreement_q8 * 3 / 4) return;
  state.law = law;
  scratch.fit = scratch.other_fit;
}

// Fits the motion to the poses and forgets those that do not agree with it, except the newest. False: the
// newest does not agree.
bool fit_track(const PoseFrame& frame, const PoseMotion& start, PoseScratch& scratch,
               PoseTrackerState& state) {
  fit_under_law(frame, start, scratch, state);
  try_other_law(frame, start, scratch, state);
  const std::uint32_t newest = std::uint32_t{1} << (state.history.count - 1);
  const bool newest_agrees = (scratch.fit.against & newest) == 0;
  if ((scratch.fit.against & ~newest) != 0) {
    state.history.remove(scratch.fit.against & ~newest);
    const PoseMotion found = scratch.fit.motion;
    const auto law = static_cast<std::size_t>(clamp(state.law, 0, kLaws - 1));
    fit_motion(state.history, frame.laws[law], scratch.view.target_radius_um, found, 1, scratch.fit);
  }
  state.motion = scratch.fit.motion;
  return newest_agrees;
}

// Of a motion that has coasted since the last pose: what is not known of the rates adds to turn and position.
void make_coasting_covariance(const PoseFrame& frame, const PoseTrackerState& state, PoseScratch& scratch,
                              PoseCovariance& covariance) {
  const PoseMeasurement& last = state.history.poses[static_cast<std::size_t>(state.history.count - 1)];
  PoseMotion start = state.motion;
  start.turning.r_lrf_trf = last.pose.r_lrf_trf;
  start.origin_lrf_um = last.pose.origin_lrf_um;
  const auto law = static_cast<std::size_t>(clamp(state.law, 0, kLaws - 1));
  fit_motion(state.history, frame.laws[law], scratch.view.target_radius_um, start, 1, scratch.fit);
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

PoseMotion later_pose(const PoseTrackerState& state, const MotionLaws<Fixed>& laws, std::int64_t elapsed_ns,
                      const Matrix3<Fixed>& r_now_last) {
  const auto law = static_cast<std::size_t>(clamp(state.law, 0, kLaws - 1));
  return later_motion(state.motion, laws[law], elapsed_ns, r_now_last);
}

void track_pose(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                ScreenVertices& vertices, PoseTrackerState& state, PoseEstimate& estimate) {
  estimate = {};
  scratch.refinement.surface.vertices = &vertices;
  // Memory may be damaged.
  state.history.count = clamp(state.history.count, 0, PoseHistory::kMost);
  state.advantage_q8 = clamp(state.advantage_q8, -kMostOfATrack_q8, kMostOfATrack_q8);
  if (state.history.count == 0) state.motion = {};
  const PoseMotion predicted = later_pose(state, frame.laws, frame.elapsed_ns, frame.r_now_last);
  state.history.advance(frame.elapsed_ns, frame.r_now_last);
  state.motion = predicted;
  bool is_tracked = state.history.count >= kTrackedPoses;
  const std::int32_t depth_um = is_tracked ? predicted.origin_lrf_um[1] : frame.centroid_lrf_mm[1] * 1000;
  if (!target.mesh.is_known() ||
      !make_frame_view(frame.image, frame.mask, depth_um, target.radius_mm, target.noise, scratch.view)) {
    state.history.count = 0;
    state.advantage_q8 = 0;
    return;
  }
  if (is_tracked) {
    is_tracked = follow_track(target, frame, predicted, scratch, state);
  } else {
    start_track(target, frame, scratch, state);
  }
  estimate.evidence = scratch.best.evidence;
  estimate.advantage_q8 = state.advantage_q8;
  estimate.doubts = 0;
  const bool is_measured = scratch.best.refinement.is_complete && scratch.best.evidence.blocks > 0;
  if (is_measured) {
    const Pose& pose = scratch.best.refinement.pose;
    state.history.add(measured_pose(pose, scratch.best.refinement.equations));
    if (!fit_track(frame, start_of_fit(frame, predicted, pose, is_tracked), scratch, state))
      estimate.doubts = kPoseMotion;
    estimate.disagreement_q8 = scratch.fit.disagreement_q8;
    make_covariance(scratch.fit, max(1, state.history.count), scratch.view.target_radius_um,
                    estimate.covariance);
  } else if (state.history.count == 0) {
    estimate.doubts = kPoseUnknown;
    return;
  } else {
    estimate.doubts = kPoseCoasts;
    make_coasting_covariance(frame, state, scratch, estimate.covariance);
  }
  if (!tells_rate(state.history)) estimate.doubts |= kPoseMotion;
  estimate.poses = state.history.count;
  estimate.state = pose_state(state.motion);
  estimate.doubts |= doubts_of(frame, state.motion.turning.r_lrf_trf, estimate);
}

}  // namespace tumblesight::gnc
