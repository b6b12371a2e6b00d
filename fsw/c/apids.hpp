// The APIDs that a C caller chose.
#pragma once

#include <cstdint>

#include "fsw/c/tumblesight_c.h"
#include "hal/messages/command_packet.hpp"
#include "hal/packets/telemetry_encoder.hpp"

namespace tumblesight::fsw::c {

struct Apids {
  std::uint16_t command = hal::kCommandApid;
  hal::packets::PacketApids telemetry;

  // Whether all are in range and no two are equal.
  bool are_valid() const {
    if (command > hal::packets::kMaxApid || !hal::packets::are_valid(telemetry)) return false;
    return command != telemetry.attitude_report && command != telemetry.telemetry &&
           command != telemetry.event && command != telemetry.memory_dump;
  }
};

// All zero: the initial ones.
inline Apids apids_of(const tumblesight_apids& given) {
  if ((given.command | given.attitude_report | given.telemetry | given.event | given.memory_dump) == 0)
    return {};
  return {given.command, {given.attitude_report, given.telemetry, given.event, given.memory_dump}};
}

}  // namespace tumblesight::fsw::c
