#include "hal/dds/dds_link.hpp"

#include <algorithm>
#include <iterator>

namespace tumblesight::hal::dds {

static_assert(tumblesight_icd_COMMAND_PAYLOAD == Command::kMaxPayload, "the ICD's command is the link's");

void DdsLink::put(const CommandSample& sample) {
  const MailboxLock lock(mutex_);
  Command& command = commands_.push();
  command.opcode = sample.opcode;
  // A size beyond the payload stays visible to the application, which refuses it.
  command.payload_size = sample.payload_size;
  std::copy(std::begin(sample.payload), std::end(sample.payload), command.payload.begin());
}

bool DdsLink::take_output(CycleOutput& output) {
  const MailboxLock lock(mutex_);
  const CycleOutput* oldest = outputs_.pop();
  if (oldest == nullptr) return false;
  output = *oldest;
  return true;
}

void DdsLink::begin_cycle(std::uint32_t run_id, std::uint32_t k) {
  output_.done = {};
  output_.done.run_id = run_id;
  output_.done.k = k;
}

void DdsLink::end_cycle(std::uint32_t state_crc32) {
  output_.done.state_crc32 = state_crc32;
  const MailboxLock lock(mutex_);
  outputs_.push() = output_;
}

bool DdsLink::receive(Command& command) {
  const MailboxLock lock(mutex_);
  const Command* oldest = commands_.pop();
  if (oldest == nullptr) return false;
  command = *oldest;
  return true;
}

void DdsLink::publish(const AttitudeReport& report) {
  AttitudeSample& sample = output_.attitude;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  sample.time_ns = report.time_ns;
  sample.exposure_time_ns = report.exposure_time_ns;
  sample.sequence_number = report.sequence_number;
  sample.validity = report.validity;
  sample.frames_since_reset = report.frames_since_reset;
  std::copy(report.q_lrf_trf.begin(), report.q_lrf_trf.end(), sample.q_lrf_trf);
  sample.predicted_error_urad = report.predicted_error_urad;
  std::copy(report.q_lrf_trf_single_frame.begin(), report.q_lrf_trf_single_frame.end(),
            sample.q_lrf_trf_single_frame);
  sample.predicted_error_single_frame_urad = report.predicted_error_single_frame_urad;
  output_.done.attitudes = 1;
}

void DdsLink::publish(const Housekeeping& housekeeping) {
  TelemetrySample& sample = output_.telemetry;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  sample.time_ns = housekeeping.time_ns;
  sample.mode = housekeeping.mode;
  sample.cycles = housekeeping.cycles;
  sample.commands_accepted = housekeeping.commands_accepted;
  sample.commands_refused = housekeeping.commands_refused;
  sample.frames_used = housekeeping.frames_used;
  sample.frames_missing = housekeeping.frames_missing;
  sample.frames_refused = housekeeping.frames_refused;
  sample.frames_duplicate = housekeeping.frames_duplicate;
  sample.frames_stale = housekeeping.frames_stale;
  sample.frames_bad = housekeeping.frames_bad;
  sample.sequence_gaps = housekeeping.sequence_gaps;
  sample.estimator_resets = housekeeping.estimator_resets;
  sample.events = housekeeping.events;
  sample.inference_us = housekeeping.inference_us;
  sample.inference_max_us = housekeeping.inference_max_us;
  sample.deadline_overruns = housekeeping.deadline_overruns;
  sample.heap_allocations = heap_allocations_();
  output_.done.telemetries = 1;
}

void DdsLink::publish(const Event& event) {
  if (output_.done.events == kMaxEventsPerStep) return;
  EventSample& sample = output_.events[output_.done.events];
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  sample.time_ns = event.time_ns;
  sample.id = event.id;
  sample.severity = event.severity;
  std::copy(event.arguments.begin(), event.arguments.end(), sample.arguments);
  ++output_.done.events;
}

}  // namespace tumblesight::hal::dds
