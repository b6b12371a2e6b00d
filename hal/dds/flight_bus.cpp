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
    if (!belongs(step.run_id, step.k, step.k, nullptr)) continue;
    heard_something();
    return true;
  }
  return false;
}

bool FlightBus::wait_for_step(std::uint32_t k, StepSample& step, FlightEnd& end) {
  StepContent content;
  bool announced = false;
  for (;;) {
    if (!announced && take_step(step)) {
      announced = true;
      out_of_order_ |= step.k != k || step.frames > kMaxFramesPerStep ||
                       step.navigations > kMaxFramesPerStep || step.commands > kMaxCommandsPerStep;
    }
    carry_navigations(k, &content);
    carry_frames(k, &content);
    carry_commands(k, &content);
    const bool complete = announced && content.has_all_of(step);
    if (complete) out_of_order_ |= !content.is_that_of(step);
    if (!check_writers(end)) return false;
    if (complete) return true;
    if (must_end(end)) return false;
    endpoints_.wait_for_data(kPoll_ns);
  }
}

void FlightBus::carry_in(std::int64_t timeout_ns) {
  carry_navigations(0, nullptr);
  carry_frames(0, nullptr);
  carry_commands(0, nullptr);
  endpoints_.wait_for_data(timeout_ns);
}

bool FlightBus::belongs(std::uint32_t run_id, std::uint32_t sample_k, std::uint32_t k,
                        const StepContent* content) {
  const bool ours = run_id == run_id_ && (content == nullptr || sample_k == k);
  out_of_order_ |= !ours;
  return ours;
}

void FlightBus::carry_frames(std::uint32_t k, StepContent* content) {
  for (int count = 0; count < kMaxFramesPerStep && endpoints_.frames.take(frame_); ++count) {
    if (!belongs(frame_.run_id, frame_.k, k, content)) continue;
    lidar_.put(frame_);
    latest_frame_k_ = frame_.k;
    has_frame_ = true;
    if (content != nullptr) content->add(frame_);
  }
}

void FlightBus::carry_navigations(std::uint32_t k, StepContent* content) {
  NavigationSample sample;
  for (int count = 0; count < kMaxFramesPerStep && endpoints_.navigations.take(sample); ++count) {
    if (!belongs(sample.run_id, sample.k, k, content)) continue;
    navigation_.put(sample);
    if (content != nullptr) content->add(sample);
  }
}

void FlightBus::carry_commands(std::uint32_t k, StepContent* content) {
  CommandSample sample;
  for (int count = 0; count < kMaxCommandsPerStep && endpoints_.commands.take(sample); ++count) {
    if (!belongs(sample.run_id, sample.k, k, content)) continue;
    link_.put(sample);
    if (content != nullptr) content->add(sample);
  }
}

// False: the samples that have arrived must not be used.
bool FlightBus::check_writers(FlightEnd& end) {
  foreigner_ = endpoints_.foreigner();
  end = foreigner_ ? FlightEnd::kForeign : FlightEnd::kStepOutOfOrder;
  return !foreigner_ && !out_of_order_;
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

bool FlightBus::must_end(FlightEnd& end) {
  if (!check_writers(end)) return true;
  end = stop_reason();
  if (stop_requested()) return true;
  end = FlightEnd::kSilence;
  if (silence_.is_over(stopwatch_.now_ns())) return true;
  end = FlightEnd::kSimulatorGone;
  return endpoints_.simulator_gone();
}

}  // namespace tumblesight::hal::dds
