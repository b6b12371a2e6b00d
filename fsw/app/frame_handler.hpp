// FrameHandler: the path of a frame through gate, estimator and attitude checks to the attitude report.
#pragma once

#include "fsw/app/app_state.hpp"
#include "fsw/app/step_io.hpp"

namespace tumblesight::fsw {

// Memory of FrameHandler that is too large for the stack.
struct FrameWorkspace {
  Estimator::State state_before;
  gnc::AttitudeEstimate estimate;
};

class FrameHandler {
 public:
  FrameHandler(AppState& state, Estimator& estimator, FrameWorkspace& workspace, StepOutputs& outputs,
               const Reporter& report)
      : state_(state), estimator_(estimator), workspace_(workspace), outputs_(outputs), report_(report) {}

  // In RUN: all frames of the step, oldest first. Each one is used or refused.
  void take(const StepInputs& inputs);
  // In a cycle whose time does not advance: refuses all frames, with one event. `time_step_ms`: this cycle
  // minus the previous one.
  void refuse_all(const StepInputs& inputs, std::int32_t time_step_ms);

 private:
  void note_missing();
  bool use(const gnc::RangeImage& frame);
  bool passes_gate(const gnc::RangeImage& frame);
  bool estimate(const gnc::RangeImage& frame);
  void count_skipped(const gnc::RangeImage& frame);
  Validity check_attitude(const gnc::RangeImage& frame);
  void report_attitude(const gnc::RangeImage& frame, Validity validity);

  AppState& state_;
  Estimator& estimator_;
  FrameWorkspace& workspace_;
  StepOutputs& outputs_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
