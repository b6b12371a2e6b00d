// PacketSink: where a platform sends its telemetry packets: a radio, a recorder, a file.
#pragma once

#include "hal/packets/telemetry_encoder.hpp"

namespace tumblesight::hal::packets {

class PacketSink {
 public:
  // Must not block. False: the packet is lost.
  virtual bool put(const TelemetryPacket& packet) = 0;

 protected:
  ~PacketSink() = default;
};

}  // namespace tumblesight::hal::packets
