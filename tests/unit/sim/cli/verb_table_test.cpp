#include "sim/cli/verb_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

TEST(VerbTable, FindsAVerbByItsName) {
  std::set<std::string> names;
  for (const Verb& verb : verbs()) {
    EXPECT_EQ(verb_named(verb.name), &verb);
    EXPECT_TRUE(names.insert(verb.name).second) << verb.name;
  }
  EXPECT_EQ(verb_named("fly"), nullptr);
  EXPECT_EQ(verb_named(""), nullptr);
}

TEST(AbsentVerbs, AreNamedWithWhatTheyNeed) {
  EXPECT_EQ(remedy_for_absent(*verb_named("console")), "install libcivetweb-dev and configure again");
  EXPECT_EQ(remedy_for_absent(*verb_named("export")),
            "install libonnx-dev and libprotobuf-dev and configure again");
  for (const char* name : {"train", "adopt"}) {
    const std::string remedy = remedy_for_absent(*verb_named(name));
    EXPECT_EQ(remedy.rfind("install libtorch-dev, ", 0), 0U) << remedy;
    EXPECT_NE(remedy.find("cmake --preset train"), std::string::npos) << remedy;
  }
}

TEST(AbsentVerbs, StandInTheHelp) {
  EXPECT_EQ(absent_verbs_text({*verb_named("console")}),
            "\nNot in this build\nconsole: install libcivetweb-dev and configure again\n");
  EXPECT_EQ(absent_verbs_text({}), "");
}

// A copy of the tool without the programs of its verbs.
TEST(AbsentVerbs, AreRefusedWithWhatToDoAboutThem) {
  const Workplace here;
  const std::string tool = here.path("tumblesight");
  fs::copy_file(TUMBLESIGHT_BINARY, tool);
  for (const Verb& verb : verbs()) {
    const Outcome outcome = here.run_command(tool + " " + verb.name + " --help", "absent");
    EXPECT_EQ(outcome.exit_code, kBadArguments);
    EXPECT_EQ(outcome.errors, std::string("tumblesight: this build has no ") + verb.name + ": " +
                                  remedy_for_absent(verb) + "\n");
  }
  const Outcome help = here.run_command(tool + " --help", "help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.output.find("Not in this build\nsimulate: "), std::string::npos) << help.output;
}

// A user may start the program of a verb himself.
TEST(VerbPrograms, WorkWithAndWithoutTheirVerb) {
  const Workplace here;
  const std::string with = here.run("merge --help").output;
  EXPECT_NE(with.find("shard"), std::string::npos);
  const std::string program = std::string(TUMBLESIGHT_BINARY) + "-merge";
  EXPECT_EQ(here.run_command(program + " --help", "alone").output, with);
  EXPECT_EQ(here.run_command(program + " merge --help", "twice").output, with);
}

}  // namespace
}  // namespace tumblesight::sim
