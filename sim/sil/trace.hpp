// TraceDigest: CRC-32 over the answers of the flight program, bit for bit. Two runs with the same seed have
// the same digest at any speed and load, because everything that depends on the wall clock is left out.
#pragma once

#include <cstdint>

#include "gnc/numerics/crc.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

class TraceDigest {
 public:
  // Little-endian: k, time, report, telemetry without timing and heap counters, events, state CRC.
  void add(std::uint32_t k, const StepResult& step);
  std::uint32_t value() const { return crc_.value(); }

 private:
  void add_time(std::int64_t time_ns);
  template <class Numbers>
  void add_all(const Numbers& numbers) {
    for (const std::int32_t number : numbers) crc_.add_u32(static_cast<std::uint32_t>(number));
  }
  void add_report(const hal::AttitudeReport& report);
  void add_telemetry(const hal::Telemetry& telemetry);
  void add_event(const hal::Event& event);

  gnc::Crc32 crc_;
};

}  // namespace tumblesight::sim
