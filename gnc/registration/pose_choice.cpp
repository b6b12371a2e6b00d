#include "gnc/registration/pose_choice.hpp"

#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kLongestStep_ns = 3 * kNominalPeriod_ns / 2;  // between frames without a gap

// Before the track knows a rate: the network's attitude is a degree or two off, and the position that the
// middle of the returns gives is off by some rays where a part of the target is hidden.
constexpr RefinementSettings kFirst{3, 3, 512, 128, 1677722, 8388608};
constexpr RefinementSettings kFirstSecond{2, 2, 512, 256, 1677722, 8388608};  // of the second attitude
constexpr RefinementSettings kFull{3, 2, 160, 40, 1677722, 8388608};
constexpr RefinementSettings kShortFull{2, 1, 80, 40, 1677722, 8388608};  // its last two steps
// At the predicted pose.
constexpr RefinementSettings kTracked{3, 1, 160, 40, 838861, 8388608};
constexpr RefinementSettings kLongTrack{2, 1, 80, 40, 838861, 8388608};  // with a rate, and without a gap
constexpr RefinementSettings kTrackedFurther{2, 1, 160, 80, 838861, 8388608};
// In a frame that is not explained: there the network's attitude is ten degrees off, as where surfaces are
// dark. The first is of the first frames, the other of a track.
constexpr RefinementSettings kLongSearch{4, 2, 512, 64, 4194304, 8388608};
constexpr RefinementSettings kSearch{3, 2, 512, 128, 4194304, 8388608};
constexpr RefinementSettings kShortSearch{2, 2, 512, 128, 4194304, 8388608};
// Drawing the surface anew, and a placement, count as a step each.
constexpr int kStepsOfDrawing = 1, kStepsOfPlacement = 1;
constexpr int kStepsOfSearchAndComparison =
    kSearch.steps + kStepsOfPlacement + kStepsOfDrawing + kShortSearch.steps;

// 1 + 2 cos of the angle between two attitudes that are different ones.
constexpr Fixed kTraceOf2Degrees = constant<Fixed>(2.99878165);
constexpr Fixed kTraceOf6Degrees = constant<Fixed>(2.98904379);
constexpr Fixed kTraceOf20Degrees = constant<Fixed>(2.87938524);

constexpr std::uint32_t kLeastOdds_ppm = 10'000;  // of a second attitude that is worth a look

// Log-likelihood ratios [nats, Q8].
constexpr std::int32_t kMostOfAFrame_q8 = 16 * 256;
constexpr std::int32_t kWithoutAlternative_q8 = 4 * 256;  // of a frame
constexpr std::int32_t kMostOfNetwork_q8 = 4 * 256;       // its odds, in the first frames
constexpr std::int32_t kClear_q8 = 6 * 256;               // after kFirst, for the second attitude
constexpr std::int32_t kMostOfATrack_q8 = 2 * kMostOfAFrame_q8;

// Which part of a difference the conservative ratio counts, see conservative_llr_q8(): all of it, a 16th
// after a short registration, or a 32nd.
constexpr std::int32_t kMostByAFit_q8 = 6 * 256;
constexpr int kFitShift = 0, kShortFitShift = 4, kMisfitShift = 5;

void exchange(PoseCandidate& a, PoseCandidate& b) {
  const PoseCandidate kept = a;
  a = b;
  b = kept;
}

bool differs(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b, Fixed trace) {
  return trace_of_transpose_product<Fixed>(a, b) < trace;
}

// Whether the network's second attitude is another one than this.
bool offers_second(const Matrix3<Fixed>& r_lrf_trf, const PoseFrame& frame) {
  return frame.second_odds_ppm >= kLeastOdds_ppm && is_another_attitude(r_lrf_trf, frame.second_r_lrf_trf);
}

// A pose with the attitude `r_lrf_trf`, where the target is among the returns.
Pose placed(const PoseTarget& target, const PoseFrame& frame, const Matrix3<Fixed>& r_lrf_trf,
            PoseScratch& scratch) {
  Pose pose;
  pose.r_lrf_trf = r_lrf_trf;
  for (std::size_t i = 0; i < 3; ++i) pose.origin_lrf_um[i] = frame.centroid_lrf_mm[i] * 1000;
  place(target.mesh, scratch.view, scratch.refinement.surface, scratch.placement, pose,
        scratch.refinement.budget);
  return pose;
}

// What speaks against the pose that was refined last; nothing is known if the budget was exhausted.
PoseEvidence evidence_of_last(const PoseScratch& scratch) {
  if (scratch.refinement.budget.is_exhausted()) return {};
  const RefinementScratch& last = scratch.refinement;
  return evidence_of(scratch.view, last.surface, last.ranges, last.dark.surfaces);
}

