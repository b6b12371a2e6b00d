#include "sim/host/program_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

TEST(ProgramFiles, OfAnInstalledProgramAreInTheDataFolderBesideIt) {
  const TemporaryFolder prefix;
  fs::create_directories(prefix.path("share/tumblesight"));
  const ProgramFiles files = files_of_program(prefix.path("bin/tumblesight"));
  EXPECT_TRUE(files.installed);
  EXPECT_EQ(files.root, prefix.path("share/tumblesight"));
  EXPECT_EQ(files.models, prefix.path("share/tumblesight/models"));
  EXPECT_EQ(files.missions, prefix.path("share/tumblesight/missions"));
  EXPECT_EQ(files.sensors, prefix.path("share/tumblesight/sensors"));
  EXPECT_EQ(files.output, "out");
  EXPECT_EQ(files.output_parent, "the current folder");
}

TEST(ProgramFiles, OfAnyOtherProgramAreInTheSourceTree) {
  const TemporaryFolder folder;
  for (const char* made : {"share", "source", "bin"}) fs::create_directories(folder.path(made));
  std::ofstream(folder.path("share/tumblesight")) << "not a folder";
  fs::create_directory_symlink(folder.path("source"), folder.path("source_tree"));
  const ProgramFiles files = files_of_program(folder.path("bin/tumblesight"));
  EXPECT_FALSE(files.installed);
  const std::string root = fs::canonical(folder.path("source")).string();
  EXPECT_EQ(files.root, root);
  EXPECT_EQ(files.output, root + "/out");
  EXPECT_EQ(files.output_parent, "the source tree");
}

// What is missing is named by where it would be.
TEST(ProgramFiles, OfAProgramThatWasCopiedAwayAreWhereThoseOfAnInstalledOneWouldBe) {
  const TemporaryFolder folder;
  const ProgramFiles files = files_of_program(folder.path("bin/tumblesight"));
  EXPECT_TRUE(files.installed);
  EXPECT_EQ(files.models, folder.path("share/tumblesight/models"));
}

TEST(ProgramFiles, OfThisTestAreThoseOfItsPath) {
  EXPECT_TRUE(fs::equivalent(program_path(), "/proc/self/exe"));
  const ProgramFiles files = files_of_program(program_path());
  EXPECT_EQ(program_files().root, files.root);
  EXPECT_FALSE(files.installed);
  EXPECT_TRUE(fs::is_regular_file(files.root + "/CMakePresets.json"));
  for (const std::string& data : {files.models, files.missions, files.sensors})
    EXPECT_TRUE(fs::is_directory(data)) << data;
}

}  // namespace
}  // namespace tumblesight::sim
