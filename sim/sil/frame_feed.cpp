#include "sim/sil/frame_feed.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kFirstStep_ns = kFramePeriod_ns;  // mission time of step 0

}  // namespace

std::vector<PlannedStep> plan_steps(const std::vector<Sequence>& sequences) {
  std::vector<PlannedStep> steps;
  for (std::uint32_t s = 0; s < sequences.size(); ++s) {
    const std::int64_t start_ns = steps.empty() ? kFirstStep_ns : steps.back().time_ns + kFramePeriod_ns;
    for (std::uint32_t f = 0; f < sequences[s].frames.size(); ++f)
      steps.push_back({s, f, start_ns + sequences[s].frames[f].time_ns});
  }
  return steps;
}

FrameFeed::FrameFeed(const FlashLidar& lidar, double swath_m, const std::vector<Sequence>& sequences,
                     const std::vector<PlannedStep>& steps)
    : renderer_(lidar, swath_m), sequences_(sequences), steps_(steps) {
  start_rendering(0);
}

const gnc::RangeImage& FrameFeed::next() {
  rendering_.get();
  const std::size_t step = next_step_++;
  start_rendering(next_step_);
  return frames_[step % 2];
}

void FrameFeed::start_rendering(std::size_t step) {
  if (step >= steps_.size()) return;
  rendering_ = std::async(std::launch::async, [this, step] { render(step, frames_[step % 2]); });
}

void FrameFeed::render(std::size_t step, gnc::RangeImage& frame) const {
  const PlannedStep& plan = steps_[step];
  if (sequences_[plan.sequence].frames[plan.frame].lost) return;
  renderer_.render(sequences_[plan.sequence], plan.frame, {static_cast<std::uint32_t>(step), plan.time_ns},
                   frame);
}

}  // namespace tumblesight::sim
