// The constants of MCAP files, shared by their reader and writer (https://mcap.dev/spec).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::sim {

inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum McapOpcode : std::uint8_t {
  kMcapInvalid = 0,
  kMcapHeader = 1,
  kMcapFooter = 2,
  kMcapSchema = 3,
  kMcapChannel = 4,
  kMcapMessage = 5,
  kMcapChunk = 6,
  kMcapMessageIndex = 7,
  kMcapChunkIndex = 8,
  kMcapStatistics = 11,
  kMcapSummaryOffset = 14,
  kMcapDataEnd = 15,
};

}  // namespace tumblesight::sim
