#include "fsw/app/cycle.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

void drop(const gnc::RangeImage& frame, gnc::FrameVerdict why, StepInputs& inputs,
          gnc::FrameStatus content = gnc::FrameStatus::kOk) {
  inputs.dropped[static_cast<std::size_t>(inputs.dropped_count++)] = {
      why, frame.sequence_number, frame.exposure_time_ns, content, frame.rays};
}

// Why `later`, which passes the gate, is not taken by its number and time although `kept` does too; kPass: it
// may be taken instead.
gnc::FrameVerdict compare(const gnc::RangeImage& kept, const gnc::RangeImage& later) {
  if (later.sequence_number == kept.sequence_number) return gnc::FrameVerdict::kDuplicate;
  if (later.exposure_time_ns <= kept.exposure_time_ns) return gnc::FrameVerdict::kSuperseded;
  return gnc::FrameVerdict::kPass;
}

// Bad content has to be looked at in full, so after a number of bad frames the rest of the cycle's counts as
// bad too, without a look. This bounds the time of a cycle with a failing sensor.
class Contents {
 public:
  gnc::FrameStatus look_at(const gnc::RangeImage& frame) {
    if (bad_ >= config::kMaxBadContentsPerCycle) return last_bad_;
    const gnc::FrameStatus status = gnc::check_frame(frame);
    if (status != gnc::FrameStatus::kOk) {
      ++bad_;
      last_bad_ = status;
    }
    return status;
  }

 private:
  int bad_ = 0;
  gnc::FrameStatus last_bad_ = gnc::FrameStatus::kOk;
};

static_assert(hal::Lidar::kMaxWaiting <= config::kMaxDeliveriesPerCycle, "a cycle receives all that wait");

// Whether frames repeat one that was used, or the one of this cycle that is kept. The first frames of a cycle
// are compared in full, and so are some of the others, if they begin like one of those. Then the verdict of
// the last one stands for all that begin so. This bounds the time of a cycle.
class Repetitions {
 public:
  Repetitions(const AttitudeInitApp& app, CycleWorkspace& workspace) : app_(app), workspace_(workspace) {}

  // `next`: the frame's buffer.
  bool look_at(std::size_t next) {
    workspace_.starts[next] = gnc::start_of(workspace_.frames[next]);
    has_signature_[next] = false;
    if (looks_ >= config::kFramesComparedInFull && !is_alike(next)) return false;
    if (looks_ < config::kMaxFullComparisonsPerCycle) {
      ++looks_;
      last_ = repeats(next);
    }
    return last_;
  }

 private:
  bool has_kept() const { return workspace_.inputs.frame != nullptr; }

  bool is_alike(std::size_t next) const {
    const gnc::SignatureStart& start = workspace_.starts[next];
    if (app_.has_used_alike(start)) return true;
    return has_kept() && gnc::is_alike(workspace_.starts[1 - next].cells, start);
  }

  bool repeats(std::size_t next) {
    if (app_.has_used(signature(next))) return true;
    return has_kept() && gnc::is_repetition(signature(1 - next), signature(next));
  }

  const gnc::FrameSignature& signature(std::size_t buffer) {
    if (!has_signature_[buffer]) workspace_.signatures[buffer] = gnc::signature_of(workspace_.frames[buffer]);
    has_signature_[buffer] = true;
    return workspace_.signatures[buffer];
  }

  const AttitudeInitApp& app_;
  CycleWorkspace& workspace_;
  std::array<bool, 2> has_signature_{};
  int looks_ = 0;
  bool last_ = false;
};

void receive_frames(const AttitudeInitApp& app, hal::Lidar& lidar, std::int64_t now_ns,
                    CycleWorkspace& workspace) {
  StepInputs& inputs = workspace.inputs;
  inputs.frame = nullptr;
  inputs.dropped_count = 0;
  inputs.frame_wrong_size = 0;
  inputs.frames_overflowed = lidar.take_dropped();
  Contents contents;
  Repetitions repetitions(app, workspace);
  std::size_t next = 0;  // of the two buffers, the one that does not hold inputs.frame
  for (int i = 0; i < config::kMaxDeliveriesPerCycle; ++i) {
    gnc::RangeImage& frame = workspace.frames[next];
    const hal::LidarStatus status = lidar.receive(frame);
    if (status == hal::LidarStatus::kNoFrame) break;
    if (status == hal::LidarStatus::kWrongSize) {
      ++inputs.frame_wrong_size;
      continue;
    }
    gnc::FrameVerdict verdict = app.judge(frame, now_ns);
    if (verdict == gnc::FrameVerdict::kPass && inputs.frame != nullptr)
      verdict = compare(*inputs.frame, frame);
    // A frame with bad content, or with a number and a time that are not those of its content, does not take
    // the place of a good one.
    gnc::FrameStatus content = gnc::FrameStatus::kOk;
    if (verdict == gnc::FrameVerdict::kPass) content = contents.look_at(frame);
    if (content != gnc::FrameStatus::kOk) verdict = gnc::FrameVerdict::kBadContent;
    if (verdict == gnc::FrameVerdict::kPass && repetitions.look_at(next))
      verdict = gnc::FrameVerdict::kRepeated;
    if (verdict != gnc::FrameVerdict::kPass) {
      drop(frame, verdict, inputs, content);
      continue;
    }
    if (inputs.frame != nullptr) drop(*inputs.frame, gnc::FrameVerdict::kSuperseded, inputs);
    inputs.frame = &frame;
    next = 1 - next;
  }
}

void receive_chaser(hal::Navigation* navigation, std::int64_t now_ns, StepInputs& inputs) {
  inputs.chaser = {};
  inputs.chaser_now = {};
  if (navigation == nullptr || inputs.frame == nullptr) return;
  inputs.chaser = navigation->attitude_at(inputs.frame->exposure_time_ns);
  inputs.chaser_now = navigation->attitude_at(now_ns);
}

void receive_commands(hal::Link& link, StepInputs& inputs) {
  inputs.commands_dropped = link.take_dropped();
  inputs.command_count = 0;
  for (hal::CommandPacket& command : inputs.commands) {
    if (!link.receive(command)) break;
    ++inputs.command_count;
  }
}

}  // namespace

void run_cycle(AttitudeInitApp& app, const CycleInterfaces& interfaces, std::int64_t now_ns,
               std::uint32_t cycle_slips, CycleWorkspace& workspace) {
  const std::uint64_t start_ns = interfaces.stopwatch.now_ns();
  app.correct_state();
  receive_frames(app, interfaces.lidar, now_ns, workspace);
  receive_chaser(interfaces.navigation, now_ns, workspace.inputs);
  receive_commands(interfaces.link, workspace.inputs);
  workspace.inputs.cycle_slips = cycle_slips;
  workspace.inputs.timing = {interfaces.keeps_deadline ? &interfaces.stopwatch : nullptr, start_ns,
                             workspace.previous_cycle_us};
  app.step(now_ns, workspace.inputs, workspace.outputs);

  const StepOutputs& outputs = workspace.outputs;
  hal::Link& link = interfaces.link;
  link.publish(outputs.attitude);
  link.publish(outputs.telemetry);
  for (int i = 0; i < outputs.event_count; ++i) link.publish(outputs.events[static_cast<std::size_t>(i)]);
  if (outputs.has_dump) link.publish(outputs.dump);
  if (outputs.duties_done) interfaces.watchdog.kick();
  workspace.previous_cycle_us = elapsed_us(start_ns, interfaces.stopwatch.now_ns());
}

}  // namespace tumblesight::fsw
