// CRC-16/CCITT-FALSE (polynomial 0x1021, initial value 0xFFFF, not reflected): the checksum of telecommand
// packets.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

// Over `size_bytes` bytes from `data`. The CRC of the nine ASCII digits "123456789" is 0x29B1.
std::uint16_t crc16(const std::uint8_t* data, std::size_t size_bytes);
// `crc` continued by one more byte.
std::uint16_t crc16_append(std::uint16_t crc, std::uint8_t byte);

}  // namespace tumblesight::gnc
