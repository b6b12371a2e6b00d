// The flight side's handshake on sil/hello. Both sides announce themselves with the hash of the interface
// definition, the target and the model image. Steps begin when these agree and every endpoint is matched with
// the simulator's.
#pragma once

#include <cstdint>

#include "hal/dds/flight_endpoints.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/dds/idl/hello.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

struct HandshakeSettings {
  std::uint32_t icd_hash = 0;
  std::uint32_t run_id = 0;           // 0: that of the first simulator found
  std::uint8_t mode = 0;              // hal::Mode, reported to the simulator
  std::uint32_t command_counter = 0;  // of the last authentic command, reported to the simulator
  const char* target = "";            // must be the simulator's
  std::uint32_t model_crc32 = 0;      // of the image in use, must be the simulator's; 0: there is none
  std::int64_t timeout_ns = 0;
};

struct HandshakeResult {
  FlightEnd end = FlightEnd::kComplete;  // kComplete: ready for step 0
  bool stopped = false;                  // kComplete because of a stop request: there is no run
  std::uint32_t run_id = 0;              // the simulator's
  HelloSample hello{};                   // the simulator's
  HelloFit fit = HelloFit::kFits;        // what differs, if the two hellos were compared
  PeerKey simulator{};                   // all readers are bound to it
  bool saw_other_run = false;            // in the same domain, in a partition of its own
  Foreigner foreigner{};                 // kForeign, kSecondFlight: who else announced itself
};

// Blocks until the handshake is complete or has failed, at most `timeout_ns`.
HandshakeResult shake_hands(FlightEndpoints& endpoints, const HandshakeSettings& settings,
                            Stopwatch& stopwatch);

}  // namespace tumblesight::hal::dds
