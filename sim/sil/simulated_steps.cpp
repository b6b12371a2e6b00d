#include "sim/sil/simulated_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "sim/world/chaser_navigation.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kFirstStep_ns = kFramePeriod_ns;  // mission time of step 0
constexpr std::uint32_t kPictureSequences = 3;           // the frames of these are kept

bool turns_its_chaser(const Sequence& sequence) {
  return std::any_of(sequence.frames.begin(), sequence.frames.end(), [&](const FrameTruth& frame) {
    return frame.q_inertial_lrf.coeffs() != sequence.frames[0].q_inertial_lrf.coeffs();
  });
}

}  // namespace

SimulatedSteps::SimulatedSteps(const FlashLidar& lidar, double swath_m,
                               const std::vector<Sequence>& sequences, bool ego_motion)
    : lidar_(lidar),
      renderer_(lidar, swath_m),
      faults_(swath_m),
      sequences_(sequences),
      ego_motion_(ego_motion) {
  for (std::uint32_t s = 0; s < sequences.size(); ++s) {
    const std::int64_t start_ns = plan_.empty() ? kFirstStep_ns : plan_.back().time_ns + kFramePeriod_ns;
    for (std::uint32_t f = 0; f < sequences[s].frames.size(); ++f)
      plan_.push_back({s, f, start_ns + sequences[s].frames[f].time_ns});
  }
  start_rendering(0);
}

SourcedStep SimulatedSteps::next() {
  rendering_.wait();
  if (is_stale_) start_rendering(next_step_);
  rendering_.get();
  is_stale_ = false;
  const std::size_t k = next_step_++;
  start_rendering(next_step_);
  const PlannedStep& plan = plan_[k];
  SourcedStep sourced;
  sourced.step.sequence = plan.sequence;
  sourced.step.frame_index = plan.frame;
  sourced.step.time_ns = plan.time_ns;
  sourced.step.truth =
      faults_.empty() ? sequences_[plan.sequence].frames[plan.frame] : sequence_in(k).frames[plan.frame];
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

void SimulatedSteps::begin_fault(const InjectedFault& fault) {
  if (next_step_ >= plan_.size()) throw std::invalid_argument("the run is at its end");
  const PlannedStep& plan = plan_[next_step_];
  const Sequence& sequence = sequences_[plan.sequence];
  if (fault.name == "turn" && turns_its_chaser(sequence))
    throw std::invalid_argument("fault turn: the chaser of this run turns already");
  if (fault.name == "panel_lobe" && !lidar_.knows_panels())
    throw std::invalid_argument("fault panel_lobe: no solar panels are found on the target's mesh");
  const auto step = static_cast<std::uint32_t>(next_step_);
  rendering_.wait();  // of the frame without the fault
  faults_.begin(fault, step, step - plan.frame, sequence.noise_seed);
  is_stale_ = true;
}

Sequence SimulatedSteps::sequence_in(std::size_t step) const {
  const PlannedStep& plan = plan_[step];
  Sequence sequence = sequences_[plan.sequence];
  faults_.apply(static_cast<std::uint32_t>(step) - plan.frame, plan.frame, sequence);
  return sequence;
}

void SimulatedSteps::start_rendering(std::size_t step) {
  if (step >= plan_.size()) return;
  rendering_ = std::async(std::launch::async, [this, step] { render(step, frames_[step % 2]); });
}

void SimulatedSteps::render(std::size_t step, gnc::RangeImage& frame) const {
  const PlannedStep& plan = plan_[step];
  const Sequence& planned = sequences_[plan.sequence];
  if (planned.frames[plan.frame].lost) return;
  const FrameStamp stamp{static_cast<std::uint32_t>(step), plan.time_ns};
  // A frozen sensor shows an earlier frame as it was seen then.
  const std::uint32_t frozen_for = planned.frames[plan.frame].frozen_for;
  if (faults_.empty())
    renderer_.render(planned, plan.frame, stamp, frame);
  else
    renderer_.render(sequence_in(step - frozen_for), plan.frame - frozen_for, stamp, frame);
}

}  // namespace tumblesight::sim
