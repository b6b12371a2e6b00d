// Disturbances: what goes wrong while the target is observed, under any condition: frames that are lost or
// frozen, a sensor with another period, a chaser that turns. The table below is the only place that lists
// them: command line, reports and files of results follow it. make_sequence() applies them.
//
// To add a disturbance: a member and its row here, its effect in disturbance.cpp, and its test in
// tests/unit/sim/world/scenario.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/math/random.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

inline constexpr double kFramePeriod_s = 2.7;  // paper, sampling
inline constexpr std::int64_t kFramePeriod_ns = 2'700'000'000;

struct Disturbances {
  std::uint32_t lost_frames = 0;
  std::uint32_t loss_every = 0;  // 0: off
  double loss_share = 0.0;       // 0..1
  std::uint32_t frozen = 0;      // frames
  std::uint32_t well_frames = 1;
  double period_s = kFramePeriod_s;
  double period_jitter = 0.0;  // 0..1
  double chaser_rate_deg_s = 0.0;
  bool no_ego_motion = false;
};

enum class DisturbanceKind { kWholeNumber, kNumber, kFlag };

struct DisturbanceRow {
  const char* name;  // of the option, without its dashes, and in files
  const char* type_name;
  const char* explanation;  // one line, for help texts
  DisturbanceKind kind;
  double lowest;  // limits of a value that is given
  double highest;
  double (*get)(const Disturbances&);
  void (*set)(Disturbances&, double);
};

template <auto member>
double disturbance_value(const Disturbances& disturbances) {
  return static_cast<double>(disturbances.*member);
}
template <auto member>
void set_disturbance(Disturbances& disturbances, double value) {
  auto& target = disturbances.*member;
  target = static_cast<std::remove_reference_t<decltype(target)>>(value);
}
template <auto member>
constexpr DisturbanceRow disturbance_row(const char* name, const char* type_name, const char* explanation,
                                         DisturbanceKind kind, double lowest, double highest) {
  return {name,
          type_name,
          explanation,
          kind,
          lowest,
          highest,
          disturbance_value<member>,
          set_disturbance<member>};
}

// clang-format off
inline const DisturbanceRow kDisturbances[] = {
    disturbance_row<&Disturbances::lost_frames>("lost-frames", "N",
        "the N frames before the last are lost",
        DisturbanceKind::kWholeNumber, 0, 999),
    disturbance_row<&Disturbances::loss_every>("loss-every", "N",
        "every Nth frame is lost, counted back from the frame before the last",
        DisturbanceKind::kWholeNumber, 2, 999),
    disturbance_row<&Disturbances::loss_share>("loss-share", "X",
        "each frame but the last is lost with probability X",
        DisturbanceKind::kNumber, 0, 1),
    disturbance_row<&Disturbances::frozen>("frozen", "N",
        "the N frames before the last repeat the one before them, under new numbers and times",
        DisturbanceKind::kWholeNumber, 0, 998),
    disturbance_row<&Disturbances::well_frames>("well-frames", "N",
        "frames at the end that are neither lost nor frozen; with more than one, "
        "\"the last\" above means these",
        DisturbanceKind::kWholeNumber, 1, 1000),
    disturbance_row<&Disturbances::period_s>("period", "S",
        "time between two frames in seconds",
        DisturbanceKind::kNumber, 0.1, 60),
    disturbance_row<&Disturbances::period_jitter>("period-jitter", "X",
        "each time between two frames differs from the period by up to this share, uniformly",
        DisturbanceKind::kNumber, 0, 0.9),
    disturbance_row<&Disturbances::chaser_rate_deg_s>("chaser-rate", "DEG_S",
        "the chaser turns about a random fixed axis and keeps the target on the boresight, as in an orbit around it",
        DisturbanceKind::kNumber, 0, 20),
    disturbance_row<&Disturbances::no_ego_motion>("no-ego-motion", "",
        "the estimator is not told the chaser's attitude",
        DisturbanceKind::kFlag, 0, 1),
};
// clang-format on

// The rows whose value differs from that of an undisturbed run, in the order of the table.
std::vector<const DisturbanceRow*> given_disturbances(const Disturbances& disturbances);
// "lost-frames 1, period 1.5"; empty for an undisturbed run.
std::string to_string(const Disturbances& disturbances);

// Throws std::invalid_argument that names option, value and remedy if a sequence of `frames` frames is too
// short for the disturbances, if one of them hits no frame, or if frames can be too close to each other for
// the flight program.
void require_possible(const Disturbances& disturbances, std::uint32_t frames);

// The times of the exposures in seconds since the first.
std::vector<double> exposure_times_s(const Disturbances& disturbances, std::size_t frames, Random random);

// Marks the frames that are lost and those that a frozen sensor repeats. `random`: for loss_share.
void mark_frames(const Disturbances& disturbances, Random random, std::vector<FrameTruth>& frames);

// Turns the chaser at a constant rate about an axis that is fixed in inertial space and in the chaser. The
// motion of the target in inertial space and its first attitude in the LRF stay what they are:
//   q_lrf_trf(t) = conj(q_inertial_lrf(t)) q_inertial_trf(t)
// The start attitude of the chaser and the axis are drawn. The place of the target in the LRF stays what it
// is, as in an orbit around it. Requires exposure times in `frames`. `swath_m`: of the renderer.
void turn_chaser(double rate_rad_s, Random random, const std::vector<double>& times_s, double swath_m,
                 std::vector<FrameTruth>& frames);

}  // namespace tumblesight::sim
