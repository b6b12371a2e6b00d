// RareEvents: how often the last frame of a sequence goes wrong, with the bounds that so many sequences
// allow, and which sequences were the worst.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"

namespace tumblesight::sim {

struct ShareBounds {
  double low = 0.0;   // 0..1
  double high = 1.0;  // 0..1
};
// The exact (Clopper-Pearson) bounds of a share of which `count` in `of` trials were seen: the true share is
// above `low` with probability 97.5 %, and below `high` likewise. 0 and 1 without a trial. Source: Clopper
// and Pearson, "The use of confidence or fiducial limits illustrated in the case of the binomial", 1934.
ShareBounds share_bounds_95(std::size_t count, std::size_t of);

enum class RareEvent { kWrong, kWrongAndValid, kPoseWrong, kPoseVerifiedWrong };

struct RareEventRow {
  RareEvent event;
  const char* key;   // in JSON
  const char* name;  // in tables
  bool (*happened)(const FrameResult&);
  bool of_pose;  // says nothing where the model image has no surface to register
};
const std::vector<RareEventRow>& rare_event_table();

// One last frame.
struct WorstSequence {
  std::uint32_t sequence = 0;  // index for the seed of the run: `simulate --only` replays it
  bool valid = false;          // the report calls the attitude valid
  double error_deg = 0.0;      // of the RCNN
  double pose_deg = 0.0;       // of the registered pose; 180 without one, NaN if no sequence has one
  bool pose_verified = false;
  double range_m = 0.0;
  double rate_deg_s = 0.0;
};

inline constexpr std::size_t kWorstSequences = 20;

struct RareEvents {
  std::size_t of = 0;               // last frames
  std::vector<std::size_t> counts;  // in the order of rare_event_table()
  bool has_poses = false;           // false: no sequence has a registered pose, and their counts say nothing
  // At most kWorstSequences: verified poses more than 5° off first, then wrong attitudes that are valid,
  // poses more than 20° off, and the rest; each by the error of the RCNN.
  std::vector<WorstSequence> worst;
};
// `last`: last frames, see last_frames().
RareEvents rare_events(const std::vector<FrameResult>& last);

// Of 400,000: "2 (0.000061 to 0.0018 %)"
std::string count_text(std::size_t count, std::size_t of);

}  // namespace tumblesight::sim
