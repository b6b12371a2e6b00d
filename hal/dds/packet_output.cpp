#include "hal/dds/packet_output.hpp"

#include "hal/dds/idl/sample_fields.hpp"

namespace tumblesight::hal::dds {

void PacketOutput::put(const CycleOutput& output) {
  if (output.done.attitudes > 0) {
    AttitudeReport report;
    copy_attitude_fields(output.attitude, report);
    sink_.put(encoder_.encode(report));
  }
  if (output.done.telemetries > 0) {
    Telemetry telemetry;
    copy_telemetry_fields(output.telemetry, telemetry);
    sink_.put(encoder_.encode(telemetry));
  }
  for (std::uint8_t i = 0; i < output.done.events; ++i) {
    Event event;
    copy_event_fields(output.events[i], event);
    sink_.put(encoder_.encode(event));
  }
  if (output.done.dumps > 0) {
    MemoryDump dump;
    copy_memory_dump_fields(output.dump, dump);
    sink_.put(encoder_.encode(dump));
  }
}

}  // namespace tumblesight::hal::dds
