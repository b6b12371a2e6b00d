// The flight side's handshake on sil/hello: both sides announce themselves with the hash of the interface
// definition; steps begin once the hashes agree and every reader has found its writer.
#pragma once

#include <cstdint>

#include "hal/dds/flight_endpoints.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

struct HandshakeSettings {
  std::uint32_t icd_hash = 0;
  std::uint32_t run_id = 0;  // 0: that of the first simulator that shows up
  std::uint8_t mode = 0;     // fsw::Mode, for the simulator to know what it meets
  std::int64_t timeout_ns = 0;
};

struct HandshakeResult {
  FlightEnd end = FlightEnd::kComplete;  // kComplete: ready for step 0
  bool stopped = false;                  // kComplete, but because somebody asked to stop
  std::uint32_t run_id = 0;              // of the simulator
  std::uint32_t simulator_icd_hash = 0;
};

HandshakeResult shake_hands(FlightEndpoints& endpoints, const HandshakeSettings& settings,
                            Stopwatch& stopwatch);

}  // namespace tumblesight::hal::dds
