// Numbers as bytes for the page, which reads them with typed arrays.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace tumblesight::sim {

inline void put_u16(std::string& bytes, std::uint16_t value) {
  bytes += static_cast<char>(value & 0xFF);
  bytes += static_cast<char>(value >> 8);
}
inline void put_u32(std::string& bytes, std::uint32_t value) {
  put_u16(bytes, static_cast<std::uint16_t>(value & 0xFFFF));
  put_u16(bytes, static_cast<std::uint16_t>(value >> 16));
}
inline void put_f32(std::string& bytes, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(bytes, bits);
}

}  // namespace tumblesight::sim
