#include "hal/dds/dds_link.hpp"

#include <algorithm>
#include <iterator>

#include "hal/dds/idl/sample_fields.hpp"

namespace tumblesight::hal::dds {

void DdsLink::authenticate_with(const CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter) {
  key_slot_ = slot;
  command_counter_ = last_counter;
  filter_.authenticate_with(keys, slot, last_counter);
}

void DdsLink::put(const CommandSample& sample) {
  // A size beyond the bytes stays visible to the application, which refuses it.
  incoming_.size = sample.size;
  std::copy(std::begin(sample.bytes), std::end(sample.bytes), incoming_.bytes.begin());
  std::uint32_t slot = 0, last_counter = 0;
  std::size_t room = 0;
  {
    const MailboxLock lock(mutex_);
    slot = key_slot_;
    last_counter = command_counter_;
    room = commands_.room();
  }
  // Without the lock: the authentication code takes longer than a copy. Meanwhile the room can only grow.
  filter_.follow(slot, last_counter);
  const bool passes = filter_.passes(incoming_, room);
  const DroppedCommands dropped = filter_.take_dropped();
  const MailboxLock lock(mutex_);
  if (passes) commands_.push() = incoming_;
  for (std::size_t why = 0; why < dropped.by.size(); ++why) dropped_.by[why] += dropped.by[why];
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

DroppedCommands DdsLink::take_dropped() {
  const MailboxLock lock(mutex_);
  const DroppedCommands dropped = dropped_;
  dropped_ = {};
  return dropped;
}

void DdsLink::publish(const AttitudeReport& report) {
  AttitudeSample& sample = output_.attitude;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  copy_attitude_fields(report, sample);
  output_.done.attitudes = 1;
}

void DdsLink::publish(const Telemetry& telemetry) {
  TelemetrySample& sample = output_.telemetry;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  copy_telemetry_fields(telemetry, sample);
  sample.heap_allocations = gauges_.heap_allocations();
  sample.stack_left_min_bytes = gauges_.stack_left_min_bytes();
  output_.done.telemetries = 1;
  const MailboxLock lock(mutex_);
  key_slot_ = telemetry.key_slot;
  command_counter_ = telemetry.command_counter;
}

void DdsLink::publish(const Event& event) {
  if (output_.done.events == kMaxEventsPerStep) return;
  EventSample& sample = output_.events[output_.done.events];
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  copy_event_fields(event, sample);
  ++output_.done.events;
}

void DdsLink::publish(const MemoryDump& dump) {
  MemoryDumpSample& sample = output_.dump;
  sample.run_id = output_.done.run_id;
  sample.k = output_.done.k;
  copy_memory_dump_fields(dump, sample);
  output_.done.dumps = 1;
}

}  // namespace tumblesight::hal::dds
