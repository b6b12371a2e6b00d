#include "gnc/registration/pose_fit.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// The longest part of a propagation: its error grows with the cube of the turn.
constexpr std::int32_t kTurnOfPart = (1 << 24) * 3 / 20;  // [rad], Q24
constexpr int kPartsOfPeriod = 4;                         // at most; each takes four steps
constexpr int kUnknownMotions = 6;                        // turn and rate
constexpr int kProbeBits = 17;                            // differences for the derivatives: 2^-7 rad

using Jacobian = std::array<std::array<std::int32_t, kUnknownMotions>, 3>;  // of a turn, Q24

Motion<Fixed> reversed(const Motion<Fixed>& motion) {
  return {motion.r_lrf_trf, {-motion.rate_lrf.x(), -motion.rate_lrf.y(), -motion.rate_lrf.z()}};
}

// In which a time is propagated, at so many per period or part of it.
int parts_of(std::int64_t elapsed_ns, std::int64_t parts_per_period) {
  return static_cast<int>(
      clamp<std::int64_t>(divide(elapsed_ns * parts_per_period + kNominalPeriod_ns - 1, kNominalPeriod_ns), 1,
                          std::int64_t{kMaxPeriods} * kPartsOfPeriod));
}

// That are short enough for the rate.
int parts_of(std::int64_t elapsed_ns, const Vector3<Fixed>& rate_lrf) {
  std::int64_t rate = 0;
  for (int i = 0; i < 3; ++i) rate += abs(rate_lrf[i].raw());
  return parts_of(elapsed_ns, clamp<std::int64_t>(divide(rate, kTurnOfPart) + 1, 1, kPartsOfPeriod));
}

Motion<Fixed> propagated(Motion<Fixed> motion, const Inertia<Fixed>& inertia, std::int64_t elapsed_ns,
                         int parts) {
  const std::int64_t part_ns = divide(elapsed_ns, std::int64_t{parts});
  for (int i = 0; i < parts; ++i) motion = propagate<Fixed>(motion, inertia, part_ns);
  return motion;
}

// Rotation vector of a * b^T, which is small.
Vector3<Fixed> turn_between(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b) {
  return small_rotation_vector<Fixed>(product<Fixed>(a, Matrix3<Fixed>(b.transpose())));
}

// The motion and six others, each with one unknown changed. They only give derivatives, so that they are
// propagated in long parts, all of them alike.
constexpr int kProbes = 7;  // the motion itself and one per unknown
static_assert(kProbes == kUnknownMotions + 1);
using Probes = std::array<Motion<Fixed>, kProbes>;
Probes probes_of(const Motion<Fixed>& motion) {
  Probes probes;
  probes.fill(motion);
  const Fixed step = Fixed::from_raw(1 << kProbeBits);
  for (int i = 0; i < 3; ++i) {
    Vector3<Fixed> turn = Vector3<Fixed>::Zero();
    turn[i] = step;
    probes[i + 1].r_lrf_trf = product<Fixed>(rotation_from_vector<Fixed>(turn), motion.r_lrf_trf);
    probes[i + 4].rate_lrf[i] += step;
  }
  for (Motion<Fixed>& probe : probes) probe = reversed(probe);
  return probes;
}

Jacobian derivatives_of(const Probes& probes) {
  Jacobian jacobian{};
  for (std::size_t i = 0; i < kUnknownMotions; ++i) {
    const Vector3<Fixed> turn = turn_between(probes[i + 1].r_lrf_trf, probes[0].r_lrf_trf);
    for (std::size_t k = 0; k < 3; ++k)
      jacobian[k][i] = static_cast<std::int32_t>(clamp<std::int64_t>(
          turn[static_cast<int>(k)].raw() * (std::int64_t{1} << (24 - kProbeBits)), -(1 << 30), 1 << 30));
  }
  return jacobian;
}

struct MotionEquations {
  std::array<std::int64_t, kMotionElements>& information;  // Q4; where the result has it, to save stack
  std::array<std::int64_t, kMotionUnknowns> gradient;      // Q4
};

constexpr std::int64_t kFarthest_q20 = 16 << 20;  // radii

// From the first exposure to the second one.
std::int64_t time_between(const PoseMeasurement& first, const PoseMeasurement& second) {
  return clamp<std::int64_t>(first.age_ns - second.age_ns, 0, PoseHistory::kOldest_ns);
}

