#include <gtest/gtest.h>

#include "sim/cli/command_line.hpp"
#include "sim/cli/exit_status.hpp"

namespace tumblesight::sim {
namespace {

// What the words are refused with.
std::string fault_of(CommandLine& line, const std::vector<std::string>& words) {
  testing::internal::CaptureStderr();
  const int status = line.run(words);
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_EQ(status, kBadArguments);
  return printed;
}

TEST(CommandLineFaults, NameTheWordThatWasMeant) {
  CommandLine line("", "");
  std::string model, seed;
  Command quantize = line.command().add_subcommand("quantize", "");
  quantize.add_option("--model", model)->required();
  quantize.add_option("--seed", seed);
  Command campaign = line.command().add_subcommand("campaign", "");
  campaign.require_subcommand(1);
  campaign.add_subcommand("status", "");
  EXPECT_EQ(
      fault_of(line, {"quantise"}),
      "tumblesight: there is no subcommand 'quantise'; did you mean 'quantize'? (see tumblesight --help)\n");
  EXPECT_EQ(fault_of(line, {"fly"}), "tumblesight: there is no subcommand 'fly' (see tumblesight --help)\n");
  EXPECT_EQ(
      fault_of(line, {"quantize", "--modl", "x"}),
      "tumblesight: there is no option '--modl'; did you mean '--model'? (see tumblesight quantize --help)\n")
      << "rather than that --model is missing";
  EXPECT_EQ(
      fault_of(line, {"quantize", "--model", "x", "--sede=4"}),
      "tumblesight: there is no option '--sede'; did you mean '--seed'? (see tumblesight quantize --help)\n");
  EXPECT_EQ(fault_of(line, {"campaign", "statsu"}),
            "tumblesight: there is no subcommand 'campaign statsu'; did you mean 'status'? (see tumblesight "
            "campaign "
            "--help)\n");
  EXPECT_EQ(fault_of(line, {"quantize"}),
            "tumblesight: --model is required (see tumblesight quantize --help)\n");
  EXPECT_NE(fault_of(line, {}).find("subcommand is required"), std::string::npos);
}

TEST(CommandLineFaults, OfAVerbNameTheHelpOfItsCommand) {
  CommandLine line("", "");
  Command mesh = line.command().add_subcommand("mesh", "");
  mesh.callback([] { throw ArgumentFault("--fix", "needs a mesh"); });
  EXPECT_EQ(fault_of(line, {"mesh"}), "tumblesight: --fix: needs a mesh (see tumblesight mesh --help)\n");
}

TEST(CommandLine, ReturnsTheStatusThatAVerbEndsWith) {
  CommandLine line("", "");
  line.command().add_subcommand("mesh", "").callback([] { throw Exit(kOfNoUse); });
  line.command().add_subcommand("merge", "").callback([] {});
  EXPECT_EQ(line.run({"mesh"}), kOfNoUse);
  EXPECT_EQ(line.run({"merge"}), 0);
}

TEST(CommandLine, OfOptionsAloneRefusesByAnException) {
  CommandLine line;
  std::uint64_t seed = 0;
  line.command().add_option("--seed", seed);
  line.parse({"--seed", "4"});
  EXPECT_EQ(seed, 4U);
  EXPECT_THROW(line.parse({"--sede", "4"}), ArgumentFault);
}

}  // namespace
}  // namespace tumblesight::sim