void refine_candidate(const PoseTarget& target, const Pose& start, const RefinementSettings& settings,
                      PoseScratch& scratch, PoseCandidate& candidate) {
  refine(target.mesh, scratch.view, start, settings, scratch.refinement, candidate.refinement);
  candidate.evidence = evidence_of_last(scratch);
}

// Goes on with the candidate that was refined last.
void refine_candidate_further(const PoseTarget& target, const RefinementSettings& settings,
                              PoseScratch& scratch, PoseCandidate& candidate) {
  refine_further(target.mesh, scratch.view, settings, scratch.refinement, candidate.refinement);
  candidate.evidence = evidence_of_last(scratch);
}

// The same, with the surface drawn anew if another candidate was refined last.
void go_on(const PoseTarget& target, const RefinementSettings& settings, bool is_anew, PoseScratch& scratch,
           PoseCandidate& candidate) {
  if (!is_anew) return refine_candidate_further(target, settings, scratch, candidate);
  const Pose start = candidate.refinement.pose;
  refine_candidate(target, start, settings, scratch, candidate);
}

// What is compared with the pose of the track.
struct Alternative {
  Matrix3<Fixed> r_lrf_trf;
  bool exists = false;
  bool is_network = false;  // it is the network's choice
};

// Another attitude of the network than this, if it has one: its choice, or its second attitude. The choice
// also counts if it is not quite the same: the pose may be beside the right one.
Alternative alternative_to(const Matrix3<Fixed>& r_lrf_trf, const PoseFrame& frame) {
  const Matrix3<Fixed>& choice = frame.network.r_lrf_trf;
  if (is_another_attitude(r_lrf_trf, choice)) return {choice, true, true};
  if (offers_second(r_lrf_trf, frame)) return {frame.second_r_lrf_trf, true, false};
  return {choice, differs(r_lrf_trf, choice, kTraceOf6Degrees), true};
}

bool are_whole(const PoseCandidate& a, const PoseCandidate& b) {
  return a.refinement.is_complete && b.refinement.is_complete;
}

// Whether a pose can be used and explains the frame.
bool explains(const PoseCandidate& candidate) {
  return candidate.refinement.is_complete && candidate.evidence.fits();
}

// Log-likelihood ratio of the first to the second by this frame, limited. One that was not drawn whole says
// nothing, except that it cannot be used: then a second one that was, and that explains the frame, is taken.
std::int32_t llr_q8(const PoseCandidate& first, const PoseCandidate& second) {
  if (are_whole(first, second))
    return clamp<std::int32_t>(second.evidence.cost_q8() - first.evidence.cost_q8(), -kMostOfAFrame_q8,
                               kMostOfAFrame_q8);
  return explains(second) ? -kMostOfAFrame_q8 : 0;
}

// What a frame says for the pose of the track against the alternatives [nats, Q8].
struct LogLikelihoodRatio {
  std::int32_t full_q8;          // by the costs: which of them the track follows
  std::int32_t conservative_q8;  // no more than is proven: whether it is verified
};
constexpr LogLikelihoodRatio kWithoutAlternative{kWithoutAlternative_q8, kWithoutAlternative_q8};
// Against the track where the network disagrees, per frame.
constexpr LogLikelihoodRatio kNetworkDisagrees{-1 * 256, -4 * 256};

// How much of the log-likelihood ratio of the first pose to the second one is proven. A negative one counts
// in full. If the second pose explains the frame, the difference of the costs counts up to six nats. It is
// divided by 2^fit_shift before that, since a pose that was registered shortly costs more. If the second pose
// does not explain the frame, it may be the right attitude whose refinement went astray, so only a 32nd
// counts. With more rays its misfit is larger, but then a wrong first pose would be a misfit, too.
std::int32_t conservative_llr_q8(const PoseCandidate& first, const PoseCandidate& second, int fit_shift) {
  const std::int32_t better_q8 = llr_q8(first, second);
  if (better_q8 <= 0) return better_q8;
  const std::int32_t difference_q8 = second.evidence.cost_q8() - first.evidence.cost_q8();
  return second.evidence.fits() ? min(difference_q8 >> fit_shift, kMostByAFit_q8)
                                : min(difference_q8 >> kMisfitShift, kMostOfAFrame_q8);
}

void add_llr(const LogLikelihoodRatio& llr, PoseTrackerState& state) {
  state.llr_q8 = limited_llr_q8(state.llr_q8 + llr.full_q8);
  state.conservative_llr_q8 = limited_llr_q8(state.conservative_llr_q8 + llr.conservative_q8);
}

