// The HAL of a step from C: it hands over what the inputs hold and takes what the application publishes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fsw/c/tumblesight_c.h"
#include "hal/command_queue.hpp"
#include "hal/lidar.hpp"
#include "hal/link.hpp"
#include "hal/model_store.hpp"
#include "hal/navigation.hpp"
#include "hal/persistent_store.hpp"
#include "hal/stopwatch.hpp"
#include "hal/watchdog.hpp"

namespace tumblesight::fsw::c {

class InputsLidar final : public hal::Lidar {
 public:
  void begin(const tumblesight_inputs& inputs) {
    inputs_ = &inputs;
    next_ = 0;
  }
  hal::LidarStatus receive(gnc::RangeImage& frame) override;
  std::uint32_t take_dropped() override { return inputs_->frames_dropped; }

 private:
  const tumblesight_inputs* inputs_ = nullptr;
  std::size_t next_ = 0;
};

class InputsNavigation final : public hal::Navigation {
 public:
  void begin(const tumblesight_inputs& inputs) { inputs_ = &inputs; }
  gnc::ChaserAttitude attitude_at(std::int64_t time_ns) override;

 private:
  const tumblesight_inputs* inputs_ = nullptr;
};

// Commands in, messages out.
class InputsLink final : public hal::Link {
 public:
  // From now on only authentic commands are queued.
  void authenticate_with(const hal::CommandKeys& keys, std::uint32_t slot, std::uint32_t last_counter) {
    queue_.authenticate_with(keys, slot, last_counter);
  }
  // Queues the command, or drops and counts it: false.
  bool put(const std::uint8_t* bytes, std::size_t size_bytes) { return queue_.put(bytes, size_bytes); }
  // Queues the commands of the inputs, too.
  void begin(const tumblesight_inputs& inputs, tumblesight_outputs& outputs);
  bool receive(hal::CommandPacket& command) override;
  hal::DroppedCommands take_dropped() override;
  void publish(const hal::AttitudeReport& report) override;
  void publish(const hal::Telemetry& telemetry) override;
  void publish(const hal::Event& event) override;
  void publish(const hal::MemoryDump& dump) override;

 private:
  hal::CommandQueue<TUMBLESIGHT_COMMAND_PLACES> queue_;
  tumblesight_outputs* outputs_ = nullptr;
  std::uint32_t dropped_by_caller_ = 0;
};

class OutputsWatchdog final : public hal::Watchdog {
 public:
  explicit OutputsWatchdog(tumblesight_outputs& outputs) : outputs_(outputs) {}
  void kick() override { outputs_.duties_done = true; }

 private:
  tumblesight_outputs& outputs_;
};

// The caller's stopwatch, banks and store.
class CallerStopwatch final : public hal::Stopwatch {
 public:
  explicit CallerStopwatch(const tumblesight_settings& settings) : settings_(settings) {}
  std::uint64_t now_ns() override {
    return settings_.stopwatch_ns == nullptr ? 0 : settings_.stopwatch_ns(settings_.context);
  }

 private:
  const tumblesight_settings& settings_;
};

class CallerModelStore final : public hal::ModelStore {
 public:
  explicit CallerModelStore(const tumblesight_settings& settings) : settings_(settings) {}
  hal::ModelBank bank(int index) override;
  hal::WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                         std::uint32_t count) override;

 private:
  const tumblesight_settings& settings_;
};

class CallerPersistentStore final : public hal::PersistentStore {
 public:
  explicit CallerPersistentStore(const tumblesight_settings& settings) : settings_(settings) {}
  hal::StoreStatus read(int copy, hal::StoredBytes& bytes) override;
  hal::StoreStatus write(int copy, const hal::StoredBytes& bytes) override;

 private:
  const tumblesight_settings& settings_;
};

}  // namespace tumblesight::fsw::c
