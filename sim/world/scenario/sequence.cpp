#include "sim/world/scenario/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/world/dynamics/motion.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/scenario/approach.hpp"
#include "sim/world/scenario/draws.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kMaxRate_rad_s = 20.0 * kRadPerDeg;
constexpr double kMinHiddenShare = 0.05;
constexpr double kMaxHiddenShare = 0.30;
constexpr double kNsPerS = 1e9;

// Uniform components, drawn until the norm is within the limit.
Eigen::Vector3d uniform_rate(Random& random) {
  Eigen::Vector3d rate;
  do {
    for (int i = 0; i < 3; ++i) rate[i] = random.uniform(-kMaxRate_rad_s, kMaxRate_rad_s);
  } while (rate.norm() > kMaxRate_rad_s);
  return rate;
}

// Every purpose has a stream of its own, so that a new draw does not change the others.
Random stream_for(std::uint64_t seed, std::uint64_t index, std::uint64_t purpose) {
  return Random(mix(mix(seed, index), purpose));
}

Eigen::Vector3d apply_rate_settings(const ScenarioSettings& settings, Eigen::Vector3d rate, Random random) {
  const double largest_rad_s = settings.ranges.largest_rate_deg_s * kRadPerDeg;
  rate *= largest_rad_s / kMaxRate_rad_s;
  if (settings.rate_distribution == RateDistribution::kNorm)
    rate *= largest_rad_s * random.uniform() / rate.norm();
  if (settings.rate_rad_s) rate *= *settings.rate_rad_s / rate.norm();
  return rate;
}

// The time from a frame to the next. Without jitter it is the period itself, not a difference of rounded
// times.
double interval_s(const Disturbances& disturbances, const std::vector<double>& times_s, std::size_t frame) {
  if (disturbances.period_jitter == 0.0 || frame + 1 >= times_s.size()) return disturbances.period_s;
  return times_s[frame + 1] - times_s[frame];
}

void rotate_freely(const ScenarioSettings& settings, const std::vector<double>& times_s,
                   std::vector<FrameTruth>& frames) {
  Eigen::Matrix3d inertia = settings.inertia_kg_m2;
  inertia(2, 2) *= row_of(settings.condition).inertia_zz_factor;
  const Tumble tumble(inertia);
  TumbleState state{frames.front().q_lrf_trf,
                    frames.front().q_lrf_trf.conjugate() * frames.front().rate_lrf_rad_s};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].q_lrf_trf = state.q_lrf_trf;
    frames[k].rate_lrf_rad_s = state.q_lrf_trf * state.rate_trf_rad_s;
    state = tumble.after(state, interval_s(settings.disturbances, times_s, k));
  }
}

// One occluder for the whole sequence. Its side and its axis move at constant speed.
void add_occluder(const ScenarioSettings& settings, Random random, std::vector<FrameTruth>& frames) {
  constexpr std::array<OccluderShape, 3> kShapes{OccluderShape::kArm, OccluderShape::kMast,
                                                 OccluderShape::kPanelEdge};
  Occluder occluder;
  occluder.shape = kShapes[random.next() % kShapes.size()];
  const double drawn_share = random.uniform(kMinHiddenShare, kMaxHiddenShare);
  occluder.hidden_share = settings.hidden_share.value_or(drawn_share);
  occluder.distance_m = random.uniform(1.5, 8.0);
  const double side_rad = random.uniform(0.0, 2.0 * kPi);
  const double turn_rad = random.uniform(-0.15, 0.15);
  const double first_across = random.uniform(0.15, 0.85);
  const double last_across = random.uniform(0.15, 0.85);
  const double steps = std::max<double>(1.0, static_cast<double>(frames.size()) - 1.0);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const double time = static_cast<double>(k);
    occluder.side_rad = side_rad + turn_rad * time;
    occluder.across = first_across + (last_across - first_across) * time / steps;
    frames[k].occluder = occluder;
  }
}

void move_off_boresight(double max_offset_swaths, Random random, std::vector<FrameTruth>& frames) {
  const double angle_rad = random.uniform(0.0, 2.0 * kPi);
  const double offset_swaths = random.uniform(0.0, max_offset_swaths);
  for (FrameTruth& frame : frames) {
    frame.offset_swaths = offset_swaths * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  }
}

