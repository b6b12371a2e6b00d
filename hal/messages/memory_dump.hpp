// MemoryDump: a part of the memory that the ground can read, the answer to MEMORY_DUMP.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/command_packet.hpp"

namespace tumblesight::hal {

// What can be read.
enum class DumpedMemory : std::uint8_t {
  kBank0 = 0,            // a model bank
  kBank1 = 1,            // a model bank
  kMissingSegments = 2,  // of the upload: bit 7 of byte 0 is segment 0; 1: missing
  kActiveTable = 3,      // the parameter table
  kLoadedTable = 4,      // the one that was uplinked
};

struct MemoryDump {
  static constexpr int kMaxBytes = kMaxModelSegmentBytes;
  std::int64_t time_ns = 0;  // cycle time
  DumpedMemory memory = DumpedMemory::kBank0;
  std::uint32_t offset = 0;  // in this memory, bytes
  std::uint16_t size = 0;    // valid bytes; the others are 0
  std::array<std::uint8_t, kMaxBytes> bytes{};
};

}  // namespace tumblesight::hal
