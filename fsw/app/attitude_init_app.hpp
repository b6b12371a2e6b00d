// AttitudeInitApp: the flight application. One step() a period; a pure function of its state and inputs.
//
// A step, in this order:
//   1. memory       majority vote over the application's state; guards of the estimator and the model
//   (memory_guard.hpp)
//   2. commands     in the order in which they came (telecommand.hpp, command_gate.hpp)
//   3. frames       gate, estimator, checks of the attitude; in RUN only, else they are dropped
//   4. supervision  persistence of faults and the responses to them (fault_rules.hpp)
//   5. telemetry    attitude, housekeeping, events
// Modes: modes.hpp. Rules of frames and commands, events, every field: docs/icd.md.
//
// Each refused frame is counted, gives an event and leaves the estimator untouched; see FrameGate for time
// and order, gnc::FrameStatus for content. A cycle without a frame is counted as missing, with an event where
// the outage begins. Skipped sequence numbers are counted, with an event, and the frame is used.
//
// The estimator starts anew: on entering RUN; by RESET_SEQUENCE; when cycle time goes back; by the response
// to a fault; and, with an event, when a frame's exposure is not one period +- 10 % after the last accepted
// one, since it has learnt steps of one period.
//
// Cycle times must rise. A cycle whose time does not is an error: event, its frames are refused, its commands
// are carried out (they carry no time and are the way out). Where time went back, the last accepted frame is
// forgotten and the estimator reset (counted; the event is that of the cycle time), since that frame's
// exposure may lie in the future now. Later cycles are compared with this one, so that a jump costs one
// cycle.
//
// No attitude leaves a cycle that does not end in RUN; an assertion ends the work on the cycle's frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/command_gate.hpp"
#include "fsw/app/memory_guard.hpp"
#include "fsw/app/voted.hpp"
#include "fsw/config/limits.hpp"
#include "gnc/lidar/range_image.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"
#include "hal/link.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw {

// Whether the attitudes of a report may be used. But for kValid and kDoubtful they are the identity with an
// expected error of pi, and exposure time, sequence number and frames_since_reset are 0.
enum class Validity : std::uint8_t {
  kValid = 0,
  kStandby,       // not in RUN
  kNoFrame,       // no frame came in this cycle
  kFrameRefused,  // a frame came and was refused; the event says why
  kDoubtful,  // there is an attitude, but it expects too large an error, has jumped, or is of a frozen frame
};

struct StepInputs {
  const gnc::RangeImage* frame = nullptr;  // nullptr: none in this cycle
  int frame_count = 1;       // frames that lie from `frame` on, oldest first; at most kMaxFramesPerStep
  int frame_wrong_size = 0;  // how often the sensor interface dropped something that was no frame
  std::array<hal::CommandPacket, config::kMaxCommandsPerStep> commands{};
  int command_count = 0;
  std::uint32_t cycle_slips = 0;  // releases of the task missed since the last step
};

struct StepOutputs {
  hal::AttitudeReport attitude;  // of the last frame accepted in this cycle
  hal::Housekeeping housekeeping;
  std::array<hal::Event, config::kMaxEventsPerStep> events{};
  int event_count = 0;
  hal::ModelDump dump;
  bool has_dump = false;
  bool duties_done = false;  // the watchdog may be kicked
};

// N: gnc::FixedPoint, which flies, or gnc::Float32 to compare with.
template <class N>
class AttitudeInitApp final {
 public:
  // Boots: looks for a good model in the banks, the first one first. With one the mode becomes RUN, else
  // SAFE; events of the next step say what was found. Called again it boots again. `expected_target`:
  // NUL-terminated name, or nullptr for any.
  void init(const hal::Platform& platform, const char* expected_target, Protections protections = {});
  // `now_ns`: time of this cycle. `outputs` is overwritten.
  void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs);

  // To compare runs: over the estimator's state, the active model's CRC, mode, times, last frame, limits,
  // faults that persist and the counters. What depends on the wall clock is left out.
  std::uint32_t state_crc32() const;
  Mode mode() const { return state_->mode; }
  // What init() found in a bank; kOk before the first init().
  gnc::ModelStatus boot_status(int bank) const { return state_->boot_status[static_cast<std::size_t>(bank)]; }
  const gnc::AttitudeEstimator<N>& estimator() const { return estimator_; }

 private:
  friend struct AppMemory;  // tests/campaigns/fault: where to flip bits

  bool enter(Cause cause, Fault fault = Fault::kStateLost);
  void reset_estimator();
  gnc::ModelStatus activate(std::uint32_t bank);
  void boot_from(std::uint32_t bank);
  void report_boot(const Reporter& report);
  void go_safe_on_assertion(const Reporter& report);

  void run_commands(const StepInputs& inputs, StepOutputs& outputs, const Reporter& report);
  bool carry_out(const Telecommand& command, StepOutputs& outputs, CommandRefusal& why, std::int32_t& detail,
                 const Reporter& report);
  void reset_counters();
  bool set_mode(std::uint8_t mode, CommandRefusal& why);
  bool load_segment(const Telecommand& command, CommandRefusal& why, std::int32_t& detail);
  bool validate_model(const Telecommand& command, CommandRefusal& why, std::int32_t& detail,
                      const Reporter& report);
  bool activate_model(const Telecommand& command, CommandRefusal& why, std::int32_t& detail,
                      const Reporter& report);
  bool dump_model(const Telecommand& command, StepOutputs& outputs, CommandRefusal& why) const;
  bool set_limit(const Telecommand& command, CommandRefusal& why, std::int32_t& detail);

  bool cycle_time_advances(std::int64_t now_ns);
  void start_anew_in_time();
  void refuse_frames_of_cycle(const StepInputs& inputs, std::int32_t time_step_ms, StepOutputs& outputs,
                              const Reporter& report);
  void take_frames(const StepInputs& inputs, StepOutputs& outputs, const Reporter& report);
  void take_frame(const gnc::RangeImage& frame, StepOutputs& outputs, const Reporter& report);
  bool passes_gate(const gnc::RangeImage& frame, const Reporter& report);
  void use_frame(const gnc::RangeImage& frame, StepOutputs& outputs, const Reporter& report);
  void report_attitude(const gnc::RangeImage& frame, StepOutputs& outputs, const Reporter& report);

  void supervise(const StepInputs& inputs, const StepOutputs& outputs, std::uint64_t start_ns,
                 const Reporter& report);
  void measure(std::uint64_t start_ns, const Reporter& report);
  void respond(Fault fault, const Reporter& report);
  Response switch_bank(Fault fault, const Reporter& report);
  void go_safe(Fault fault, const Reporter& report);
  void report_telemetry(StepOutputs& outputs);
  std::uint32_t microseconds_since(std::uint64_t start_ns) const;

  gnc::AttitudeEstimator<N> estimator_;
  MemoryGuard<N> guard_;
  typename gnc::AttitudeEstimator<N>::State state_before_frame_;
  gnc::AttitudeEstimate estimate_;
  Voted<AppState> state_;
  EventLog events_;
};
static_assert(sizeof(AttitudeInitApp<gnc::FixedPoint>) <= config::kMaxAppBytes,
              "the application outgrew its memory budget");

}  // namespace tumblesight::fsw
