// The lines of a replay. The test is the board.
#include "hal/replay/console_link.hpp"

#include <gtest/gtest.h>

#include <string>

#include "hal/board.hpp"

namespace tumblesight::hal {
namespace {

std::string& console() {
  static std::string text;
  return text;
}

}  // namespace

namespace board {

void write(const char* text) {
  console() += text;
}

}  // namespace board

namespace replay {
namespace {

std::string line_of(Validity validity) {
  AttitudeReport report;
  report.validity = validity;
  report.sequence_number = validity == Validity::kFrameRefused ? 0 : 7;
  console().clear();
  ConsoleLink link;
  link.announce(8);
  link.publish(report);
  link.publish(Telemetry{});
  return console();
}

TEST(ConsoleLink, NamesARefusedFrame) {
  const std::string refused = line_of(Validity::kFrameRefused);
  EXPECT_EQ(refused.find("     8 "), 0U) << refused;
  EXPECT_NE(refused.find("  refused\n"), std::string::npos) << refused;
  EXPECT_EQ(line_of(Validity::kValid).find("     7 "), 0U);
  EXPECT_EQ(line_of(Validity::kValid).find("refused"), std::string::npos);
  EXPECT_NE(line_of(Validity::kDoubtful).find("  not valid\n"), std::string::npos);
}

TEST(ConsoleLink, DigestCoversARefusal) {
  AttitudeReport report;
  ConsoleLink used, refused;
  used.publish(report);
  report.validity = Validity::kFrameRefused;
  refused.publish(report);
  EXPECT_NE(used.digest(), refused.digest());
}

}  // namespace
}  // namespace replay
}  // namespace tumblesight::hal
