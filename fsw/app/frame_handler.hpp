// FrameHandler: the path of a frame through gnc::FrameTracker to the attitude report. It counts, raises
// events and sets faults; what happens to a frame is decided by the tracker.
#pragma once

#include "fsw/app/app_state.hpp"
#include "fsw/app/step_io.hpp"

namespace tumblesight::fsw {

// Memory of FrameHandler that is too large for the stack.
struct FrameWorkspace {
  gnc::FrameOutcome outcome;
};

class FrameHandler {
 public:
  FrameHandler(AppState& state, Estimator& estimator, FrameWorkspace& workspace, StepOutputs& outputs,
               const Reporter& report)
      : state_(state), tracker_(estimator), workspace_(workspace), outputs_(outputs), report_(report) {}

  // In RUN: uses, refuses or skips the frame of the step. Counts the dropped ones.
  void take(const StepInputs& inputs);
  // In a cycle whose time does not advance: refuses all frames, with one event. `time_step_ms`: this cycle
  // minus the previous one.
  void refuse_all(const StepInputs& inputs, std::int32_t time_step_ms);

 private:
  void note_missing();
  void note_dropped(const StepInputs& inputs);
  void pass_over();
  void use(const StepInputs& inputs);
  void note_refusal(gnc::FrameVerdict verdict, std::uint32_t sequence_number, std::int64_t exposure_time_ns);
  void note_bad_content(gnc::FrameStatus content, std::uint32_t sequence_number, std::int32_t rays);
  // `since_start_us`: since the cycle began.
  void note_cut_short(const gnc::RangeImage& frame, std::uint32_t since_start_us);
  void note_use(const gnc::RangeImage& frame);
  Validity note_doubts(const gnc::RangeImage& frame);
  void report_attitude(const gnc::RangeImage& frame, Validity validity);
  void report_pose();
  void note_verdict(const gnc::PoseEstimate& pose);

  AppState& state_;
  gnc::FrameTracker<Numerics> tracker_;
  FrameWorkspace& workspace_;
  StepOutputs& outputs_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