// What the network's odds say for its first attitude against its second one [nats, Q8], limited.
std::int32_t network_llr_q8(std::uint32_t second_odds_ppm) {
  constexpr std::int32_t kNatsPerBit_q8 = 177;
  const int bits_below_one = 20 - highest_bit(second_odds_ppm);
  return clamp<std::int32_t>(bits_below_one * kNatsPerBit_q8, -kMostOfNetwork_q8, kMostOfNetwork_q8);
}

// Of the first frames, whose second attitude is registered shortly. `network_q8`: what the network says for
// the first pose.
LogLikelihoodRatio first_llr(const PoseCandidate& first, const PoseCandidate& second,
                             std::int32_t network_q8) {
  return {llr_q8(first, second) + network_q8,
          conservative_llr_q8(first, second, kShortFitShift) + network_q8};
}

// Whether the budget is expected to cover a refinement of so many steps, drawn anew: each as dear as the
// dearest one of this frame so far.
bool covers(const PoseScratch& scratch, int steps) {
  const RefinementScratch& refinement = scratch.refinement;
  return refinement.budget.covers(std::int64_t{steps + kStepsOfDrawing} * refinement.dearest_step);
}
// The same at another attitude, where surfaces may be dark. A step then takes about 5/3 of one without.
bool covers_elsewhere(const PoseScratch& scratch, int steps) {
  const bool may_be_dearer = !scratch.refinement.surface.has_dark;
  return covers(scratch, may_be_dearer ? steps * 5 / 3 + 1 : steps);
}

// As many steps of the search as the budget covers, at most all; zero: it covers none.
RefinementSettings covered(const PoseScratch& scratch, RefinementSettings search) {
  while (search.steps > 0 && !covers(scratch, search.steps)) --search.steps;
  return search;
}

// Goes on with the candidate that was refined last, with the surface drawn anew if `is_anew`. What the budget
// does not cover after all is not used.
void improve(const PoseTarget& target, const RefinementSettings& settings, bool is_anew,
             PoseScratch& scratch) {
  if (!covers(scratch, settings.steps)) return;
  scratch.other = scratch.best;
  go_on(target, settings, is_anew, scratch, scratch.best);
  if (!scratch.refinement.budget.end_part()) scratch.best = scratch.other;
}

// Registers the frame at the pose that the motion of the track predicts. After a gap, or if a short
// registration does not explain the frame, in more steps.
void follow_motion(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                   const PoseTrackerState& state) {
  PoseCandidate& best = scratch.best;
  const Pose start{state.motion.turning.r_lrf_trf, state.motion.origin_lrf_um};
  const bool is_short = state.history.count >= kPosesOfARate && frame.elapsed_ns <= kLongestStep_ns;
  refine_candidate(target, start, is_short ? kLongTrack : kTracked, scratch, best);
  if (is_short && !best.evidence.fits()) improve(target, kTrackedFurther, false, scratch);
}

// A frame that the track does not explain is registered at the network's attitude too, and the pose that
// explains it better stays. False: the budget did not cover it.
bool search_at_network(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch) {
  PoseCandidate& best = scratch.best;
  PoseCandidate& other = scratch.other;
  if (!covers_elsewhere(scratch, kSearch.steps + kStepsOfPlacement)) return false;
  refine_candidate(target, placed(target, frame, frame.network.r_lrf_trf, scratch), kSearch, scratch, other);
  if (!scratch.refinement.budget.end_part()) return false;
  if (llr_q8(best, other) < 0) exchange(best, other);
  return true;
}

// Registers an attitude of the network at the position of the track, shortly if the budget covers no more,
// and sets what the frame says for the pose of the track. False: the budget did not cover it.
bool compare(const PoseTarget& target, const Alternative& alternative, PoseScratch& scratch,
             LogLikelihoodRatio& llr) {
  const PoseCandidate& best = scratch.best;
  const PoseCandidate& other = scratch.other;
  if (!covers_elsewhere(scratch, kShortSearch.steps)) return false;
  const Pose start{alternative.r_lrf_trf, best.refinement.pose.origin_lrf_um};
  const bool is_short = !covers_elsewhere(scratch, kSearch.steps);
  const RefinementSettings& whole = best.evidence.fits() ? kFull : kSearch;
  refine_candidate(target, start, is_short ? kShortSearch : whole, scratch, scratch.other);
  if (!scratch.refinement.budget.end_part()) return false;
  if (!differs(best.refinement.pose.r_lrf_trf, other.refinement.pose.r_lrf_trf, kTraceOf2Degrees))
    return true;
  llr = {llr_q8(best, other), conservative_llr_q8(best, other, is_short ? kShortFitShift : kFitShift)};
  if (alternative.is_network) {
    llr.full_q8 += kNetworkDisagrees.full_q8;
    llr.conservative_q8 += kNetworkDisagrees.conservative_q8;
  }
  return true;
}

}  // namespace

