// TraceDigest: CRC-32 over what flight answered, bit for bit. Two runs with one seed have the same digest at
// any speed and load: everything that depends on the wall clock is left out.
#pragma once

#include <cstdint>

#include "gnc/numerics/crc32.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

class TraceDigest {
 public:
  // Little-endian: k, time, report, telemetry without timing and heap counters, events, state CRC.
  void add(std::uint32_t k, const StepRecord& record);
  std::uint32_t value() const { return crc_.value(); }

 private:
  void add_time(std::int64_t time_ns);
  void add_report(const hal::AttitudeReport& report);
  void add_telemetry(const hal::Telemetry& telemetry);
  void add_event(const hal::Event& event);

  gnc::Crc32 crc_;
};

}  // namespace tumblesight::sim
