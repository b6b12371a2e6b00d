#include "sim/sil/sil_run.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>

#include "sim/sil/frame_feed.hpp"
#include "sim/sil/sil_session.hpp"
#include "sim/sil/trace.hpp"

namespace tumblesight::sim {
namespace {

using Clock = SilSession::Clock;

constexpr std::uint32_t kPictureSequences = 3;  // whose frames are kept

// One run: what is planned, the frames, and the recording as it grows.
class SilRun {
 public:
  SilRun(const SilSettings& settings, const FlashLidar& lidar, double swath_m,
         const std::vector<Sequence>& sequences, const SilProgress& progress, const FrameObserver& frame_sent,
         SilRecording& recording)
      : settings_(settings),
        sequences_(sequences),
        progress_(progress),
        frame_sent_(frame_sent),
        recording_(recording),
        plan_(plan_steps(sequences)),
        feed_(lidar, swath_m, sequences, plan_) {
    recording_.steps_planned = static_cast<std::uint32_t>(plan_.size());
    recording_.steps.reserve(plan_.size());
  }

  void run() {
    if (plan_.empty()) return;
    if (settings_.free_running && !(settings_.speed > 0.0)) {
      throw SilFailure("free running needs a speed: 1 for real time, N for N times real time");
    }
    SilSession session(settings_);
    settings_.free_running ? run_free(session) : run_lockstep(session);
    session.finish();
  }

 private:
  void run_lockstep(SilSession& session) {
    const auto begin = Clock::now();
    for (std::uint32_t k = 0; k < plan_.size(); ++k) {
      const StepInput input = prepare(session, k);
      if (settings_.speed > 0.0) session.sleep_until(begin + wall_time_of(k));
      session.publish_truth(plan_[k].sequence, plan_[k].frame, recording_.steps[k].truth, plan_[k].time_ns);
      record(k, session.step(input));
      if (k == 0) require_running(recording_.steps[0].telemetry);
    }
  }

  // Frames go out on the wall clock's time; answers are matched to them by sequence number.
  void run_free(SilSession& session) {
    const auto begin = Clock::now();
    for (std::uint32_t k = 0; k < plan_.size(); ++k) {
      const StepInput input = prepare(session, k);
      receive_until(session, begin + wall_time_of(k));
      session.publish_truth(plan_[k].sequence, plan_[k].frame, recording_.steps[k].truth, plan_[k].time_ns);
      session.send(input);
    }
    // The last frame's answer comes with the next cycle, or not at all.
    const auto grace = wall_time_of(2);
    receive_until(session, begin + wall_time_of(static_cast<std::uint32_t>(plan_.size())) + grace);
  }

  void receive_until(SilSession& session, Clock::time_point deadline) {
    while (Clock::now() < deadline && !last_answered()) {
      const std::optional<StepAnswer> answer = session.next_answer(deadline);
      if (!answer) return;
      require_running(answer->telemetry);
      recording_.flight_heap_allocations = answer->telemetry.heap_allocations;
      // Only attitudes name the frame that they belong to.
      const bool has_frame = gives_attitude(answer->attitude);
      const std::uint32_t k = answer->attitude.sequence_number;
      if (has_frame && k < recording_.steps.size() && !recording_.steps[k].answered) record(k, *answer);
    }
  }

  bool last_answered() const {
    return recording_.steps.size() == plan_.size() && recording_.steps.back().answered;
  }

  // Mission time as wall time, from the start of the run.
  Clock::duration wall_time_of(std::uint32_t k) const {
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(kFramePeriod_s * k / settings_.speed));
  }

  StepInput prepare(const SilSession& session, std::uint32_t k) {
    const PlannedStep& plan = plan_[k];
    StepRecord step;
    step.sequence = plan.sequence;
    step.frame_index = plan.frame;
    step.time_ns = plan.time_ns;
    step.truth = sequences_[plan.sequence].frames[plan.frame];
    recording_.steps.push_back(step);

    const gnc::RangeImage& frame = feed_.next();
    if (frame_sent_) frame_sent_(step, frame);
    if (plan.sequence < kPictureSequences) recording_.pictures.emplace_back(k, frame);

    StepInput input;
    input.time_ns = plan.time_ns;
    input.frames = {&frame};
    if (k == 0 && session.flight_mode() == hal::Mode::kStandby) {
      input.commands.push_back(set_mode(hal::Mode::kRun));
    }
    if (plan.frame == 0) input.commands.push_back(reset_sequence());
    input.last = k + 1 == plan_.size();
    return input;
  }

  void record(std::uint32_t k, const StepAnswer& answer) {
    StepRecord& step = recording_.steps[k];
    step.answered = true;
    step.attitude = answer.attitude;
    step.telemetry = answer.telemetry;
    step.events = answer.events;
    step.state_crc32 = answer.state_crc32;
    recording_.flight_heap_allocations = answer.telemetry.heap_allocations;
    ++answered_;
    if (progress_) progress_(answered_, recording_.steps_planned);
  }

  void require_running(const hal::Telemetry& telemetry) const {
    if (telemetry.mode != hal::Mode::kSafe) return;
    throw SilFailure("flight is in SAFE: it has no usable model image for target " + settings_.target +
                     (settings_.model_path.empty() ? "" : " in " + settings_.model_path) +
                     "; its message says what is wrong with it");
  }

  const SilSettings& settings_;
  const std::vector<Sequence>& sequences_;
  const SilProgress& progress_;
  const FrameObserver& frame_sent_;
  SilRecording& recording_;
  std::vector<PlannedStep> plan_;
  FrameFeed feed_;
  std::uint32_t answered_ = 0;
};

void conclude(SilRecording& recording) {
  std::uint32_t answered = 0;
  TraceDigest digest;
  for (std::uint32_t k = 0; k < recording.steps.size(); ++k) {
    if (!recording.steps[k].answered) continue;
    ++answered;
    digest.add(k, recording.steps[k]);
  }
  recording.steps_missed = recording.steps_planned - answered;
  recording.trace_crc32 = digest.value();
}

}  // namespace

bool gives_attitude(const hal::AttitudeReport& report) {
  return report.validity == hal::Validity::kValid || report.validity == hal::Validity::kDoubtful;
}

SilRecording run_sil(const SilSettings& settings, const FlashLidar& lidar, double swath_m,
                     const std::vector<Sequence>& sequences, const SilProgress& progress,
                     const FrameObserver& frame_sent) {
  SilRecording recording;
  try {
    SilRun(settings, lidar, swath_m, sequences, progress, frame_sent, recording).run();
  } catch (const std::exception& error) {
    recording.failure = error.what();
  }
  conclude(recording);
  return recording;
}

}  // namespace tumblesight::sim
