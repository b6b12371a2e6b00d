// Verifies TS-CMD-010.
#include "gnc/numerics/crc16.hpp"

#include <gtest/gtest.h>

namespace tumblesight::gnc {
namespace {

constexpr std::uint8_t kDigits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(Crc16, GivesThePublishedCheckValues) {
  EXPECT_EQ(crc16(kDigits, sizeof kDigits), 0x29B1);
  EXPECT_EQ(crc16(kDigits, 0), 0xFFFF);
}

TEST(Crc16, ContinuesByteByByte) {
  std::uint16_t crc = crc16(kDigits, 4);
  for (std::size_t i = 4; i < sizeof kDigits; ++i) crc = crc16_append(crc, kDigits[i]);
  EXPECT_EQ(crc, 0x29B1);
}

}  // namespace
}  // namespace tumblesight::gnc
