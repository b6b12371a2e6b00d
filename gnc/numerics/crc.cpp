#include "gnc/numerics/crc.hpp"

#include <array>
#include <cstring>

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

namespace {

using Table = std::array<std::uint32_t, 256>;

// Table n: the remainder of a byte that is followed by n bytes of zeros.
constexpr std::array<Table, 4> make_tables() {
  std::array<Table, 4> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int n = 0; n < 4; ++n) {
      for (int bit = 0; bit < 8; ++bit)
        remainder = (remainder >> 1) ^ ((remainder & 1U) != 0 ? 0xEDB88320U : 0U);
      tables[static_cast<std::size_t>(n)][byte] = remainder;
    }
  }
  return tables;
}

constexpr std::array<Table, 4> kTables = make_tables();

// Four bytes at once, the first one in the lowest bits of `word` (slicing by 4: Kounavis and Berry, 2005).
std::uint32_t after_word(std::uint32_t remainder, std::uint32_t word) {
  const std::uint32_t mixed = remainder ^ word;
  return kTables[3][mixed & 0xFFU] ^ kTables[2][mixed >> 8 & 0xFFU] ^ kTables[1][mixed >> 16 & 0xFFU] ^
         kTables[0][mixed >> 24];
}

std::uint32_t word_at(const std::uint8_t* data) {
  return data[0] | std::uint32_t{data[1]} << 8 | std::uint32_t{data[2]} << 16 | std::uint32_t{data[3]} << 24;
}

}  // namespace

std::uint32_t crc32(const std::uint8_t* data, std::size_t size_bytes) {
  Crc32 crc;
  crc.add(data, size_bytes);
  return crc.value();
}

void Crc32::add(const std::uint8_t* data, std::size_t size_bytes) {
  std::uint32_t remainder = remainder_;
  std::size_t at = 0;
  for (; at + 4 <= size_bytes; at += 4) remainder = after_word(remainder, word_at(data + at));
  for (; at < size_bytes; ++at) remainder = (remainder >> 8) ^ kTables[0][(remainder ^ data[at]) & 0xFFU];
  remainder_ = remainder;
}

void Crc32::add_u32(std::uint32_t value) {
  remainder_ = after_word(remainder_, value);
}

void Crc32::add_f32(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    add_u32(bits);
  }
}

}  // namespace tumblesight::gnc
