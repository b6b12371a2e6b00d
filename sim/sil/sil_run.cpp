#include "sim/sil/sil_run.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <optional>
#include <utility>

#include "sim/host/text.hpp"
#include "sim/operations/fault_names.hpp"
#include "sim/operations/function_names.hpp"
#include "sim/sil/frame_faults.hpp"
#include "sim/sil/run_control.hpp"
#include "sim/sil/sil_session.hpp"
#include "sim/sil/simulated_steps.hpp"
#include "sim/sil/trace.hpp"

namespace tumblesight::sim {
namespace {

using Clock = SilSession::Clock;

constexpr std::size_t kTakenKept = 16;  // frames: a late one is answered a few steps later

// One run: its steps, and its result so far.
class SilRun {
 public:
  SilRun(const SilSettings& settings, StepSource& source, const SilProgress& progress,
         const FrameObserver& frame_sent, SilRunResult& result)
      : settings_(settings),
        source_(source),
        progress_(progress),
        frame_sent_(frame_sent),
        result_(result),
        steps_(source.steps()) {
    result_.steps_planned = steps_;
    result_.steps.reserve(steps_);
  }

  void run() {
    if (steps_ == 0) return;
    if (settings_.free_running && !(settings_.speed > 0.0)) {
      throw SilFailure(
          "a free-running flight program needs a speed: --speed 1 for real time, N for N times real time");
    }
    SilSession session(settings_);
    control_.emplace(session.domain());
    if (!control_->failure().empty()) print_note(control_->failure());
    settings_.free_running ? simulate_free_running(session) : simulate_in_lockstep(session);
    session.finish();
  }

 private:
  void simulate_in_lockstep(SilSession& session) {
    const auto begin = Clock::now();
    for (std::uint32_t k = 0; k < steps_; ++k) {
      if (settings_.speed > 0.0) session.sleep_until(begin + wall_time_of(k));
      const StepInput input = prepare(session, k);
      publish_truth(session, result_.steps[k]);
      store_answer(k, session.step(input));
      if (k == 0) require_running(session, result_.steps[0].telemetry);
    }
  }

  // Frames are sent by the wall clock. Answers are matched to them by sequence number.
  void simulate_free_running(SilSession& session) {
    const auto begin = Clock::now();
    for (std::uint32_t k = 0; k < steps_; ++k) {
      receive_until(session, begin + wall_time_of(k));
      const StepInput input = prepare(session, k);
      publish_truth(session, result_.steps[k]);
      session.send(input);
    }
    // The answer to the last frame comes with the next cycle, or never.
    receive_until(session, begin + wall_time_of(steps_ + 2));
  }

  static void publish_truth(SilSession& session, const StepResult& step) {
    if (step.truth_known)
      session.publish_truth(step.sequence, step.frame_index, step.truth, step.time_ns, step.exposure_time_ns);
  }

  void receive_until(SilSession& session, Clock::time_point deadline) {
    while (Clock::now() < deadline && !last_answered()) {
      const std::optional<StepAnswer> answer = session.next_answer(deadline);
      if (!answer) return;
      if (!is_running_) require_running(session, answer->telemetry);
      is_running_ = true;  // later the user, or a fault, may end it
      store_counters(answer->telemetry);
      // Only a report with an attitude names its frame.
      const bool has_frame = gives_attitude(answer->attitude);
      const std::uint32_t k = answer->attitude.sequence_number;
      if (has_frame && k < result_.steps.size() && !result_.steps[k].answered) store_answer(k, *answer);
    }
  }

  bool last_answered() const { return result_.steps.size() == steps_ && result_.steps.back().answered; }

  // Mission time since step 0. Nominal periods follow the last step.
  std::int64_t mission_time_of(std::uint32_t k) const {
    const std::uint32_t last = std::min(k, steps_ - 1);
    return source_.time_ns(last) - source_.time_ns(0) + std::int64_t{k - last} * kFramePeriod_ns;
  }

  // Mission time as wall time, from the start of the run.
  Clock::duration wall_time_of(std::uint32_t k) const {
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1e-9 * static_cast<double>(mission_time_of(k)) / settings_.speed));
  }

  StepInput prepare(const SilSession& session, std::uint32_t k) {
    RunRequests requests = control_->take(k, faults_, source_);
    SourcedStep sourced = source_.next();
    StepInput& input = sourced.input;
    for (Telecommand& command : requests.commands) {
      result_.requests.push_back({k, "telecommand " + name_of(command.function)});
      input.commands.push_back(std::move(command));
    }
    for (const InjectedFault& fault : requests.faults) result_.requests.push_back({k, to_string(fault)});
    sourced.step.exposure_time_ns =
        input.frames.empty() ? input.time_ns : input.frames.back()->exposure_time_ns;
    taken_.push_back({sourced.step.exposure_time_ns, sourced.step.truth, sourced.step.truth_known});
    if (taken_.size() > kTakenKept) taken_.pop_front();
    faults_.apply(input, sourced.step.truth);
    result_.steps.push_back(sourced.step);
    for (const gnc::RangeImage* frame : input.frames) {
      if (frame_sent_) frame_sent_(sourced.step, *frame);
      if (sourced.keep_picture) result_.pictures.emplace_back(k, *frame);
    }
    // A run that is sent again has its own.
    if (k == 0 && session.flight_mode() == hal::Mode::kStandby && input.packets.empty())
      input.commands.insert(input.commands.begin(), set_mode(hal::Mode::kRun));
    input.last = k + 1 == steps_;
    return std::move(input);
  }

