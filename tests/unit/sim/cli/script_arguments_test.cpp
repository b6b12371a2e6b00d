// The scripts check their arguments before they install or build anything.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

struct Refused {
  const char* command;  // from the root of the sources
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Refused& refused) {
  return out << refused.command;
}

class ScriptArguments : public ::testing::TestWithParam<Refused> {
 protected:
  // Programs in place of those that install and build. They only note that they were called.
  ScriptArguments() {
    std::filesystem::create_directories(here_.path("programs"));
    for (const char* program : {"apt-get", "sudo", "cmake", "ninja", "dpkg-query", "flock"})
      here_.script(std::string("programs/") + program,
                   "echo " + std::string(program) + " >>" + here_.path("called") + "; exit 1");
    std::ofstream(here_.path("craft.toml")) << "name = \"craft\"\nmesh = \"nothere.stl\"\n";
    std::ofstream(here_.path("sound.toml")) << "name = \"craft\"\nmesh = \"craft.stl\"\n";
    std::ofstream(here_.path("craft.stl")) << "solid\n";
  }

  Outcome run(const std::string& command) const {
    return here_.run_command(
        "PATH=" + here_.path("programs") + ":$PATH timeout 60 " + TUMBLESIGHT_SOURCE_DIR + "/" + command,
        "script");
  }

  Workplace here_;
};

TEST_P(ScriptArguments, AreRefusedBeforeAnythingIsInstalledOrBuilt) {
  const Outcome outcome = run(GetParam().command);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
  EXPECT_NE(outcome.errors.find(GetParam().message), std::string::npos) << outcome.errors;
  EXPECT_EQ(content(here_.path("called")), "");
}

INSTANTIATE_TEST_SUITE_P(
    Scripts, ScriptArguments,
    ::testing::Values(
        Refused{"sim/run --mesh nothere.stl", "--mesh: 'nothere.stl' does not exist"},
        Refused{"sim/run --watch --mesh=nothere.stl", "--mesh: 'nothere.stl' does not exist"},
        Refused{"sim/run --sequenes 3", "there is no option '--sequenes'"},
        Refused{"sim/run --watch --seed=3 --condiion=nominal", "there is no option '--condiion'"},
        Refused{"sim/run --seed 3 --watch", "--watch must be the first argument"},
        Refused{"sim/run --watch --watch", "once and without a value"},
        Refused{"sim/run --watch=yes", "once and without a value"},
        Refused{"sim/run magellan", "there is no verb 'magellan'; sim/run --verbs lists them"},
        Refused{"sim/run mesh nothere.stl", "the mesh: 'nothere.stl' does not exist"},
        Refused{"sim/run --sequences 3 4", "'4' belongs to no option"},
        Refused{"sim/run -x", "'-x' belongs to no option"}, Refused{"sim/run ''", "'' belongs to no option"},
        Refused{"sim/run --sequences", "--sequences needs a value"},
        Refused{"sim/run --mesh=", "--mesh needs a value"},
        Refused{"sim/run --frames=ten", "--frames: must be a whole number, not 'ten'"},
        Refused{"sim/run --period fast", "--period: must be a number, not 'fast'"},
        Refused{"sim/run --model programs", "--model: 'programs' is a folder; give a file"},
        Refused{"sim/run --model /dev/null", "--model: '/dev/null' is a pipe or a device; give a plain file"},
        Refused{"sim/adopt /dev/zero", "MISSION: '/dev/zero' is a pipe or a device"},
        Refused{"sim/run --mission nothere.toml", "--mission: 'nothere.toml' does not exist"},
        Refused{"sim/run --mission craft.toml", "the mesh of craft.toml: './nothere.stl' does not exist"},
        Refused{"sim/run --sensor nothere.json", "--sensor: 'nothere.json' does not exist"},
        Refused{"sim/adopt nothere.toml", "MISSION: 'nothere.toml' does not exist"},
        Refused{"sim/adopt craft.stl", "has no line like mesh ="},
        Refused{"sim/run --mission craft.stl", "has no line like mesh ="},
        Refused{"sim/adopt programs", "MISSION: 'programs' is a folder; give a file"},
        Refused{"sim/adopt craft.toml", "'./nothere.stl' does not exist"},
        Refused{"sim/adopt --minutes 5", "MISSION is missing"},
        Refused{"sim/adopt sound.toml --minutes ten", "--minutes: must be a number, not 'ten'"},
        Refused{"sim/adopt sound.toml --minutes", "--minutes needs a value"},
        Refused{"sim/adopt sound.toml --seed=1.5", "--seed: must be a whole number, not '1.5'"},
        Refused{"sim/adopt sound.toml --minuts 5", "there is no option '--minuts'"},
        Refused{"sim/adopt sound.toml craft.toml", "two mission files"},
        Refused{"sim/adopt sound.toml --out craft.stl", "--out: 'craft.stl' is not a folder"},
        Refused{"tests/run --al", "has an option '--al'"},
        Refused{"tests/run nothere", "'nothere' is no folder that has tests"},
        Refused{"tests/run docs", "'docs' is no folder that has tests"},
        Refused{"tests/run gnc/nn --all", "--all runs all tests, and 'gnc/nn' those of a folder"},
        Refused{"tests/run gnc/nn --al", "has an option '--al'"},
        Refused{"tests/audit/run --processor z80", "no processor 'z80'; the processors are: cortex-a53 "},
        Refused{"tests/audit/run --processor", "no processor ''"},
        Refused{"tests/audit/run --wrte", "there is no option '--wrte'"},
        Refused{"tests/fuzz/run nothere", "there is no target 'nothere'; the targets are: "},
        Refused{"tests/fuzz/run --seconds x", "--seconds needs a number of at least 1"},
        Refused{"tests/analysis/coverage/run --least", "--least needs a percentage"},
        Refused{"tests/analysis/coverage/run --least-conditions 9x", "--least-conditions needs a percentage"},
        Refused{"tests/analysis/sanitize/run speed", "there is no 'speed'"},
        Refused{"tests/analysis/static/run --tool lint", "lint"},
        Refused{"tests/analysis/static/run nothere", "there is no 'nothere'"},
        Refused{"tests/campaigns/fault/run --place nowhere", "nowhere"}));

