// AttitudeInitApp: the flight application. It runs one step() per frame period. A step is a pure function of
// its state and inputs.
//
// The stages of a step, in this order:
//   1. memory       majority vote over the application's state; scrubber of estimator and model
//                   (triple_redundant.hpp, memory_scrubber.hpp)
//   2. commands     in the order in which they arrived (command_handler.hpp, commands.cpp)
//   3. frame        gnc::FrameTracker: admission, estimator, checks (frame_handler.hpp); only in RUN
//   4. supervision  persistence of faults and the responses to them (supervisor.hpp, fault_rules.hpp)
//   5. telemetry    attitude, telemetry, events
// Modes: mode_manager.hpp and modes.hpp. Rules for frames and commands, events and all fields: docs/icd.md.
//
// A refused frame is counted, raises an event and leaves the estimator unchanged. gnc::FrameGate has the
// rules for time and order, gnc::FrameStatus those for the content. Of several frames that wait for a cycle
// the newest one that passes the gate is used; the older ones are superseded, which is counted. A cycle
// without a frame is counted as missing; an event marks the start of an outage. Skipped sequence numbers are
// counted, with an event, and the frame is used. A cycle with a long task (AppState::begin_long_task()) skips
// its frame, which is counted; the track coasts.
//
// The estimator is reset
//   - on entering RUN, by RESET_SEQUENCE and by the response to a fault;
//   - when the cycle time goes back;
//   - with an event, when a frame's exposure is more than LongestCoast_ms after the last used one.
//     Otherwise the track coasts;
//   - when another model is activated, and when the chaser's attitude becomes known or is lost
//   (docs/icd.md 2.3).
//
// Cycle times must increase. Otherwise an event is raised, and the frames of the cycle are refused. Its
// commands are still carried out: they do not depend on the time, and the ground needs them to recover. If
// the time went back, the last accepted frame is forgotten too, because its exposure may now lie
// in the future. The next cycle is compared with this one, so a jump costs one cycle.
//
// A cycle that does not end in RUN reports no attitude. A failed assertion ends the work on the frames of the
// cycle.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/frame_handler.hpp"
#include "fsw/app/memory_scrubber.hpp"
#include "fsw/app/step_io.hpp"
#include "fsw/app/triple_redundant.hpp"
#include "fsw/config/limits.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw {

class AttitudeInitApp final {
 public:
  // Boots: resumes from the platform's persistent store (state_keeper.hpp) and activates the image of the
  // bank that was in use, or else of the other bank, if it passes every check. The mode becomes RUN, STANDBY
  // or SAFE by the table in state_keeper.hpp, and SAFE without a good image; events of the next step report
  // the result. Can be called again.
  // `platform`: stopwatch and models must not be nullptr. `expected_target`: NUL-terminated name of the
  // model's target, or nullptr to accept any.
  void init(const hal::Platform& platform, const char* expected_target);
  // One cycle. `now_ns`: time of this cycle, which must be later than that of the previous one. All of
  // `outputs` is overwritten, except the content of `dump` where has_dump is false.
  void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs);
  // Between two steps: makes the table the active one, as TABLE_ACTIVATE does, for platforms that keep tables
  // themselves. False: a field has a value that is not allowed, and nothing changes.
  [[nodiscard]] bool use(const ParameterTable& table);

  // Before the frames of a cycle are chosen: corrects flipped bits, so that the three functions below decide
  // by a triple-redundant state. The next step reports the corrections.
  void correct_state();
  // Whether a frame passes the rules for time and order in a cycle at `now_ns`. The caller chooses the frame
  // of the step by it. The step checks the frame again, after the cycle's commands: they may change the
  // limits or reset the sequence, and a step must not depend on what its caller has checked.
  [[nodiscard]] gnc::FrameVerdict judge(const gnc::RangeImage& frame, std::int64_t now_ns) const;
  // Whether a frame begins like one of the last used ones, and whether it repeats one. For the same choice.
  [[nodiscard]] bool has_used_alike(const gnc::SignatureStart& start) const {
    return state_->tracking.history.contains_alike(start);
  }
  [[nodiscard]] bool has_used(const gnc::FrameSignature& signature) const {
    return state_->tracking.history.contains(signature);
  }
  // To compare runs: the digest of the state (state_digest.hpp), without what depends on the wall clock.
  std::uint32_t state_crc32() const;
  Mode mode() const { return state_->mode; }
  // For a link that authenticates commands before it queues them: the key slot in use, and the counter of the
  // last authentic command.
  std::uint32_t key_slot() const { return state_->authority.slot(); }
  std::uint32_t command_counter() const { return state_->counters.command_counter; }
  // What init() found in a bank (0 or 1); kOk before the first init().
  gnc::ModelStatus boot_status(int bank) const { return state_->boot_status[static_cast<std::size_t>(bank)]; }
  // What init() could not resume of the stored state: a sum of hal::StateLoss.
  std::uint32_t state_lost() const { return state_->resumption.lost; }
  const Estimator& estimator() const { return estimator_; }

 private:
  friend struct AppMemory;  // tests: the places where they flip bits, and a cycle without protections

  // The vote and the scrubber against bit flips. An argument, because a flip in memory could switch off a
  // setting that is kept there. Flight has only kOn.
  enum class Protections : std::uint8_t { kOn, kOff };

  void step_with(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs,
                 Protections protections);
  void take_frames(const StepInputs& inputs, std::int64_t previous_ns, bool time_advances,
                   StepOutputs& outputs, const Reporter& report);
  void report_telemetry(StepOutputs& outputs);

  Estimator estimator_;
  MemoryScrubber scrubber_;
  FrameWorkspace frame_workspace_;
  TripleRedundant<AppState> state_;
};
#if !TUMBLESIGHT_APP_FLOAT32
static_assert(sizeof(AttitudeInitApp) <= config::kMaxAppBytes + gnc::kKernelScratchBytes,
              "the application is larger than its memory budget");
#endif

}  // namespace tumblesight::fsw
