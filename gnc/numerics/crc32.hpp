// CRC-32 (IEEE 802.3: reflected polynomial 0xEDB88320, initial value and final complement all ones).
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::gnc {

std::uint32_t crc32(const std::uint8_t* data, std::size_t size_bytes);

// The same over data that comes in pieces. Numbers are taken little-endian, so that a CRC over values is the
// same on every host.
class Crc32 {
 public:
  void add(const std::uint8_t* data, std::size_t size_bytes);
  void add_u32(std::uint32_t value);
  void add_f32(const float* values, std::size_t count);
  std::uint32_t value() const { return ~remainder_; }

 private:
  std::uint32_t remainder_ = 0xFFFFFFFFU;
};

}  // namespace tumblesight::gnc
