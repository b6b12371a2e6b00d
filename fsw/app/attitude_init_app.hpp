// AttitudeInitApp: the flight application. One step() a period; a pure function of its state and inputs.
//
// Modes. STANDBY: no attitude. ESTIMATING: every good frame gives one. SAFE: an assertion failed (a bug in
// our code); no attitude until the command STANDBY. A good model at init() leads to ESTIMATING; without one
// the mode stays STANDBY.
//
// Commands carry no payload; an unknown opcode or any payload: refused, counted, event. Each gives exactly
// one event.
//   NOOP             nothing
//   ESTIMATE         STANDBY -> ESTIMATING: estimator reset, frame memory forgotten. In ESTIMATING: no
//   effect. Refused in
//                    SAFE and without a model
//   STANDBY          any mode -> STANDBY
//   RESET_ESTIMATOR  LSTM reset. The last accepted sequence number and exposure are still remembered, so that
//   no frame
//                    counts twice; the next frame is the first of a new sequence
//   RESET_COUNTERS   all counters of the housekeeping to zero; the command itself is the first one counted
//
// Frames are judged in ESTIMATING only; in the other modes they are taken and dropped. Each refusal is
// counted, gives an event and leaves the estimator untouched; see FrameGate for time and order,
// gnc::FrameStatus for content. A cycle without a frame is counted as missing, with an event where the outage
// begins. Skipped sequence numbers are counted, with an event, and the frame is used.
//
// The LSTM starts anew: at init() with a good model; on entering ESTIMATING; by RESET_ESTIMATOR; when cycle
// time goes back; and, with an event, when a frame's exposure is not one period +- 10 % after the last
// accepted one, since it has learnt steps of one period.
//
// Cycle times must rise. A cycle whose time does not is an error: event, its frames are refused, its commands
// are carried out (they carry no time and are the way out). Where time went back, the last accepted frame is
// forgotten and the estimator reset (counted; the event is that of the cycle time), since that frame's
// exposure may lie in the future now. Later cycles are compared with this one, so that a jump costs one
// cycle.
//
// No attitude leaves a cycle that ends in SAFE; an assertion ends the work on the cycle's frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/app/assertion.hpp"
#include "fsw/app/events.hpp"
#include "fsw/app/frame_gate.hpp"
#include "fsw/config/limits.hpp"
#include "gnc/lidar/range_image.hpp"
#include "gnc/rcnn/attitude_estimator.hpp"
#include "hal/link.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::fsw {

enum class Mode : std::uint8_t { kStandby = 0, kEstimating = 1, kSafe = 2 };

// Whether the attitudes of a report may be used. In every case but kValid they are the identity with an
// expected error of pi, and exposure time, sequence number and frames_since_reset are 0.
enum class Validity : std::uint8_t {
  kValid = 0,
  kStandby,       // not estimating: no model, commanded, or SAFE
  kNoFrame,       // no frame came in this cycle
  kFrameRefused,  // a frame came and was refused; the event says why
};

enum class Opcode : std::uint16_t {
  kNoop = 1,
  kEstimate = 2,
  kStandby = 3,
  kResetEstimator = 4,
  kResetCounters = 5
};

struct StepInputs {
  const gnc::RangeImage* frame = nullptr;  // nullptr: none in this cycle
  int frame_count = 1;       // frames that lie from `frame` on, oldest first; at most kMaxFramesPerStep
  int frame_wrong_size = 0;  // how often the sensor interface dropped something that was no frame
  std::array<hal::Command, config::kMaxCommandsPerStep> commands{};
  int command_count = 0;
};

struct StepOutputs {
  hal::AttitudeReport attitude;  // of the last frame accepted in this cycle
  hal::Housekeeping housekeeping;
  std::array<hal::Event, config::kMaxEventsPerStep> events{};
  int event_count = 0;
};

// What a platform's main drives, whatever the numerics.
class App {
 public:
  // Validates and loads the model image; without a good one the application stays in STANDBY and says why, in
  // an event of the next step. `expected_target`: NUL-terminated name, or nullptr for any. Called again it
  // activates another model; when that one is refused, the earlier model and the mode stay. `stopwatch`, and the
  // image, of which weights in fixed point are read in place, must outlive the application.
  virtual void init(const std::uint8_t* model_image, std::size_t size_bytes, const char* expected_target,
                    hal::Stopwatch& stopwatch) = 0;
  // Commands first, in order; then the frames; then telemetry. `now_ns`: time of this cycle. `outputs` is
  // overwritten.
  virtual void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) = 0;

  // Over all that decides what step() will give, the active model's CRC among it, and over the counters; what
  // the stopwatch measured is left out.
  virtual std::uint32_t state_crc32() const = 0;
  virtual Mode mode() const = 0;
  // What init() found; kOk before the first init().
  virtual gnc::ModelStatus model_status() const = 0;

 protected:
  ~App() = default;
};

// N: gnc::FixedPoint, which flies, or gnc::Float32 to compare with.
template <class N>
class AttitudeInitApp final : public App {
 public:
  void init(const std::uint8_t* model_image, std::size_t size_bytes, const char* expected_target,
            hal::Stopwatch& stopwatch) override;
  void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) override;
  std::uint32_t state_crc32() const override;
  Mode mode() const override { return mode_; }
  gnc::ModelStatus model_status() const override { return model_status_; }
  const gnc::AttitudeEstimator<N>& estimator() const { return estimator_; }

 private:
  void report(StepOutputs& outputs, EventId id, Severity severity, std::int32_t a = 0, std::int32_t b = 0,
              std::int32_t c = 0);
  void report_model(StepOutputs& outputs);
  void go_safe_on_assertion(StepOutputs& outputs);
  void reset_estimator();
  void enter_estimating();

  void run_commands(const StepInputs& inputs, StepOutputs& outputs);
  bool refuses(const hal::Command& command, CommandRefusal& why) const;
  void execute(Opcode opcode);

  void start_anew_in_time();
  bool cycle_time_advances(std::int64_t now_ns);
  void refuse_frames_of_cycle(const StepInputs& inputs, std::int32_t time_step_ms, StepOutputs& outputs);
  void take_frames(const StepInputs& inputs, StepOutputs& outputs);
  void take_frame(const gnc::RangeImage& frame, StepOutputs& outputs);
  bool passes_gate(const gnc::RangeImage& frame, StepOutputs& outputs);
  void use_frame(const gnc::RangeImage& frame, StepOutputs& outputs);
  void report_attitude(const gnc::RangeImage& frame, StepOutputs& outputs);
  void report_telemetry(std::uint64_t start_ns, StepOutputs& outputs);
  std::uint32_t microseconds_since(std::uint64_t start_ns);

  gnc::AttitudeEstimator<N> estimator_;
  typename gnc::AttitudeEstimator<N>::State state_before_frame_;
  gnc::AttitudeEstimate estimate_;
  FrameGate gate_;
  hal::Housekeeping counters_;
  AssertionLog assertions_;
  hal::Stopwatch* stopwatch_ = nullptr;
  std::int64_t now_ns_ = 0;
  gnc::ModelStatus model_status_ = gnc::ModelStatus::kOk;
  std::uint32_t model_size_bytes_ = 0;
  Mode mode_ = Mode::kStandby;
  bool has_cycle_ = false;
  bool model_to_report_ = false;
  bool outage_ = false;  // the previous cycle had no frame
};
static_assert(sizeof(AttitudeInitApp<gnc::FixedPoint>) <= config::kMaxAppBytes,
              "the application outgrew its memory budget");

}  // namespace tumblesight::fsw
