// Link: telecommands in, telemetry out. The structures are the flight side's view of the ICD (docs/icd.md).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

// A telecommand as it came in, with its security trailer; fsw/app/telecommand.hpp says what the bytes mean.
struct CommandPacket {
  static constexpr int kMaxBytes = 1060;
  std::uint16_t size =
      0;  // a greater one than kMaxBytes stays visible to the application, which refuses the packet
  std::array<std::uint8_t, kMaxBytes> bytes{};
};

// Answer to one cycle. Quaternions scalar first (w, x, y, z), TRF to LRF, unit, with 30 bits behind the
// point.
struct AttitudeReport {
  std::int64_t time_ns = 0;           // time of the cycle
  std::int64_t exposure_time_ns = 0;  // of the frame that the attitude belongs to
  std::uint32_t sequence_number = 0;  // likewise
  std::uint8_t validity = 0;          // fsw::Validity
  std::uint32_t frames_since_reset = 0;
  std::array<std::int32_t, 4> q_lrf_trf{1 << 30, 0, 0, 0};
  std::uint32_t predicted_error_urad = 0;
  std::array<std::int32_t, 4> q_lrf_trf_single_frame{1 << 30, 0, 0, 0};
  std::uint32_t predicted_error_single_frame_urad = 0;
};

// Counters saturate.
struct Housekeeping {
  static constexpr int kRefusals = 10;     // fsw::CommandRefusal
  static constexpr int kStepTimeBins = 8;  // below 1, 3, 10, 30, 100, 300, 1000 ms, and the rest
  static constexpr int kBanks = 2;

  std::int64_t time_ns = 0;
  std::uint8_t mode = 0;                 // fsw::Mode
  std::uint8_t safe_cause = 0;           // fsw::Cause that led to SAFE last; 0: none since start
  std::uint8_t safe_fault = 0;           // fsw::Fault, if the cause is one
  std::uint32_t faults_persisting = 0;   // bit n: fsw::Fault n
  std::uint32_t responses_disabled = 0;  // likewise
  std::uint32_t cycles = 0;

  std::uint32_t commands_accepted = 0;
  std::uint32_t commands_refused = 0;
  std::array<std::uint32_t, kRefusals> commands_refused_by{};
  std::uint32_t command_counter = 0;  // of the last authentic command

  std::uint32_t frames_used = 0;
  std::uint32_t frames_missing = 0;
  std::uint32_t frames_refused =
      0;  // all refusals: the kinds below, and frames of the cycle that lost the model
  std::uint32_t frames_duplicate = 0;  // sequence number repeated
  std::uint32_t frames_stale = 0;      // exposure too old, in the future, or not after the previous one
  std::uint32_t frames_bad = 0;        // empty, flat, wrong ray count, field of view or size
  std::uint32_t sequence_gaps = 0;     // sequence numbers skipped
  std::uint32_t estimator_resets = 0;
  std::uint32_t attitudes_doubtful = 0;

  std::uint32_t events = 0;             // all: told, waiting, suppressed and lost
  std::uint32_t events_suppressed = 0;  // too many of a kind
  std::uint32_t events_lost = 0;        // no room
  std::uint32_t events_waiting = 0;
  std::uint32_t events_waiting_max = 0;

  std::uint32_t memory_corrections = 0;  // words of the voted state
  std::uint32_t states_restored = 0;     // estimator's state, from its copy
  std::uint32_t states_lost = 0;         // likewise, and its copy hit too
  std::uint32_t constants_reloaded = 0;
  std::uint32_t model_blocks_repaired = 0;
  std::uint32_t model_blocks_lost = 0;
  std::uint32_t model_tables_rebuilt = 0;
  std::uint32_t model_passes = 0;  // whole checks of the model in use
  std::uint32_t bank_switches = 0;

  std::uint8_t bank_in_use = 0;
  std::uint8_t second_copy = 0;                    // 1: the other bank holds the same image
  std::array<std::uint8_t, kBanks> bank_status{};  // fsw::BankStatus
  std::array<std::uint32_t, kBanks> bank_crc32{};  // header CRC-32 of the image in it
  std::uint32_t model_bytes_loaded = 0;            // of the image that is coming in

  std::uint32_t inference_us = 0;  // last step of the estimator, by the stopwatch; not part of any digest
  std::uint32_t inference_max_us = 0;
  std::uint32_t step_us = 0;  // this step, but for the vote before it and the telemetry at its end
  std::uint32_t step_max_us = 0;
  std::array<std::uint32_t, kStepTimeBins> steps_by_time{};
  std::uint32_t deadline_overruns = 0;
  std::uint32_t cycle_slips = 0;
  std::uint32_t heap_allocations = 0;  // of the flight task since init, where the platform can count them
  std::uint32_t stack_left_min_bytes =
      0;  // of the flight task's stack, never used so far; 0: the platform does not measure it
};

// Events that differ from run to run, and belong in no digest.
constexpr bool tells_of_wall_clock(std::uint16_t event_id) {
  return event_id > 20 && event_id < 30;
}

struct Event {
  std::int64_t time_ns = 0;
  std::uint16_t id = 0;       // fsw::EventId, stable
  std::uint8_t severity = 0;  // 0 information, 1 warning, 2 error
  std::array<std::int32_t, 3> arguments{};
};

// Part of a model bank, as MODEL_DUMP asked for.
struct ModelDump {
  static constexpr int kMaxBytes = 1024;
  std::int64_t time_ns = 0;
  std::uint8_t bank = 0;
  std::uint32_t offset = 0;
  std::uint16_t size = 0;
  std::array<std::uint8_t, kMaxBytes> bytes{};
};

class Link {
 public:
  // Never blocks. True: `command` holds the oldest one not yet delivered.
  [[nodiscard]] virtual bool receive(CommandPacket& command) = 0;
  virtual void publish(const AttitudeReport& report) = 0;
  virtual void publish(const Housekeeping& housekeeping) = 0;
  virtual void publish(const Event& event) = 0;
  virtual void publish(const ModelDump& dump) = 0;

 protected:
  ~Link() = default;
};

}  // namespace tumblesight::hal
