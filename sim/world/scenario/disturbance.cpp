#include "sim/world/scenario/disturbance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "gnc/rcnn/attitude_track.hpp"
#include "sim/world/dynamics/motion.hpp"
#include "sim/world/scenario/draws.hpp"

namespace tumblesight::sim {
namespace {

[[noreturn]] void refuse(const char* option, std::uint32_t value, std::uint32_t frames,
                         const Disturbances& disturbances, std::uint32_t most) {
  throw std::invalid_argument(fmt::format(
      "--{} {} is too many for --frames {} with --well-frames {}: give at most {}, or more --frames", option,
      value, frames, disturbances.well_frames, most));
}

// A number of frames is refused by its limit.
void require_frame_to_lose(const Disturbances& disturbances, std::uint32_t frames) {
  const bool loses = disturbances.loss_every > 0 || disturbances.loss_share > 0.0;
  if (!loses || disturbances.well_frames < frames) return;
  throw std::invalid_argument(fmt::format(
      "--{} has no effect: with --frames {} and --well-frames {} no frame can be lost; give more "
      "--frames, or fewer --well-frames",
      disturbances.loss_every > 0 ? "loss-every" : "loss-share", frames, disturbances.well_frames));
}

void require_frozen_frame(const Disturbances& disturbances, std::uint32_t frames) {
  if (disturbances.frozen == 0) return;
  Disturbances certain = disturbances;
  if (certain.loss_share < 1.0) certain.loss_share = 0.0;
  std::vector<FrameTruth> marked(frames);
  mark_frames(certain, Random(0), marked);
  const bool delivered = std::any_of(marked.begin(), marked.end(), [](const FrameTruth& frame) {
    return frame.frozen_for > 0 && !frame.lost;
  });
  if (delivered) return;
  throw std::invalid_argument(
      fmt::format("--frozen {} has no effect: every frozen frame is lost; freeze more frames, or lose fewer",
                  disturbances.frozen));
}

// The flight program refuses a frame that comes sooner.
constexpr double kShortestInterval_s = 1e-9 * static_cast<double>(gnc::kShortestInterval_ns);
constexpr double kRounding = 1e-9;

void require_frames_far_enough_apart(const Disturbances& disturbances) {
  const double share = 1.0 - disturbances.period_jitter;
  const double shortest_s = disturbances.period_s * share;
  if (shortest_s >= kShortestInterval_s * (1.0 - kRounding)) return;
  throw std::invalid_argument(fmt::format(
      "--period {:g} with --period-jitter {:g} has frames {:.3g} s apart; the flight program refuses frames "
      "less than {:g} s apart: give at least --period {:.3g}, or a smaller --period-jitter",
      disturbances.period_s, disturbances.period_jitter, shortest_s, kShortestInterval_s,
      kShortestInterval_s / share));
}

}  // namespace

std::vector<const DisturbanceRow*> given_disturbances(const Disturbances& disturbances) {
  std::vector<const DisturbanceRow*> given;
  for (const DisturbanceRow& row : kDisturbances) {
    if (row.get(disturbances) != row.get(Disturbances{})) given.push_back(&row);
  }
  return given;
}

std::string to_string(const Disturbances& disturbances) {
  std::string text;
  for (const DisturbanceRow* row : given_disturbances(disturbances)) {
    text += (text.empty() ? "" : ", ") + std::string(row->name);
    if (row->kind != DisturbanceKind::kFlag) text += fmt::format(" {:g}", row->get(disturbances));
  }
  return text;
}

void require_possible(const Disturbances& disturbances, std::uint32_t frames) {
  const std::uint32_t well = disturbances.well_frames;
  if (well > frames) {
    throw std::invalid_argument(
        fmt::format("--well-frames {} is too many for --frames {}: give at most {}, or more --frames", well,
                    frames, frames));
  }
  const std::uint32_t before = frames - well;
  if (disturbances.lost_frames > before) {
    refuse("lost-frames", disturbances.lost_frames, frames, disturbances, before);
  }
  // One frame before them, which they repeat.
  const std::uint32_t most_frozen = before > 0 ? before - 1 : 0;
  if (disturbances.frozen > most_frozen) {
    refuse("frozen", disturbances.frozen, frames, disturbances, most_frozen);
  }
  require_frame_to_lose(disturbances, frames);
  require_frozen_frame(disturbances, frames);
  require_frames_far_enough_apart(disturbances);
}

std::vector<double> exposure_times_s(const Disturbances& disturbances, std::size_t frames, Random random) {
  std::vector<double> times_s(frames, 0.0);
  double late_s = 0.0;  // sum of the jitter so far
  for (std::size_t k = 1; k < frames; ++k) {
    const double share = random.uniform(-disturbances.period_jitter, disturbances.period_jitter);
    late_s += share * disturbances.period_s;
    times_s[k] = disturbances.period_s * static_cast<double>(k) + late_s;
  }
  return times_s;
}

void mark_frames(const Disturbances& disturbances, Random random, std::vector<FrameTruth>& frames) {
  if (disturbances.well_frames >= frames.size()) return;
  const std::size_t end = frames.size() - disturbances.well_frames;  // of the frames that can be hit
  for (std::size_t k = 0; k < end; ++k) {
    FrameTruth& frame = frames[k];
    const std::size_t back = end - k;  // 1: the last that can be hit
    frame.lost = random.uniform() < disturbances.loss_share || back <= disturbances.lost_frames ||
                 (disturbances.loss_every > 0 && (back - 1) % disturbances.loss_every == 0);
    if (back <= disturbances.frozen) {
      frame.frozen_for = static_cast<std::uint32_t>(disturbances.frozen - back + 1);
    }
  }
}

void turn_chaser(double rate_rad_s, Random random, const std::vector<double>& times_s, double swath_m,
                 std::vector<FrameTruth>& frames) {
  const Eigen::Quaterniond q_inertial_start = uniform_attitude(random);
  const Eigen::Vector3d rate_inertial_rad_s =
      rate_rad_s * (uniform_attitude(random) * Eigen::Vector3d::UnitX());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    FrameTruth& frame = frames[k];
    frame.q_inertial_lrf = spin(q_inertial_start, rate_inertial_rad_s, times_s[k]);
    const Eigen::Quaterniond q_lrf_start = frame.q_inertial_lrf.conjugate() * q_inertial_start;
    frame.q_lrf_trf = (q_lrf_start * frame.q_lrf_trf).normalized();
    frame.rate_lrf_rad_s = q_lrf_start * frame.rate_lrf_rad_s;
    const Eigen::Vector3d origin_lrf_m(swath_m * frame.offset_swaths.x(), frame.range_m,
                                       swath_m * frame.offset_swaths.y());
    // The same in the LRF at every time: the axis is fixed in it.
    const Eigen::Vector3d chaser_rate_lrf_rad_s = frame.q_inertial_lrf.conjugate() * rate_inertial_rad_s;
    frame.velocity_lrf_m_s = chaser_rate_lrf_rad_s.cross(origin_lrf_m);
  }
}

}  // namespace tumblesight::sim
