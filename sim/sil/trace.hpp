// TraceDigest: CRC-32 over the answers of the flight program, bit for bit. Two runs with the same seed have
// the same digest at any speed and load.
#pragma once

#include <cstdint>

#include "gnc/numerics/crc.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

class TraceDigest {
 public:
  // k, time, report, telemetry, events and state CRC, as hal/messages/message_digest.hpp adds them.
  void add(std::uint32_t k, const StepResult& step);
  std::uint32_t value() const { return crc_.value(); }

 private:
  gnc::Crc32 crc_;
};

}  // namespace tumblesight::sim
