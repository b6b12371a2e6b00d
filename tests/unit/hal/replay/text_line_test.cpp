#include "hal/replay/text_line.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace tumblesight::hal::replay {
namespace {

TEST(TextLine, WritesNumbersRightAlignedWithTheirDecimals) {
  TextLine line;
  line.text("a").number(7, 3).decimal(-1'250'000, 6, 11).decimal(5, 2).number(0).hexadecimal(0xBEEF);
  EXPECT_STREQ(line.c_str(), "a  7  -1.2500000.0500000beef");
}

TEST(TextLine, WritesTheSmallestAndTheLargestNumber) {
  EXPECT_STREQ(TextLine().number(std::numeric_limits<std::int64_t>::min()).c_str(), "-9223372036854775808");
  EXPECT_STREQ(TextLine().number(std::numeric_limits<std::int64_t>::max()).c_str(), "9223372036854775807");
}

TEST(TextLine, CutsOffTextThatDoesNotFit) {
  TextLine line;
  for (int i = 0; i < 100; ++i) line.text("0123456789");
  EXPECT_EQ(std::string(line.c_str()).size(), 119U);
}

}  // namespace
}  // namespace tumblesight::hal::replay