// What one pose says: by how much it differs from the motion, and how an unknown changes that, Q20.
struct PoseRow {
  std::array<std::array<std::int64_t, kMotionUnknowns>, kUnknowns> by_unknown{};
  std::array<std::int64_t, kUnknowns> difference{};
  bool is_near = true;  // false: the turns differ by more than 60 degrees, which no derivative bridges
};

PoseRow row_of(const PoseMeasurement& measurement, const Matrix3<Fixed>& expected_r_lrf_trf,
               const Jacobian& jacobian, const PoseMotion& motion, std::int64_t elapsed_q24,
               std::int32_t radius_um) {
  PoseRow row;
  const Vector3<Fixed> turn = turn_between(measurement.pose.r_lrf_trf, expected_r_lrf_trf);
  row.is_near =
      trace_of_transpose_product<Fixed>(measurement.pose.r_lrf_trf, expected_r_lrf_trf) > Fixed(2.0);
  for (std::size_t k = 0; k < 3; ++k) {
    row.difference[k] = turn[static_cast<int>(k)].raw() >> 4;
    for (std::size_t i = 0; i < kUnknownMotions; ++i) row.by_unknown[k][i] = jacobian[k][i] >> 4;
    const std::int64_t expected_um =
        motion.origin_lrf_um[k] - ((motion.velocity_um_period[k] * elapsed_q24) >> 24);
    const std::int64_t apart_um =
        clamp<std::int64_t>(measurement.pose.origin_lrf_um[k] - expected_um, -100'000'000, 100'000'000);
    row.difference[k + 3] =
        clamp<std::int64_t>(divide(apart_um * (1 << 20), radius_um), -kFarthest_q20, kFarthest_q20);
    row.by_unknown[k + 3][k + 6] = 1 << 20;
    row.by_unknown[k + 3][k + 9] = -(elapsed_q24 >> 4);
  }
  return row;
}

// 1 / (1 + x / 4)^2 of the mean square x of the differences, Q12.
std::int64_t agreement_q12(std::int64_t mean_square_q8) {
  const std::int64_t root_q12 = divide(std::int64_t{1} << 20, 256 + mean_square_q8 / 4);
  return (root_q12 * root_q12) >> 12;
}

constexpr std::int64_t kNoAgreement_q8 = 1 << 24;
constexpr std::int64_t kAgainst_q8 = 16 << 8;

// Adds a pose, with less weight if it differs much; returns its mean square, Q8. `tolerance`: by which the
// mean square is divided for the weight.
std::int64_t add(const PoseRow& row, const std::array<std::int32_t, kElements>& information,
                 std::int64_t tolerance, MotionEquations& equations) {
  if (!row.is_near) return kNoAgreement_q8;
  std::array<std::int64_t, kUnknowns> pull{};  // information * difference, Q4
  std::int64_t square_q8 = 0;
  for (int i = 0; i < kUnknowns; ++i) {
    std::int64_t sum = 0;
    for (int k = 0; k < kUnknowns; ++k)
      sum += (std::int64_t{information[symmetric_element(i, k)]} *
              row.difference[static_cast<std::size_t>(k)]) >>
             20;
    pull[static_cast<std::size_t>(i)] = sum;
    square_q8 += (sum * row.difference[static_cast<std::size_t>(i)]) >> 16;
  }
  const std::int64_t mean_square_q8 =
      divide(clamp<std::int64_t>(square_q8, 0, std::int64_t{1} << 40), kUnknowns);
  const std::int64_t weight_q12 = agreement_q12(divide(mean_square_q8, tolerance));
  for (std::size_t a = 0; a < kMotionUnknowns; ++a) {
    std::array<std::int64_t, kUnknowns> weighted{};  // information * column a, Q4
    for (int i = 0; i < kUnknowns; ++i) {
      std::int64_t sum = 0;
      for (int k = 0; k < kUnknowns; ++k)
        sum += (std::int64_t{information[symmetric_element(i, k)]} *
                row.by_unknown[static_cast<std::size_t>(k)][a]) >>
               20;
      weighted[static_cast<std::size_t>(i)] = (sum * weight_q12) >> 12;
    }
    for (std::size_t b = 0; b <= a; ++b) {
      std::int64_t sum = 0;
      for (std::size_t i = 0; i < kUnknowns; ++i) sum += (weighted[i] * row.by_unknown[i][b]) >> 20;
      equations.information[symmetric_element(static_cast<int>(a), static_cast<int>(b))] += sum;
    }
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < kUnknowns; ++i) sum += (pull[i] * row.by_unknown[i][a]) >> 20;
    equations.gradient[a] += (sum * weight_q12) >> 12;
  }
  return mean_square_q8;
}

