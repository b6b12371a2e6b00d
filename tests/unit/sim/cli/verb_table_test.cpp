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
  fs::create_directory(here.path("bin"));
  fs::create_directory_symlink(TUMBLESIGHT_SOURCE_DIR, here.path("source_tree"));
  const std::string tool = here.path("bin/tumblesight");
  fs::copy_file(TUMBLESIGHT_BINARY, tool);
  for (const Verb& verb : verbs()) {
    const Outcome outcome = here.run_command(tool + " " + verb.name + " --help", "absent");
    EXPECT_EQ(outcome.exit_code, kBadArguments);
    const std::string built = std::string("tumblesight: ") + verb.name + " is not built yet: cmake --build ";
    const std::string lacking = std::string("tumblesight: this build has no ") + verb.name + ": ";
    const bool has_program = fs::exists(std::string(TUMBLESIGHT_BINARY) + "-" + verb.name);
    EXPECT_EQ(outcome.errors.rfind(has_program ? built : lacking, 0), 0U) << outcome.errors;
  }
  EXPECT_EQ(here.run_command(tool + " --help", "help").output, here.run("--help").output);
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
