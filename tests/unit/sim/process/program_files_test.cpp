#include "sim/process/program_files.hpp"

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
  fs::create_directories(folder.path("share"));
  std::ofstream(folder.path("share/tumblesight")) << "not a folder";
  for (const std::string& program : {folder.path("bin/tumblesight"), std::string()}) {
    const ProgramFiles files = files_of_program(program);
    EXPECT_FALSE(files.installed) << program;
    EXPECT_EQ(files.root, TUMBLESIGHT_SOURCE_DIR);
    EXPECT_EQ(files.output, TUMBLESIGHT_SOURCE_DIR "/out");
    EXPECT_EQ(files.output_parent, "the source tree");
    for (const std::string& data : {files.models, files.missions, files.sensors})
      EXPECT_TRUE(fs::is_directory(data)) << data;
  }
}

TEST(ProgramFiles, OfThisTestAreThoseOfItsPath) {
  EXPECT_TRUE(fs::equivalent(program_path(), "/proc/self/exe"));
  EXPECT_EQ(program_files().root, files_of_program(program_path()).root);
}

}  // namespace
}  // namespace tumblesight::sim
