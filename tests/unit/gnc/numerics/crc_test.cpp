// Checksums: published values, and the definition bit by bit.
#include "gnc/numerics/crc.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tumblesight::gnc {

namespace {

constexpr std::uint8_t kDigits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

// Verifies TS-CMD-010.
TEST(Crc16, GivesThePublishedCheckValues) {
  EXPECT_EQ(crc16(kDigits, sizeof kDigits), 0x29B1);
  EXPECT_EQ(crc16(kDigits, 0), 0xFFFF);
}

// Verifies TS-CMD-010.
TEST(Crc16, ContinuesByteByByte) {
  std::uint16_t crc = crc16(kDigits, 4);
  for (std::size_t i = 4; i < sizeof kDigits; ++i) crc = crc16_append(crc, kDigits[i]);
  EXPECT_EQ(crc, 0x29B1);
}

std::uint32_t text_crc(const std::string& text) {
  return crc32(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

// Verifies TS-IFC-020.
TEST(Crc32, GivesThePublishedCheckValues) {
  EXPECT_EQ(text_crc("123456789"), 0xCBF43926U);
  EXPECT_EQ(text_crc(""), 0U);
  EXPECT_EQ(text_crc("a"), 0xE8B7BE43U);
  EXPECT_EQ(text_crc(std::string(32, '\xFF')), 0xFF6CAB0BU);
}

// Verifies TS-IFC-020.
TEST(Crc32, DoesNotDependOnHowTheDataIsSplit) {
  const std::string text = "The quick brown fox jumps over the lazy dog";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Crc32 crc;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    crc.add(bytes, cut);
    crc.add(bytes + cut, text.size() - cut);
    EXPECT_EQ(crc.value(), 0x414FA339U);
  }
}

// The definition, bit by bit.
std::uint32_t crc32_by_bits(const std::uint8_t* data, std::size_t size) {
  std::uint32_t remainder = 0xFFFFFFFFU;
  for (std::size_t i = 0; i < size; ++i) {
    remainder ^= data[i];
    for (int bit = 0; bit < 8; ++bit)
      remainder = (remainder >> 1) ^ ((remainder & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~remainder;
}

// Verifies TS-IFC-020.
TEST(Crc32, IsThatOfTheDefinitionForAnyLengthAndAlignment) {
  std::array<std::uint8_t, 80> bytes{};
  std::uint32_t value = 1;
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>((value = value * 1'664'525U + 1'013'904'223U) >> 24);
  for (std::size_t begin = 0; begin < 8; ++begin) {
    for (std::size_t size = 0; size <= 64; ++size)
      EXPECT_EQ(crc32(bytes.data() + begin, size), crc32_by_bits(bytes.data() + begin, size))
          << begin << ' ' << size;
  }
}

// Verifies TS-IFC-020.
TEST(Crc32, AddsNumbersAsLittleEndianBytes) {
  Crc32 number_crc, float_crc, bytes_crc;
  number_crc.add_u32(0x3F800001U);
  const float value = 1.00000012F;  // 0x3F800001
  float_crc.add_f32(&value, 1);
  const std::array<std::uint8_t, 4> bytes{0x01, 0x00, 0x80, 0x3F};
  bytes_crc.add(bytes.data(), bytes.size());
  EXPECT_EQ(number_crc.value(), bytes_crc.value());
  EXPECT_EQ(float_crc.value(), bytes_crc.value());
}

}  // namespace

}  // namespace tumblesight::gnc
