// ConsoleLink: telemetry as lines of text on the board's console, and a digest of everything that must be the
// same on every processor. It delivers no commands.
#pragma once

#include <cstdint>

#include "gnc/numerics/crc.hpp"
#include "hal/link.hpp"

namespace tumblesight::hal::replay {

class ConsoleLink final : public Link {
 public:
  bool receive(CommandPacket&) override { return false; }
  void publish(const AttitudeReport& report) override;
  void publish(const Telemetry& telemetry) override;
  void publish(const Event& event) override;
  void publish(const MemoryDump&) override {}  // only a command requests a dump

  // Of every report and event so far; `state_crc32` joins it.
  void digest(std::uint32_t state_crc32) { crc_.add_u32(state_crc32); }
  std::uint32_t digest() const { return crc_.value(); }
  // The next report belongs to this frame. The report of a refused frame does not tell which one it is.
  void announce(std::uint32_t sequence_number) { announced_ = sequence_number; }

 private:
  gnc::Crc32 crc_;
  AttitudeReport report_;
  std::uint32_t announced_ = 0;
};

}  // namespace tumblesight::hal::replay
