#include "hal/dds/dds_link.hpp"

#include <algorithm>
#include <iterator>

#include "hal/dds/idl/telemetry_fields.hpp"

namespace tumblesight::hal::dds {

static_assert(tumblesight_icd_COMMAND_BYTES == CommandPacket::kMaxBytes, "the ICD's command is the link's");
static_assert(tumblesight_icd_DUMP_BYTES == ModelDump::kMaxBytes, "the ICD's dump is the link's");
static_assert(tumblesight_icd_REFUSALS == Housekeeping::kRefusals);
static_assert(tumblesight_icd_STEP_TIME_BINS == Housekeeping::kStepTimeBins);
static_assert(tumblesight_icd_BANKS == Housekeeping::kBanks);

void DdsLink::put(const CommandSample& sample) {
  const MailboxLock lock(mutex_);
  CommandPacket& command = commands_.push();
  // A size beyond the bytes stays visible to the application, which refuses it.
  command.size = sample.size;
  std::copy(std::begin(sample.bytes), std::end(sample.bytes), command.bytes.begin());
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

bool DdsLink::receive(CommandPacket& command) {
  const MailboxLock lock(mutex_);
  const CommandPacket* oldest = commands_.pop();
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
  copy_telemetry(housekeeping, sample);
  sample.heap_allocations = gauges_.heap_allocations();
  sample.stack_left_min_bytes = gauges_.stack_left_min_bytes();
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

void DdsLink::publish(const ModelDump& dump) {
  ModelDumpSample& sample = output_.dump;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  sample.time_ns = dump.time_ns;
  sample.bank = dump.bank;
  sample.offset = dump.offset;
  sample.size = dump.size;
  std::copy(dump.bytes.begin(), dump.bytes.end(), sample.bytes);
  output_.done.dumps = 1;
}

}  // namespace tumblesight::hal::dds
