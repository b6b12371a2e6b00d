// ModelDump: a part of a model bank, the answer to MODEL_DUMP.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/command_packet.hpp"

namespace tumblesight::hal {

struct ModelDump {
  static constexpr int kMaxBytes = kMaxModelSegmentBytes;
  std::int64_t time_ns = 0;  // cycle time
  std::uint8_t bank = 0;
  std::uint32_t offset = 0;  // in the bank, bytes
  std::uint16_t size = 0;    // valid bytes; the others are 0
  std::array<std::uint8_t, kMaxBytes> bytes{};
};

}  // namespace tumblesight::hal
