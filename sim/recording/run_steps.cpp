#include "sim/recording/run_steps.hpp"

#include <stdexcept>

#include "hal/dds/idl/hello.hpp"
#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

const FrameTruth kUnknownTruth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 0.0};

}  // namespace

RunSteps::RunSteps(const std::string& path)
    : file_(path), sample_(std::make_unique<hal::dds::LidarFrameSample>()) {
  read_run();
  read_steps();
  read_contents();
  require_whole_steps();
}

void RunSteps::read_run() {
  hal::dds::HelloSample hello;
  file_.each(hello, [&](const hal::dds::HelloSample& sample, const McapReader::Entry&) {
    if (sample.role == static_cast<std::uint8_t>(hal::dds::Role::kFlight)) {
      has_flown_ = true;
      if (sample.run_id == run_id_) model_crc32_ = sample.model_crc32;
      return;
    }
    run_id_ = sample.run_id;
    target_ = hal::dds::target_of(sample).text;
  });
  if (target_.empty()) throw std::runtime_error("'" + file_.path() + "' does not say of which target it is");
}

// A run that was cut short lacks the last ones. Those that nobody answered are left out.
void RunSteps::read_steps() {
  hal::dds::StepSample step;
  file_.each(step, [&](const hal::dds::StepSample& sample, const McapReader::Entry&) {
    if (sample.run_id != run_id_) return;
    if (sample.k != steps_.size())
      throw std::runtime_error("'" + file_.path() + "' lacks step " + std::to_string(steps_.size()) +
                               " of the run: only a recording of a whole run can be replayed");
    steps_.emplace_back().sample = sample;
  });
  hal::dds::StepDoneSample done;
  file_.each(done, [&](const hal::dds::StepDoneSample& sample, const McapReader::Entry&) {
    if (RecordedStep* const of = step_of(sample)) of->state_crc32 = sample.state_crc32;
  });
  while (has_flown_ && !steps_.empty() && !steps_.back().state_crc32) steps_.pop_back();
  if (steps_.empty())
    throw std::runtime_error("'" + file_.path() + "' has no step" + (has_flown_ ? " that was answered" : ""));
}

template <class Sample>
RunSteps::RecordedStep* RunSteps::step_of(const Sample& sample) {
  return sample.run_id == run_id_ && sample.k < steps_.size() ? &steps_[sample.k] : nullptr;
}

void RunSteps::read_contents() {
  hal::dds::TruthSample truth;
  file_.each(truth, [&](const hal::dds::TruthSample& sample, const McapReader::Entry&) {
    if (RecordedStep* const step = step_of(sample)) step->truth = sample;
  });
  file_.each(*sample_, [&](const hal::dds::LidarFrameSample& sample, const McapReader::Entry& entry) {
    RecordedStep* const step = step_of(sample);
    if (step == nullptr) return;
    step->frames.push_back(entry);
    ++frames_;
  });
  hal::dds::NavigationSample navigation;
  file_.each(navigation, [&](const hal::dds::NavigationSample& sample, const McapReader::Entry&) {
    if (RecordedStep* const step = step_of(sample)) step->navigations.push_back(attitude_of(sample));
  });
  hal::dds::CommandSample command;
  file_.each(command, [&](const hal::dds::CommandSample& sample, const McapReader::Entry&) {
    if (RecordedStep* const step = step_of(sample)) step->packets.push_back(packet_of(sample));
  });
}

void RunSteps::require_whole_steps() const {
  for (const RecordedStep& step : steps_) {
    if (step.frames.size() != step.sample.frames || step.navigations.size() != step.sample.navigations ||
        step.packets.size() != step.sample.commands)
      throw std::runtime_error("'" + file_.path() + "' lacks samples of step " +
                               std::to_string(step.sample.k) +
                               ": only a recording of a whole run can be replayed");
  }
}

SourcedStep RunSteps::next() {
  const std::uint32_t k = next_++;
  const RecordedStep& step = steps_[k];
  SourcedStep sourced;
  sourced.step.time_ns = sourced.input.time_ns = step.sample.time_ns;
  sourced.step.truth = step.truth ? frame_truth_of(*step.truth) : kUnknownTruth;
  sourced.step.truth.lost = step.frames.empty();
  sourced.step.truth_known = step.truth.has_value();
  if (step.truth) {
    sourced.step.sequence = step.truth->sequence_index;
    sourced.step.frame_index = step.truth->frame_index;
  }
  images_.assign(step.frames.size(), {});
  for (std::size_t i = 0; i < step.frames.size(); ++i) {
    file_.read(step.frames[i], *sample_);
    images_[i] = frame_of(*sample_);
    sourced.input.frames.push_back(&images_[i]);
  }
  sourced.input.navigations = step.navigations;
  sourced.input.packets = step.packets;
  sourced.keep_picture = !step.frames.empty() && is_pictured(frames_sent_, k, steps());
  frames_sent_ += static_cast<std::uint32_t>(step.frames.size());
  return sourced;
}

}  // namespace tumblesight::sim
