#include "sim/sil/simulated_steps.hpp"

#include "sim/world/chaser_navigation.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kFirstStep_ns = kFramePeriod_ns;  // mission time of step 0
constexpr std::uint32_t kPictureSequences = 3;           // the frames of these are kept

}  // namespace

SimulatedSteps::SimulatedSteps(const FlashLidar& lidar, double swath_m,
                               const std::vector<Sequence>& sequences, bool ego_motion)
    : renderer_(lidar, swath_m), sequences_(sequences), ego_motion_(ego_motion) {
  for (std::uint32_t s = 0; s < sequences.size(); ++s) {
    const std::int64_t start_ns = plan_.empty() ? kFirstStep_ns : plan_.back().time_ns + kFramePeriod_ns;
    for (std::uint32_t f = 0; f < sequences[s].frames.size(); ++f)
      plan_.push_back({s, f, start_ns + sequences[s].frames[f].time_ns});
  }
  start_rendering(0);
}

SourcedStep SimulatedSteps::next() {
  rendering_.get();
  const std::size_t k = next_step_++;
  start_rendering(next_step_);
  const PlannedStep& plan = plan_[k];
  SourcedStep sourced;
  sourced.step.sequence = plan.sequence;
  sourced.step.frame_index = plan.frame;
  sourced.step.time_ns = plan.time_ns;
  sourced.step.truth = truth_of(plan);
  sourced.input.time_ns = plan.time_ns;
  if (plan.frame == 0) sourced.input.commands.push_back(reset_sequence());
  if (sourced.step.truth.lost) return sourced;
  const gnc::RangeImage& frame = frames_[k % 2];
  sourced.input.frames = {&frame};
  if (ego_motion_)
    sourced.input.navigations = {chaser_attitude(sourced.step.truth, frame.exposure_time_ns, true)};
  sourced.keep_picture = plan.sequence < kPictureSequences;
  return sourced;
}

void SimulatedSteps::start_rendering(std::size_t step) {
  if (step >= plan_.size()) return;
  rendering_ = std::async(std::launch::async, [this, step] { render(step, frames_[step % 2]); });
}

void SimulatedSteps::render(std::size_t step, gnc::RangeImage& frame) const {
  const PlannedStep& plan = plan_[step];
  if (truth_of(plan).lost) return;
  renderer_.render(sequences_[plan.sequence], plan.frame, {static_cast<std::uint32_t>(step), plan.time_ns},
                   frame);
}

}  // namespace tumblesight::sim
