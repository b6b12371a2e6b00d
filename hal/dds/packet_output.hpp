// PacketOutput: writes what a cycle publishes a second time, as telemetry packets.
#pragma once

#include "hal/dds/dds_link.hpp"
#include "hal/packets/packet_sink.hpp"

namespace tumblesight::hal::dds {

class PacketOutput {
 public:
  explicit PacketOutput(packets::PacketSink& sink) : sink_(sink) {}

  // The packets leave in the order in which the application publishes: attitude, telemetry, events, dump.
  void put(const CycleOutput& output);

 private:
  packets::PacketSink& sink_;
  packets::TelemetryEncoder encoder_;
};

}  // namespace tumblesight::hal::dds
