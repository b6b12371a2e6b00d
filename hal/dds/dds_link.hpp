// DdsLink: commands of topic sil/command in; attitude, telemetry, events and dumps out to sil/attitude,
// sil/telemetry, sil/event and sil/memory_dump. The flight task is on one side of it, the bus thread, which
// speaks DDS, on the other.
#pragma once

#include <array>
#include <cstdint>

#include "hal/command_filter.hpp"
#include "hal/dds/idl/topics.hpp"
#include "hal/dds/mailbox_lock.hpp"
#include "hal/fixed_queue.hpp"
#include "hal/link.hpp"

namespace tumblesight::hal::dds {

// What the flight task publishes in one cycle.
struct CycleOutput {
  StepDoneSample done{};  // with the number of samples below
  AttitudeSample attitude{};
  TelemetrySample telemetry{};
  std::array<EventSample, kMaxEventsPerStep> events{};
  MemoryDumpSample dump{};
};

class DdsLink final : public Link {
 public:
  // Measurements of the flight task that only the platform can make; they go into the telemetry.
  struct Gauges {
    std::uint32_t (*heap_allocations)();
    std::uint32_t (*stack_left_min_bytes)();
  };

  explicit DdsLink(const Gauges& gauges) : gauges_(gauges) {}

  // Before the threads start. From now on only authentic commands are queued. `slot`, `last_counter`: those
  // of the application after its boot.
  void authenticate_with(const CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter);

  // Bus thread. Queues the command, or drops and counts it.
  void put(const CommandSample& sample);
  // Takes the output of the oldest cycle that has ended. False: there is none.
  bool take_output(CycleOutput& output);

  // Flight task. Everything published between begin_cycle() and end_cycle() belongs to cycle `k`.
  void begin_cycle(std::uint32_t run_id, std::uint32_t k);
  void end_cycle(std::uint32_t state_crc32);
  [[nodiscard]] bool receive(CommandPacket& command) override;
  DroppedCommands take_dropped() override;
  void publish(const AttitudeReport& report) override;
  void publish(const Telemetry& telemetry) override;
  void publish(const Event& event) override;
  void publish(const MemoryDump& dump) override;

 private:
  Gauges gauges_;
  CommandFilter filter_;    // bus thread
  CommandPacket incoming_;  // bus thread
  CycleOutput output_;      // of the current cycle
  MailboxMutex mutex_;
  // What the application accepts, by its last telemetry.
  std::uint32_t key_slot_ = 0;
  std::uint32_t command_counter_ = 0;
  DroppedCommands dropped_;
  FixedQueue<CommandPacket, 2 * kMaxCommandsPerStep> commands_;
  FixedQueue<CycleOutput, 4> outputs_;
};

}  // namespace tumblesight::hal::dds
