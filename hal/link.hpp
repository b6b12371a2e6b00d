// Link: telecommands in, telemetry out. The structures are the flight side's view of the ICD (docs/icd.md).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

struct Command {
  static constexpr int kMaxPayload = 32;
  std::uint16_t opcode = 0;
  std::uint8_t payload_size = 0;
  std::array<std::uint8_t, kMaxPayload> payload{};
};

// Answer to one cycle. Quaternions scalar first (w, x, y, z), TRF to LRF, unit, with 30 bits behind the point.
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

struct Housekeeping {
  std::int64_t time_ns = 0;
  std::uint8_t mode = 0;  // fsw::Mode
  std::uint32_t cycles = 0;
  std::uint32_t commands_accepted = 0;
  std::uint32_t commands_refused = 0;
  std::uint32_t frames_used = 0;
  std::uint32_t frames_missing = 0;
  std::uint32_t frames_refused = 0;    // all refusals: the kinds below and bad content
  std::uint32_t frames_duplicate = 0;  // sequence number repeated
  std::uint32_t frames_stale = 0;      // exposure too old, in the future, or not after the previous one
  std::uint32_t frames_bad = 0;        // empty, flat, wrong ray count, field of view or size
  std::uint32_t sequence_gaps = 0;     // sequence numbers skipped
  std::uint32_t estimator_resets = 0;
  std::uint32_t events = 0;
  std::uint32_t inference_us = 0;  // last step of the estimator, by the stopwatch; not part of any digest
  std::uint32_t inference_max_us = 0;
  std::uint32_t deadline_overruns = 0;
  std::uint32_t heap_allocations = 0;  // of the flight task since init, where the platform can count them
};

struct Event {
  std::int64_t time_ns = 0;
  std::uint16_t id = 0;       // fsw::EventId, stable
  std::uint8_t severity = 0;  // 0 information, 1 warning, 2 error
  std::array<std::int32_t, 3> arguments{};
};

class Link {
 public:
  // Never blocks. True: `command` holds the oldest one not yet delivered.
  [[nodiscard]] virtual bool receive(Command& command) = 0;
  virtual void publish(const AttitudeReport& report) = 0;
  virtual void publish(const Housekeeping& housekeeping) = 0;
  virtual void publish(const Event& event) = 0;

 protected:
  ~Link() = default;
};

}  // namespace tumblesight::hal