void require_one_turn(const ScenarioSettings& settings) {
  if (!row_of(settings.condition).approaches || settings.disturbances.chaser_rate_deg_s == 0.0) return;
  throw std::invalid_argument(fmt::format(
      "--chaser-rate {:g} does not go with the condition {}, which turns the chaser itself: leave "
      "it out, or choose another --condition",
      settings.disturbances.chaser_rate_deg_s, to_string(settings.condition)));
}

ApproachLimits approach_limits(const ScenarioSettings& settings) {
  ApproachLimits limits;
  limits.swath_m = settings.swath_m;
  limits.start_m = settings.range_m;
  if (settings.ranges.are_the_papers()) return limits;
  limits.nearest_m = settings.ranges.nearest_m;
  limits.farthest_m = settings.ranges.farthest_m;
  return limits;
}

}  // namespace

std::string to_string(const RangeLimits& ranges) {
  const std::string lengths = fmt::format("{} to {} m", ranges.nearest_m, ranges.farthest_m);
  if (ranges.largest_rate_deg_s == RangeLimits{}.largest_rate_deg_s) return lengths;
  return fmt::format("{}, at most {} deg/s", lengths, ranges.largest_rate_deg_s);
}

ScenarioSettings scenario_settings(Condition condition, std::uint32_t frames, const std::string& target,
                                   const std::optional<Eigen::Matrix3d>& inertia_kg_m2) {
  if (needs_inertia(condition) && !inertia_kg_m2) {
    throw std::invalid_argument("condition " + to_string(condition) + " needs the inertia of '" + target +
                                "', which is not known: give --inertia Ixx,Iyy,Izz,Ixy,Ixz,Iyz in kg m2");
  }
  ScenarioSettings settings;
  settings.condition = condition;
  settings.frames = static_cast<int>(frames);
  if (inertia_kg_m2) settings.inertia_kg_m2 = *inertia_kg_m2;
  return settings;
}

Sequence make_sequence(const ScenarioSettings& settings, std::uint64_t seed, std::uint64_t index) {
  const Disturbances& disturbances = settings.disturbances;
  require_possible(disturbances, static_cast<std::uint32_t>(settings.frames));
  require_one_turn(settings);
  Random random(mix(seed, index));
  const Eigen::Quaterniond q0 = uniform_attitude(random);
  const Eigen::Vector3d drawn_rate = uniform_rate(random);
  const Eigen::Vector3d rate = apply_rate_settings(settings, drawn_rate, stream_for(seed, index, 1));
  const double drawn_range_m = random.uniform(settings.ranges.nearest_m, settings.ranges.farthest_m);
  const double range_m = settings.range_m.value_or(drawn_range_m);

  Sequence sequence;
  sequence.condition = settings.condition;
  sequence.effects = drawn(settings.effects, stream_for(seed, index, 7).next());
  sequence.sensor = settings.sensor;
  sequence.noise_seed = random.next();
  const std::vector<double> times_s =
      exposure_times_s(disturbances, static_cast<std::size_t>(settings.frames), stream_for(seed, index, 4));
  sequence.frames.reserve(times_s.size());
  for (const double time_s : times_s) {
    sequence.frames.push_back({spin(q0, rate, time_s), rate, range_m});
    sequence.frames.back().time_ns = std::llround(kNsPerS * time_s);
    sequence.frames.back().scene_seed = mix(sequence.noise_seed);
  }
  const ConditionRow& condition = row_of(settings.condition);
  if (condition.rotation == RotationModel::kTorqueFree) rotate_freely(settings, times_s, sequence.frames);
  if (condition.occluded) add_occluder(settings, stream_for(seed, index, 2), sequence.frames);
  if (condition.max_offset_swaths > 0.0) {
    move_off_boresight(condition.max_offset_swaths, stream_for(seed, index, 3), sequence.frames);
  }
  mark_frames(disturbances, stream_for(seed, index, 5), sequence.frames);
  if (condition.approaches) {
    close_in(approach_limits(settings), stream_for(seed, index, 8), times_s, sequence.frames);
  }
  if (disturbances.chaser_rate_deg_s > 0.0) {
    turn_chaser(kRadPerDeg * disturbances.chaser_rate_deg_s, stream_for(seed, index, 6), times_s,
                settings.swath_m, sequence.frames);
  }
  return sequence;
}

}  // namespace tumblesight::sim
