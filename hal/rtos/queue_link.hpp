// QueueLink: telecommands in and telemetry packets out over message queues of a real-time operating system.
// The flight task is on one side. On the other, the task of the uplink puts commands in, and the task of the
// downlink takes packets out.
//
// Queue<T, kDepth> is a message queue of the system (rtems/rtems_queue.hpp, zephyr/zephyr_queue.hpp) that any
// task may use. None of its functions blocks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/command_filter.hpp"
#include "hal/link.hpp"
#include "hal/packets/telemetry_encoder.hpp"

namespace tumblesight::hal::rtos {

template <template <class, std::size_t> class Queue>
class QueueLink final : public Link {
 public:
  static constexpr std::size_t kMaxCommands = 16;
  static constexpr std::size_t kMaxPackets = 40;  // of two cycles

  explicit QueueLink(const packets::PacketApids& apids = {}) : encoder_(apids) {}

  // Creates the queues. False: the system refused one.
  [[nodiscard]] bool open() {
    return commands_.open() && dropped_.open() && packets_.open() && accepted_.open();
  }
  // Before the other tasks start. From now on only authentic commands are queued. `slot`, `last_counter`:
  // those of the application after its boot.
  void authenticate_with(const CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter) {
    filter_.authenticate_with(keys, slot, last_counter);
  }

  // Uplink. Queues the command, or drops and counts it.
  void put(const CommandPacket& command) {
    Accepted newest;
    if (accepted_.receive(newest)) filter_.follow(newest.key_slot, newest.counter);
    const bool passes = filter_.passes(command, commands_.room());
    if (passes && commands_.send(command)) return;
    DroppedCommands dropped = filter_.take_dropped();
    if (passes) ++dropped.by[static_cast<std::size_t>(CommandRefusal::kNoRoom)];
    const DroppedCommands waiting = take_dropped();
    for (std::size_t why = 0; why < dropped.by.size(); ++why) dropped.by[why] += waiting.by[why];
    static_cast<void>(dropped_.send(dropped));  // its place is free: only the uplink sends
  }
  // Downlink. False: no packet waits.
  [[nodiscard]] bool take(packets::TelemetryPacket& packet) { return packets_.receive(packet); }

  // Flight task.
  [[nodiscard]] bool receive(CommandPacket& command) override { return commands_.receive(command); }
  DroppedCommands take_dropped() override {
    DroppedCommands dropped;
    return dropped_.receive(dropped) ? dropped : DroppedCommands{};
  }
  void publish(const AttitudeReport& report) override { send(encoder_.encode(report)); }
  void publish(const Telemetry& telemetry) override {
    Accepted older;
    static_cast<void>(accepted_.receive(older));  // the uplink needs the newest only
    static_cast<void>(accepted_.send({telemetry.key_slot, telemetry.command_counter}));
    send(encoder_.encode(telemetry));
  }
  void publish(const Event& event) override { send(encoder_.encode(event)); }
  void publish(const MemoryDump& dump) override { send(encoder_.encode(dump)); }
  // Packets for which the queue had no room. The ground sees them as gaps in the sequence counts.
  std::uint32_t packets_lost() const { return packets_lost_; }

 private:
  // What the application accepts, by its last telemetry.
  struct Accepted {
    std::uint32_t key_slot = 0;
    std::uint32_t counter = 0;
  };

  void send(const packets::TelemetryPacket& packet) {
    if (!packets_.send(packet)) ++packets_lost_;
  }

  CommandFilter filter_;               // uplink
  packets::TelemetryEncoder encoder_;  // flight task
  std::uint32_t packets_lost_ = 0;     // flight task
  Queue<CommandPacket, kMaxCommands> commands_;
  Queue<DroppedCommands, 1> dropped_;
  Queue<packets::TelemetryPacket, kMaxPackets> packets_;
  Queue<Accepted, 1> accepted_;
};

}  // namespace tumblesight::hal::rtos