// Limits that no target in view reaches: 1 km, and 100 m per period.
constexpr std::int64_t kFarthest_um = 1'000'000'000, kFastest_um_period = 100'000'000;

std::int32_t limited_sum(std::int64_t a, std::int64_t b, std::int64_t most) {
  return static_cast<std::int32_t>(clamp(a + b, -most, most));
}

void move(const std::array<std::int32_t, kMotionUnknowns>& step, std::int32_t radius_um, PoseMotion& motion) {
  Vector3<Fixed> turn;
  for (int i = 0; i < 3; ++i) {
    turn[i] = Fixed::from_raw(step[static_cast<std::size_t>(i)]);
    motion.turning.rate_lrf[i] += Fixed::from_raw(step[i + 3]);
  }
  Matrix3<Fixed>& r = motion.turning.r_lrf_trf;
  r = product<Fixed>(rotation_from_vector<Fixed>(turn), r);
  r = rotation_from_columns<Fixed>(orthonormalize<Fixed>(Vector3<Fixed>(r.col(0)), Vector3<Fixed>(r.col(1))));
  for (std::size_t i = 0; i < 3; ++i) {
    motion.origin_lrf_um[i] =
        limited_sum(motion.origin_lrf_um[i], (step[i + 6] * std::int64_t{radius_um}) >> 24, kFarthest_um);
    motion.velocity_um_period[i] = limited_sum(
        motion.velocity_um_period[i], (step[i + 9] * std::int64_t{radius_um}) >> 24, kFastest_um_period);
  }
}

// The poses that a motion is fitted to, from the newest to the oldest, and by what.
struct FittedPoses {
  FittedPoses(const PoseHistory& of, const Inertia<Fixed>& by, std::int32_t target_radius_um)
      : history(of),
        inertia(by),
        radius_um(target_radius_um),
        newest(static_cast<std::size_t>(clamp(of.count, 1, PoseHistory::kMost)) - 1) {}
  // From a pose to the next later one.
  std::int64_t gap_ns(std::size_t pose) const {
    return pose == newest ? 0 : time_between(history.poses[pose], history.poses[pose + 1]);
  }

  const PoseHistory& history;
  const Inertia<Fixed>& inertia;
  std::int32_t radius_um;
  std::size_t newest;
};

using Derivatives = std::array<Jacobian, PoseHistory::kMost>;

// How turn and rate at the newest pose change the attitude at each pose. At the start of the fit only: the
// motion moves too little for others. False: the budget was exhausted.
bool differentiate(const FittedPoses& poses, const Motion<Fixed>& start, WorkBudget& budget,
                   Derivatives& derivatives) {
  Probes probes = probes_of(start);
  for (std::size_t i = poses.newest + 1; i-- > 0;) {
    const bool is_newest = i == poses.newest;
    const std::int64_t gap_ns = poses.gap_ns(i);
    const int periods = is_newest ? 0 : parts_of(gap_ns, std::int64_t{1});
    if (!budget.spend(work::kFitPose + periods * work::kFitPeriod)) return false;
    if (!is_newest)
      for (Motion<Fixed>& probe : probes) probe = propagate<Fixed>(probe, poses.inertia, gap_ns);
    derivatives[i] = derivatives_of(probes);
  }
  return true;
}

// Of add(), in an iteration before `left` others: poses far from a start with a wrong rate are not wrong yet.
std::int64_t tolerance_before(int left) {
  return left > 2 ? 4096 : left > 1 ? 16 : 1;
}

