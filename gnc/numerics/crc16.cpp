#include "gnc/numerics/crc16.hpp"

namespace tumblesight::gnc {

std::uint16_t crc16_append(std::uint16_t crc, std::uint8_t byte) {
  std::uint32_t remainder = crc ^ (std::uint32_t{byte} << 8);
  for (int bit = 0; bit < 8; ++bit)
    remainder = (remainder << 1) ^ ((remainder & 0x8000U) != 0 ? 0x1021U : 0U);
  return static_cast<std::uint16_t>(remainder);
}

std::uint16_t crc16(const std::uint8_t* data, std::size_t size_bytes) {
  std::uint16_t crc = 0xFFFF;
  for (std::size_t i = 0; i < size_bytes; ++i) crc = crc16_append(crc, data[i]);
  return crc;
}

}  // namespace tumblesight::gnc
