// Platform: what the flight application uses from the machine that it runs on. All pointers must stay valid
// as long as the application.
#pragma once

#include <cstdint>

#include "hal/messages/command_key.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/reset_cause.hpp"
#include "hal/model_store.hpp"
#include "hal/persistent_store.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal {

struct Platform {
  Stopwatch* stopwatch = nullptr;
  ModelStore* models = nullptr;
  // Copied by init(). nullptr: the link delivers authentic telecommands only, without a security trailer.
  const CommandKeys* command_keys = nullptr;
  // nullptr: nothing is kept. After a reset old telecommands can then be replayed, and the mode, the bank,
  // the limits and the responses are those of a first start.
  PersistentStore* persistent = nullptr;
  // Unknown is abnormal: the application then starts in STANDBY.
  ResetCause reset_cause = ResetCause::kOther;
  // A packet with another one is no telecommand. At most 0x7FF.
  std::uint16_t command_apid = kCommandApid;
};

}  // namespace tumblesight::hal
