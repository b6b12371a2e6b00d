#include "hal/dds/flight_bus.hpp"

#include <initializer_list>

#include "hal/dds/stop_request.hpp"

namespace tumblesight::hal::dds {
namespace {

// Interval of the checks for a stop request and a lost simulator while no sample arrives.
constexpr std::int64_t kPoll_ns = 100'000'000;
constexpr std::int64_t kFlushTimeout_ns = 2'000'000'000;

}  // namespace

void FlightBus::join_run(std::uint32_t run_id, std::int64_t timeout_ns) {
  run_id_ = run_id;
  timeout_ns_ = static_cast<std::uint64_t>(timeout_ns);
  heard_something();
}

bool FlightBus::take_step(StepSample& step) {
  while (endpoints_.steps.take(step)) {
    if (step.run_id != run_id_) continue;
    heard_something();
    return true;
  }
  return false;
}

bool FlightBus::wait_for_step(std::uint32_t k, StepSample& step, FlightEnd& end) {
  bool announced = false;
  int frames = 0;
  int commands = 0;
  for (;;) {
    if (!announced && take_step(step)) {
      announced = true;
      if (step.k != k || step.frames > kMaxFramesPerStep || step.commands > kMaxCommandsPerStep) {
        end = FlightEnd::kStepOutOfOrder;
        return false;
      }
    }
    frames += carry_frames(k, false);
    commands += carry_commands(k, false);
    if (announced && frames >= step.frames && commands >= step.commands) return true;
    if (must_end(end)) return false;
    endpoints_.wait_for_data(kPoll_ns);
  }
}

void FlightBus::carry_in(std::int64_t timeout_ns) {
  (void)carry_frames(0, true);
  (void)carry_commands(0, true);
  endpoints_.wait_for_data(timeout_ns);
}

int FlightBus::carry_frames(std::uint32_t k, bool any_step) {
  int count = 0;
  while (count < kMaxFramesPerStep && endpoints_.frames.take(frame_)) {
    if (frame_.run_id != run_id_ || (!any_step && frame_.k != k)) continue;
    lidar_.put(frame_);
    latest_frame_k_ = frame_.k;
    has_frame_ = true;
    ++count;
  }
  return count;
}

int FlightBus::carry_commands(std::uint32_t k, bool any_step) {
  int count = 0;
  CommandSample sample;
  while (count < kMaxCommandsPerStep && endpoints_.commands.take(sample)) {
    if (sample.run_id != run_id_ || (!any_step && sample.k != k)) continue;
    link_.put(sample);
    ++count;
  }
  return count;
}

bool FlightBus::carry_out() {
  bool written = true;
  while (link_.take_output(output_)) {
    if (output_.done.attitudes > 0) written &= endpoints_.attitudes.write(output_.attitude) == 0;
    if (output_.done.telemetries > 0) written &= endpoints_.telemetries.write(output_.telemetry) == 0;
    for (std::uint8_t i = 0; i < output_.done.events; ++i) {
      written &= endpoints_.events.write(output_.events[i]) == 0;
    }
    if (output_.done.dumps > 0) written &= endpoints_.dumps.write(output_.dump) == 0;
    if (packets_ != nullptr) packets_->put(output_);
    written &= endpoints_.steps_done.write(output_.done) == 0;
  }
  return written;
}

void FlightBus::flush() const {
  for (const dds_entity_t writer :
       {endpoints_.attitudes.entity(), endpoints_.telemetries.entity(), endpoints_.events.entity(),
        endpoints_.dumps.entity(), endpoints_.steps_done.entity()}) {
    (void)wait_for_acknowledgment(writer, kFlushTimeout_ns);
  }
}

bool FlightBus::must_end(FlightEnd& end) const {
  end = FlightEnd::kComplete;
  if (stop_requested()) return true;
  end = FlightEnd::kSilence;
  if (stopwatch_.now_ns() - last_heard_ns_ > timeout_ns_) return true;
  end = FlightEnd::kSimulatorGone;
  return endpoints_.simulator_gone();
}

}  // namespace tumblesight::hal::dds
