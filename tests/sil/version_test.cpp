// --version of both programs: both report the same build, in the same format.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <regex>
#include <string>

#include "gnc/rcnn/model_image.hpp"
#include "hal/dds/idl/icd_hash.hpp"

namespace tumblesight {
namespace {

struct Output {
  std::string text;
  int status = -1;
};

Output output_of(const std::string& command) {
  Output output;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 256> line;
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) output.text += line.data();
  output.status = pclose(pipe);
  return output;
}

class ProgramVersion : public ::testing::TestWithParam<const char*> {};

TEST_P(ProgramVersion, IsReportedWithCommitModelFormatAndInterfaceHash) {
  const Output output = output_of(std::string(GetParam()) + " --version");
  EXPECT_EQ(output.status, 0);
  std::array<char, 16> hash;
  std::snprintf(hash.data(), hash.size(), "%08x", static_cast<unsigned>(hal::dds::icd_hash()));
  const std::regex expected("(flight|tumblesight) " TUMBLESIGHT_VERSION
                            "\ncommit ([0-9a-f]{7,40}|[^\n]+-g[0-9a-f]{7,40}|unknown)\nmodel format " +
                            std::to_string(gnc::kModelFormatVersion) + "\ninterface " + hash.data() + "\n");
  EXPECT_TRUE(std::regex_match(output.text, expected)) << output.text;
}

INSTANTIATE_TEST_SUITE_P(Programs, ProgramVersion, ::testing::Values(TUMBLESIGHT_FLIGHT, TUMBLESIGHT_PROGRAM),
                         [](const auto& test) { return test.index == 0 ? "Flight" : "Tumblesight"; });

TEST(ProgramVersions, NameTheSameCommit) {
  const std::string flight = output_of(TUMBLESIGHT_FLIGHT " --version").text;
  const std::string ground = output_of(TUMBLESIGHT_PROGRAM " --version").text;
  ASSERT_NE(flight.find('\n'), std::string::npos) << flight;
  ASSERT_NE(ground.find('\n'), std::string::npos) << ground;
  EXPECT_EQ(flight.substr(flight.find(' ')), ground.substr(ground.find(' ')));
}

}  // namespace
}  // namespace tumblesight
