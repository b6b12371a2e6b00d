#include "sim/cli/parse_faults.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace tumblesight::sim {
namespace {

std::string fault_of(CLI::App& app, const std::string& line) {
  try {
    app.parse(line);
  } catch (const CLI::ParseError& error) {
    return fault_of_parsing(app, error);
  }
  return "not refused";
}

TEST(ParseFaults, NameTheWordThatWasMeant) {
  CLI::App app;
  app.name("tool");
  app.require_subcommand(1);
  std::string model, seed;
  CLI::App* quantize = app.add_subcommand("quantize", "");
  quantize->add_option("--model", model)->required();
  quantize->add_option("--seed", seed);
  CLI::App* campaign = app.add_subcommand("campaign", "");
  campaign->require_subcommand(1);
  campaign->add_subcommand("status", "");
  EXPECT_EQ(fault_of(app, "quantise"),
            "there is no subcommand 'quantise'; did you mean 'quantize'? (see tool --help)");
  EXPECT_EQ(fault_of(app, "fly"), "there is no subcommand 'fly' (see tool --help)");
  EXPECT_EQ(fault_of(app, "quantize --modl x"),
            "there is no option '--modl'; did you mean '--model'? (see tool quantize --help)")
      << "rather than that --model is missing";
  EXPECT_EQ(fault_of(app, "quantize --model x --sede=4"),
            "there is no option '--sede'; did you mean '--seed'? (see tool quantize --help)");
  EXPECT_EQ(fault_of(app, "campaign statsu"),
            "there is no subcommand 'campaign statsu'; did you mean 'status'? (see tool campaign --help)");
  EXPECT_EQ(fault_of(app, "quantize"), "--model is required (see tool quantize --help)");
  EXPECT_NE(fault_of(app, "").find("subcommand is required"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