  void store_answer(std::uint32_t k, const StepAnswer& answer) {
    StepResult& step = result_.steps[k];
    step.answered = true;
    step.attitude = answer.attitude;
    step.telemetry = answer.telemetry;
    step.events = answer.events;
    step.state_crc32 = answer.state_crc32;
    take_truth_of_attitude(k);
    store_counters(answer.telemetry);
    ++answered_;
    if (progress_) progress_(answered_, result_.steps_planned);
  }

  // A frame that was delivered late is answered late.
  void take_truth_of_attitude(std::uint32_t k) {
    StepResult& step = result_.steps[k];
    const std::int64_t exposure_time_ns = step.attitude.exposure_time_ns;
    if (!gives_attitude(step.attitude) || exposure_time_ns == step.exposure_time_ns) return;
    const auto earlier = std::find_if(taken_.begin(), taken_.end(), [&](const TakenFrame& frame) {
      return frame.exposure_time_ns == exposure_time_ns;
    });
    if (earlier == taken_.end()) return;
    const bool lost = step.truth.lost;  // whether the step owes an attitude stays as it is
    step.truth = earlier->truth;
    step.truth.lost = lost;
    step.truth_known = earlier->truth_known;
  }

  void store_counters(const hal::Telemetry& telemetry) {
    result_.flight_heap_allocations = telemetry.heap_allocations;
    result_.flight_frames_dropped = telemetry.frames_superseded + telemetry.frames_overflowed;
  }

  void require_running(const SilSession& session, const hal::Telemetry& telemetry) const {
    if (telemetry.mode != hal::Mode::kSafe) return;
    const bool from_start = session.flight_mode() == hal::Mode::kSafe;
    throw SilFailure("the flight program is in SAFE mode: " + reason_for_safe(telemetry, from_start));
  }

  // The stored state keeps the cause of its SAFE.
  std::string reason_for_safe(const hal::Telemetry& telemetry, bool from_start) const {
    if (telemetry.safe_cause == hal::Cause::kNoModel) {
      return "it has no usable model image for target " + settings_.target +
             (settings_.model_path.empty() ? "" : " in " + settings_.model_path) +
             "; see its message for the reason";
    }
    if (from_start) {
      return "its file of --state says so, or cannot be read; send SET_MODE STANDBY, or delete the file and "
             "the "
             "one beside it with .copy";
    }
    if (telemetry.safe_cause == hal::Cause::kFault)
      return "its response to the fault " + name_of(telemetry.safe_fault);
    return "cause " + std::to_string(static_cast<int>(telemetry.safe_cause)) + " in docs/icd.md";
  }

  const SilSettings& settings_;
  std::optional<RunControl> control_;
  FrameFaults faults_;
  StepSource& source_;
  const SilProgress& progress_;
  const FrameObserver& frame_sent_;
  SilRunResult& result_;
  std::uint32_t steps_;
  std::uint32_t answered_ = 0;
  bool is_running_ = false;  // the flight program has answered, and was not in SAFE
  // What the sensor took, whatever was delivered.
  struct TakenFrame {
    std::int64_t exposure_time_ns;
    FrameTruth truth;
    bool truth_known;
  };
  std::deque<TakenFrame> taken_;
};

// Free-running, an answer names its frame, so a frame that was lost or repeated need not have one.
bool needs_no_answer(const StepResult& step, bool free_running) {
  return free_running && !step.truth.is_genuine();
}

// Whether the next frame that the sensor delivered came less than a cycle later.
bool has_successor_in_its_cycle(const std::vector<StepResult>& steps, std::size_t k) {
  const auto next = std::find_if(steps.begin() + static_cast<std::ptrdiff_t>(k) + 1, steps.end(),
                                 [](const StepResult& step) { return !step.truth.lost; });
  return next != steps.end() && next->time_ns - steps[k].time_ns < kFramePeriod_ns;
}

// Of a sensor that is faster than the cycle, the flight program uses the newest frame of each cycle and
// counts the others.
std::uint32_t superseded_frames(const SilRunResult& result) {
  std::uint32_t without_answer = 0;
  for (std::size_t k = 0; k < result.steps.size(); ++k) {
    const StepResult& step = result.steps[k];
    if (!step.answered && step.truth.is_genuine() && has_successor_in_its_cycle(result.steps, k))
      ++without_answer;
  }
  return std::min(without_answer, result.flight_frames_dropped);
}

void conclude(bool free_running, SilRunResult& result) {
  std::uint32_t answered = 0;
  TraceDigest digest;
  for (std::uint32_t k = 0; k < result.steps.size(); ++k) {
    if (result.steps[k].answered || needs_no_answer(result.steps[k], free_running)) ++answered;
    if (!result.steps[k].answered) continue;
    digest.add(k, result.steps[k]);
  }
  if (free_running) result.frames_superseded = superseded_frames(result);
  result.steps_missed = result.steps_planned - answered - result.frames_superseded;
  result.trace_crc32 = digest.value();
}

}  // namespace

SilRunResult run_sil(const SilSettings& settings, StepSource& source, const SilProgress& progress,
                     const FrameObserver& frame_sent) {
  SilRunResult result;
  try {
    SilRun(settings, source, progress, frame_sent, result).run();
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  conclude(settings.free_running, result);
  return result;
}

SilRunResult run_sil(const SilSettings& settings, const FlashLidar& lidar, double swath_m,
                     const std::vector<Sequence>& sequences, const SilProgress& progress,
                     const FrameObserver& frame_sent) {
  SimulatedSteps steps(lidar, swath_m, sequences, settings.ego_motion);
  return run_sil(settings, steps, progress, frame_sent);
}

}  // namespace tumblesight::sim