bool is_another_attitude(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b) {
  return differs(a, b, kTraceOf20Degrees);
}

std::int32_t limited_llr_q8(std::int32_t llr_q8) {
  return clamp(llr_q8, -kMostOfATrack_q8, kMostOfATrack_q8);
}

void start_track(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                 PoseTrackerState& state) {
  state.owes_comparison = 0;
  PoseCandidate& best = scratch.best;
  PoseCandidate& other = scratch.other;
  const bool has_second = offers_second(frame.network.r_lrf_trf, frame);
  if (has_second)
    refine_candidate(target, placed(target, frame, frame.second_r_lrf_trf, scratch), kFirstSecond, scratch,
                     other);
  refine_candidate(target, placed(target, frame, frame.network.r_lrf_trf, scratch), kFirst, scratch, best);
  LogLikelihoodRatio llr = kWithoutAlternative;
  if (has_second) llr = first_llr(best, other, network_llr_q8(frame.second_odds_ppm));
  const bool is_second = llr.full_q8 < -kClear_q8;
  if (is_second) {
    llr = {0, 0};
    if (are_whole(best, other)) llr = first_llr(other, best, -network_llr_q8(frame.second_odds_ppm));
    best = other;
    // The pose before, if any, is of the other attitude.
    state.history.count = 0;
  }
  // What spoke for another attitude does not speak for this one.
  const bool goes_on = state.history.count > 0 &&
                       !is_another_attitude(best.refinement.pose.r_lrf_trf, state.motion.turning.r_lrf_trf);
  if (!goes_on) state.llr_q8 = state.conservative_llr_q8 = 0;
  add_llr(llr, state);
  // Where surfaces are dark and the frame is not explained, the attitude may be far off: the search follows
  // at once, so that the first frame with dark surfaces takes no more steps than one without.
  const bool is_dark = best.evidence.dark_surfaces > 0, is_explained = best.evidence.fits();
  if (!is_dark || is_explained) {
    improve(target, covers(scratch, kFull.steps) ? kFull : kShortFull, is_second, scratch);
    if (is_dark || best.evidence.fits()) return;
  }
  const RefinementSettings search = covered(scratch, kLongSearch);
  if (search.steps == 0) return;
  other = best;
  go_on(target, search, is_second && is_dark, scratch, best);
  if (!scratch.refinement.budget.end_part() || llr_q8(best, other) < 0) exchange(best, other);
}

bool follow_track(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                  PoseTrackerState& state) {
  PoseCandidate& best = scratch.best;
  const PoseCandidate& other = scratch.other;
  follow_motion(target, frame, scratch, state);
  // Another attitude than the track's is compared with it as an alternative. Where the budget does not cover
  // the search and the comparison, they take turns.
  const bool is_turn_of_comparison = state.owes_comparison != 0 &&
                                     alternative_to(best.refinement.pose.r_lrf_trf, frame).exists &&
                                     !covers_elsewhere(scratch, kStepsOfSearchAndComparison);
  const bool searches = !best.evidence.fits() && !is_turn_of_comparison &&
                        !is_another_attitude(best.refinement.pose.r_lrf_trf, frame.network.r_lrf_trf);
  const bool has_searched = searches && search_at_network(target, frame, scratch);
  const Alternative alternative = alternative_to(best.refinement.pose.r_lrf_trf, frame);
  const bool was_tried = has_searched && alternative.is_network;
  LogLikelihoodRatio llr = kWithoutAlternative;
  scratch.is_uncompared = alternative.exists && !was_tried && !compare(target, alternative, scratch, llr);
  if (scratch.is_uncompared) llr = alternative.is_network ? kNetworkDisagrees : LogLikelihoodRatio{0, 0};
  state.owes_comparison = scratch.is_uncompared && !is_turn_of_comparison ? 1 : 0;
  if (!explains(best)) llr.conservative_q8 = min(llr.conservative_q8, 0);
  add_llr(llr, state);
  // A pose that this frame speaks against is not taken, whatever spoke against the track before.
  if (llr.full_q8 >= 0 || scratch.is_uncompared) return true;
  const bool were_compared = are_whole(best, other);
  const bool is_lost = !explains(best) && explains(other);
  if (state.llr_q8 >= 0 && !is_lost) return true;
  best = other;
  state.llr_q8 = were_compared ? abs(state.llr_q8) : 0;
  state.conservative_llr_q8 = 0;
  state.history.count = 0;
  return false;
}

}  // namespace tumblesight::gnc
