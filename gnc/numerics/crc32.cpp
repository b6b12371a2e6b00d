#include "gnc/numerics/crc32.hpp"

#include <array>
#include <cstring>

namespace tumblesight::gnc {
namespace {

constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit)
      remainder = (remainder >> 1) ^ ((remainder & 1U) != 0 ? 0xEDB88320U : 0U);
    table[byte] = remainder;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kTable = make_table();

}  // namespace

std::uint32_t crc32(const std::uint8_t* data, std::size_t size_bytes) {
  Crc32 crc;
  crc.add(data, size_bytes);
  return crc.value();
}

void Crc32::add(const std::uint8_t* data, std::size_t size_bytes) {
  std::uint32_t remainder = remainder_;
  for (std::size_t i = 0; i < size_bytes; ++i)
    remainder = (remainder >> 8) ^ kTable[(remainder ^ data[i]) & 0xFFU];
  remainder_ = remainder;
}

void Crc32::add_u32(std::uint32_t value) {
  const std::array<std::uint8_t, 4> bytes{
      static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
      static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
  add(bytes.data(), bytes.size());
}

void Crc32::add_f32(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    add_u32(bits);
  }
}

}  // namespace tumblesight::gnc
