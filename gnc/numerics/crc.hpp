// Checksums.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

// CRC-16/CCITT-FALSE, the checksum of telecommand packets: polynomial 0x1021, initial value 0xFFFF, not
// reflected, no final complement.
// CRC of `size_bytes` bytes at `data`. No bytes give 0xFFFF; the nine ASCII digits "123456789" give 0x29B1.
std::uint16_t crc16(const std::uint8_t* data, std::size_t size_bytes);
// Extends `crc` by one byte.
std::uint16_t crc16_append(std::uint16_t crc, std::uint8_t byte);

// CRC-32 (IEEE 802.3): reflected polynomial 0xEDB88320, initial value and final complement all ones.
// CRC of `size_bytes` bytes at `data`. No bytes give 0; the nine ASCII digits "123456789" give 0xCBF43926.
std::uint32_t crc32(const std::uint8_t* data, std::size_t size_bytes);

// The same CRC over data that arrives in pieces. Numbers are added as little-endian bytes, so that the CRC of
// values is the same on every host.
class Crc32 {
 public:
  void add(const std::uint8_t* data, std::size_t size_bytes);
  void add_u32(std::uint32_t value);
  void add_f32(const float* values, std::size_t count);  // the bits of `count` IEEE 754 floats
  std::uint32_t value() const { return ~remainder_; }    // of everything added so far; more may be added

 private:
  std::uint32_t remainder_ = 0xFFFFFFFFU;
};

}  // namespace tumblesight::gnc
