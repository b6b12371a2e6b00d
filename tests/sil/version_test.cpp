// --version of both programs: both report the same build, in the same format.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <regex>
#include <string>

#include "gnc/rcnn/model_image.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "tests/sil/sil_test_support.hpp"

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
  const std::regex expected(
      "(flight|tumblesight) " TUMBLESIGHT_VERSION
      "\ncommit (([0-9a-f]{7,40}|[^\n]+-g[0-9a-f]{7,40})(-dirty)?|unknown)\nmodel format " +
      std::to_string(gnc::kModelFormatVersion<gnc::FixedPoint>) + "\ninterface " + hash.data() + "\n");
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

// The header that the script writes for a repository.
std::string version_header(const std::string& repository) {
  const std::string out = repository + "/version.hpp";
  const std::string script = "cmake -DSOURCE=" + repository + " -DPROJECT_VERSION=1 -DOUT=" + out +
                             " -P " TUMBLESIGHT_VERSION_SCRIPT;
  EXPECT_EQ(output_of(script).status, 0);
  return sim::test::read_file(out);
}

TEST(ProgramVersions, SayThatTheTreeWasChanged) {
  const std::string repository = sim::test::temporary_path("repository");
  const std::string git = "git -C " + repository + " -c user.name=x -c user.email=x@y ";
  const Output made = output_of("git init -q " + repository + " && echo a > " + repository + "/file && " +
                                git + "add file && " + git + "commit -q -m first");
  if (made.status != 0) GTEST_SKIP() << "git is not installed";
  EXPECT_EQ(version_header(repository).find("-dirty\";"), std::string::npos);
  sim::test::write_file(repository + "/file", {'b'});
  EXPECT_NE(version_header(repository).find("-dirty\";"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight
