// Link: telecommands in, telemetry out. The messages are in hal/messages; docs/icd.md describes them.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/attitude_report.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/memory_dump.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::hal {

// Commands that a link has dropped since the last call, by CommandRefusal. The application counts and reports
// them.
struct DroppedCommands {
  std::array<std::uint32_t, kCommandRefusals> by{};
};

class Link {
 public:
  // Never blocks. True: `command` is the oldest command not yet delivered.
  [[nodiscard]] virtual bool receive(CommandPacket& command) = 0;
  // A link that queues commands must keep room for genuine ones: it drops what is not authentic
  // (hal/command_filter.hpp) before it queues it, and counts every drop.
  virtual DroppedCommands take_dropped() { return {}; }
  // Called in this order in each cycle: one report, one telemetry, any number of events (at most
  // fsw::config::kMaxEventsPerStep), at most one dump. Must not block.
  virtual void publish(const AttitudeReport& report) = 0;
  virtual void publish(const Telemetry& telemetry) = 0;
  virtual void publish(const Event& event) = 0;
  virtual void publish(const MemoryDump& dump) = 0;

 protected:
  ~Link() = default;
};

}  // namespace tumblesight::hal
