// cmake/setup.sh: when a build tree is configured again. With a CMake that only notes how it was called.
#include <gtest/gtest.h>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

// A checkout with a CMake that leaves what a configuration leaves, and packages as `packages` lists them.
class ConfigureScript : public ::testing::Test {
 protected:
  ConfigureScript() {
    fs::create_directories(checkout() + "/programs");
    std::ofstream(checkout() + "/CMakePresets.json") << "{}\n";
    std::ofstream(checkout() + "/library") << "a library\n";
    install("libeigen3-dev");
    program("dpkg-query", "cat " + checkout() + "/packages");
    program("cmake",
            "echo \"$@\" >>" + checkout() + "/calls\n" +
                "mkdir -p build/release && cd build/release && touch build.ninja && "
                "printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\\nCMAKE_CACHEFILE_DIR:INTERNAL=%s\\n"
                "CIVETWEB_LIBRARY:FILEPATH=%s\\n' "
                "\"$root\" \"$PWD\" \"$root/library\" >CMakeCache.txt\n"
                "case \"$*\" in *train*) printf 'TUMBLESIGHT_TRAINING:BOOL=ON\\nTorch_DIR:PATH=%s\\n' "
                "\"$root/torch\" >>CMakeCache.txt ;; esac");
  }

  std::string checkout() const { return here_.path("checkout"); }
  std::string tree() const { return checkout() + "/build/release"; }
  void install(const std::string& packages) const {
    std::ofstream(checkout() + "/packages") << packages << "\n";
  }

  // How often CMake ran in one more set-up, and with which arguments at last.
  std::string configure(const std::string& folder = "checkout", const std::string& preset = "release") const {
    const std::string set_up = here_.path("set_up.sh");
    std::ofstream(set_up) << "set -euo pipefail\ncd " << here_.path(folder)
                          << "\nexport root=$PWD PATH=" << checkout() << "/programs:$PATH\n. "
                          << TUMBLESIGHT_SOURCE_DIR << "/cmake/setup.sh\nconfigure_preset " << preset << "\n";
    fs::remove(checkout() + "/calls");
    const Outcome outcome = here_.run_command("timeout 30 bash " + set_up, "set_up");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return content(checkout() + "/calls");
  }

  Workplace here_;

 private:
  void program(const std::string& name, const std::string& lines) const {
    here_.script("checkout/programs/" + name, lines);
  }
};

TEST_F(ConfigureScript, RunsOnceWhereNothingChanges) {
  EXPECT_EQ(configure(), "-S " + checkout() + " --preset release\n");
  EXPECT_EQ(configure(), "");
}

// One tree for both, so that training adds to what is built and a run goes on to use it.
TEST_F(ConfigureScript, AddsTrainingToTheTreeOfTheRelease) {
  fs::create_directories(checkout() + "/torch");
  configure();
  EXPECT_EQ(configure("checkout", "train"), "-S " + checkout() + " --preset train\n");
  EXPECT_EQ(configure("checkout", "train"), "");
  EXPECT_EQ(configure(), "");
}

// After `apt-get remove libtorch-dev` a run must not need it.
TEST_F(ConfigureScript, LeavesTrainingOutWhenLibTorchIsGone) {
  configure("checkout", "train");
  install("libeigen3-dev\nlibcivetweb-dev");
  EXPECT_EQ(configure(), "-S " + checkout() + " --preset release -U Torch_DIR -D TUMBLESIGHT_TRAINING=OFF\n");
}

// A build without a console has one as soon as the package of its server is there.
TEST_F(ConfigureScript, RunsAgainAfterAPackageHasComeOrGone) {
  configure();
  install("libeigen3-dev\nlibcivetweb-dev");
  EXPECT_EQ(configure(), "-S " + checkout() + " --preset release\n");
  EXPECT_EQ(configure(), "");
  install("libeigen3-dev");
  fs::remove(checkout() + "/library");
  EXPECT_EQ(configure(), "-S " + checkout() + " --preset release -U CIVETWEB_LIBRARY\n");
}

TEST_F(ConfigureScript, RunsAgainInATreeOfAnOlderScriptAndAfterAnothersConfiguration) {
  configure();
  fs::remove(tree() + "/.configured");
  EXPECT_NE(configure(), "");
  std::ofstream(tree() + "/CMakeCache.txt", std::ios::app) << "CMAKE_INSTALL_PREFIX:PATH=/usr\n";
  EXPECT_NE(configure(), "");
  std::ofstream(checkout() + "/CMakePresets.json") << "{ }\n";
  EXPECT_NE(configure(), "");
  EXPECT_EQ(configure(), "");
}

// CMake refuses a cache of another folder or another build program, and trusts what an interrupted one found.
TEST_F(ConfigureScript, BeginsAfreshFromACacheThatIsOfNoUse) {
  configure();
  const std::string afresh = " --preset release --fresh\n";
  fs::remove(tree() + "/build.ninja");
  EXPECT_EQ(configure(), "-S " + checkout() + afresh);
  fs::copy(checkout(), here_.path("copy"), fs::copy_options::recursive);
  EXPECT_EQ(configure("copy"), "-S " + here_.path("copy") + afresh);
  std::ofstream(tree() + "/CMakeCache.txt", std::ios::app) << "CMAKE_CXX_COMPILER:FILEPATH=/no/such/g++\n";
  EXPECT_EQ(configure(), "-S " + checkout() + afresh);
  EXPECT_EQ(configure(), "");
}

// The next set-up must not take it for done.
TEST_F(ConfigureScript, RunsAgainAfterOneThatFailed) {
  configure();
  install("libeigen3-dev\nlibcivetweb-dev");
  const std::string cmake = checkout() + "/programs/cmake";
  const std::string working = content(cmake);
  here_.script("checkout/programs/cmake", "exit 1");
  const Outcome outcome = here_.run_command("timeout 30 bash set_up.sh", "failed");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("cmake failed"), std::string::npos) << outcome.errors;
  std::ofstream(cmake) << working;
  EXPECT_NE(configure(), "");
}

}  // namespace
}  // namespace tumblesight::sim