// A file that only its owner may read, and who runs this is not root: root reads all.
TEST_F(ScriptArguments, NameAFileThatCannotBeRead) {
  if (::geteuid() == 0) GTEST_SKIP() << "root reads every file";
  std::filesystem::permissions(here_.path("sound.toml"), std::filesystem::perms::none);
  const Outcome outcome = run("sim/adopt sound.toml");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("cannot be read"), std::string::npos) << outcome.errors;
}

// Sound arguments come as far as the set-up, whose programs fail here.
TEST_F(ScriptArguments, ThatAreSoundAreAccepted) {
  for (const char* command :
       {"sim/adopt sound.toml --minutes 0.5 --seed 3 --out new", "sim/adopt magellan --minutes=60",
        "sim/run --mission magellan --sensor flash_256 --mesh parametric",
        "sim/run --mesh craft.stl --sequences 3 --chaser-rate 5 --speed max --free-running --range 20 60 "
        "--only 1 2"}) {
    std::filesystem::remove(here_.path("called"));
    EXPECT_NE(run(command).exit_code, 2) << command;
    EXPECT_NE(content(here_.path("called")), "") << command;
  }
}

std::vector<std::string> options_in(const std::string& help) {
  std::vector<std::string> options;
  for (std::size_t at = help.find("\n  --"); at != std::string::npos; at = help.find("\n  --", at + 1))
    options.push_back(help.substr(at + 3, help.find_first_of(" ,\n", at + 3) - at - 3));
  return options;
}

// sim/adopt knows the options that the program has.
TEST_F(ScriptArguments, OfAdoptAreThoseOfTheProgram) {
  const std::string script = content(std::string(TUMBLESIGHT_SOURCE_DIR) + "/sim/adopt");
  const std::vector<std::string> options = options_in(here_.run("adopt --help").output);
  EXPECT_GT(options.size(), 3U);
  for (const std::string& option : options) EXPECT_NE(script.find(option), std::string::npos) << option;
}

TEST_F(ScriptArguments, OfRunAreThoseOfTheProgram) {
  const std::string script = content(std::string(TUMBLESIGHT_SOURCE_DIR) + "/sim/run");
  std::vector<std::string> known;
  for (const char* name : {"\nflags=(", "\nwhole_numbers=(", "\nnumbers=(", "\ntexts=(", "\nlists=("}) {
    const std::size_t begin = script.find(name) + std::string(name).size();
    std::istringstream list(script.substr(begin, script.find(')', begin) - begin));
    known.insert(known.end(), std::istream_iterator<std::string>(list), {});
  }
  std::sort(known.begin(), known.end());
  std::vector<std::string> options = options_in(here_.run("simulate --help").output);
  std::sort(options.begin(), options.end());
  EXPECT_EQ(known, options);
}

}  // namespace
}  // namespace tumblesight::sim