// Adds all poses, and sets how they agree with the motion of the result. False: the budget was exhausted.
bool add_poses(const FittedPoses& poses, const Derivatives& derivatives, std::int64_t tolerance,
               WorkBudget& budget, MotionEquations& equations, PoseFitResult& result) {
  Motion<Fixed> expected = reversed(result.motion.turning);
  std::int64_t squares_q8 = 0;
  result.against = 0;
  for (std::size_t i = poses.newest + 1; i-- > 0;) {
    const bool is_newest = i == poses.newest;
    const PoseMeasurement& measurement = poses.history.poses[i];
    const std::int64_t gap_ns = poses.gap_ns(i);
    const int parts = is_newest ? 0 : parts_of(gap_ns, expected.rate_lrf);
    if (!budget.spend(work::kIterationPose + parts * work::kIterationPart)) return false;
    if (!is_newest) expected = propagated(expected, poses.inertia, gap_ns, parts);
    const std::int64_t elapsed_q24 =
        divide(time_between(measurement, poses.history.poses[poses.newest]) * (1 << 24), kNominalPeriod_ns);
    const PoseRow row =
        row_of(measurement, expected.r_lrf_trf, derivatives[i], result.motion, elapsed_q24, poses.radius_um);
    const std::int64_t mean_square_q8 = add(row, measurement.information, tolerance, equations);
    if (mean_square_q8 > kAgainst_q8) result.against |= std::uint32_t{1} << i;
    squares_q8 += mean_square_q8;
  }
  result.disagreement_q8 = divide(squares_q8, static_cast<std::int64_t>(poses.newest + 1));
  return true;
}

}  // namespace

PoseMotion later_motion(const PoseMotion& motion, const Inertia<Fixed>& inertia, std::int64_t elapsed_ns,
                        const Matrix3<Fixed>& r_now_last) {
  const std::int64_t limited_ns = clamp<std::int64_t>(elapsed_ns, 0, kLongestPropagation_ns);
  const std::int64_t periods_q24 = divide(limited_ns * (1 << 24), kNominalPeriod_ns);
  PoseMotion later;
  const int parts = parts_of(limited_ns, motion.turning.rate_lrf);
  later.turning = turned<Fixed>(propagated(motion.turning, inertia, limited_ns, parts), r_now_last);
  std::array<std::int32_t, 3> origin_um{};
  for (std::size_t i = 0; i < 3; ++i)
    origin_um[i] = limited_sum(motion.origin_lrf_um[i], (motion.velocity_um_period[i] * periods_q24) >> 24,
                               kFarthest_um);
  later.origin_lrf_um = turned_um(r_now_last, origin_um);
  later.velocity_um_period = turned_um(r_now_last, motion.velocity_um_period);
  return later;
}

std::int32_t work_of_fit(const PoseHistory& history, int iterations) {
  const int known = clamp(history.count, 0, PoseHistory::kMost);
  int periods = 0, parts = 0;
  for (int i = 0; i < known; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int64_t gap_ns =
        i + 1 == known ? clamp<std::int64_t>(history.poses[at].age_ns, 0, PoseHistory::kOldest_ns)
                       : time_between(history.poses[at], history.poses[at + 1]);
    periods += parts_of(gap_ns, std::int64_t{1});
    parts += parts_of(gap_ns, std::int64_t{kPartsOfPeriod});
  }
  const int poses = min(known + 1, PoseHistory::kMost);
  return poses * work::kFitPose + periods * work::kFitPeriod +
         (clamp(iterations, 1, kMostIterations) + 1) *
             (work::kIteration + poses * work::kIterationPose + parts * work::kIterationPart);
}

bool fit_motion(const PoseHistory& history, const Inertia<Fixed>& inertia, std::int32_t target_radius_um,
                const PoseMotion& start, int iterations, WorkBudget& budget, PoseFitResult& result) {
  result.motion = start;
  const FittedPoses poses(history, inertia, target_radius_um);
  Derivatives derivatives{};
  if (!differentiate(poses, start.turning, budget, derivatives)) return false;
  const int last = clamp(iterations, 1, kMostIterations);
  for (int iteration = 0; iteration <= last; ++iteration) {
    if (!budget.spend(work::kIteration)) return false;
    result.information = {};
    MotionEquations equations{result.information, {}};
    // Without a second pose nothing is known of rate and velocity: 1 rad and 1 radius per period.
    for (int i = 0; i < kMotionUnknowns; ++i) equations.information[element(i, i)] = 16;
    if (!add_poses(poses, derivatives, tolerance_before(last - iteration), budget, equations, result))
      return false;
    if (iteration == last) break;
    move(solve<kMotionUnknowns>(equations.information, equations.gradient), target_radius_um, result.motion);
  }
  return true;
}

}  // namespace tumblesight::gnc
