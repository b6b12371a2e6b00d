#include "sim/cli/absent_verbs.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

TEST(AbsentVerbs, AreNamedWithWhatTheyNeed) {
  CLI::App app;
  app.add_subcommand("simulate", "");
  app.add_subcommand("evaluate", "");
  EXPECT_EQ(fault_of_absent_verb(app, "console"),
            "this build has no console: install libcivetweb-dev and configure again");
  EXPECT_EQ(fault_of_absent_verb(app, "export"),
            "this build has no export: install libonnx-dev and libprotobuf-dev and configure again");
  for (const char* verb : {"train", "adopt"}) {
    const std::string fault = fault_of_absent_verb(app, verb);
    EXPECT_EQ(fault.rfind(std::string("this build has no ") + verb + ": install libtorch-dev, ", 0), 0U)
        << fault;
    EXPECT_NE(fault.find("cmake --preset train"), std::string::npos) << fault;
  }
  EXPECT_EQ(fault_of_absent_verb(app, "simulate"), "") << "it is there";
  EXPECT_EQ(fault_of_absent_verb(app, "fly"), "") << "no build has it";
}

TEST(AbsentVerbs, OfSoftwareInTheLoopNeedItsOption) {
  CLI::App app;
  const std::string option = "configure again with -DTUMBLESIGHT_SIL=ON";
  for (const char* verb : {"simulate", "replay"})
    EXPECT_EQ(fault_of_absent_verb(app, verb), std::string("this build has no ") + verb + ": " + option);
  EXPECT_NE(fault_of_absent_verb(app, "console").find(option), std::string::npos);
}

TEST(AbsentVerbs, StandInTheHelp) {
  CLI::App app;
  for (const char* verb : {"simulate", "replay", "export", "adopt", "train"}) app.add_subcommand(verb, "");
  EXPECT_EQ(absent_verbs_text(app),
            "\nNot in this build\nconsole: install libcivetweb-dev and configure again\n");
  app.add_subcommand("console", "");
  EXPECT_EQ(absent_verbs_text(app), "");
}

}  // namespace
}  // namespace tumblesight::sim
