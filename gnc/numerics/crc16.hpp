// CRC-16/CCITT-FALSE, the checksum of telecommand packets: polynomial 0x1021, initial value 0xFFFF, not
// reflected, no final complement.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

// CRC of `size_bytes` bytes at `data`. No bytes give 0xFFFF; the nine ASCII digits "123456789" give 0x29B1.
std::uint16_t crc16(const std::uint8_t* data, std::size_t size_bytes);
// Extends `crc` by one byte.
std::uint16_t crc16_append(std::uint16_t crc, std::uint8_t byte);

}  // namespace tumblesight::gnc
