// Verifies TS-TIM-060. The rules: "Who may know whom", docs/architecture.md.
#include "tests/analysis/structure/include_rules.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace tumblesight::structure {
namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& path) {
  return path.extension() == ".hpp" || path.extension() == ".cpp" || path.extension() == ".h" ||
         path.extension() == ".c";
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string objection_to(const std::string& file, const std::string& line) {
  const std::vector<Include> includes = includes_of(line);
  return includes.size() == 1 ? objection(file, includes[0]) : "no include found";
}

// Calls visit(file, include) for each include line of each source in the project's folder.
template <class Visit>
void visit_includes(const std::string& folder, const Visit& visit) {
  const fs::path root = TUMBLESIGHT_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const std::string file = fs::relative(entry.path(), root).generic_string();
    for (const Include& include : includes_of(text_of(entry.path()))) visit(file, include);
  }
}

class IncludeRules : public ::testing::TestWithParam<const char*> {};

TEST_P(IncludeRules, HoldForEverySource) {
  int includes = 0;
  visit_includes(GetParam(), [&](const std::string& file, const Include& include) {
    ++includes;
    const std::string why = objection(file, include);
    EXPECT_TRUE(why.empty()) << file << ":" << include.line << ": " << include.path << ": " << why;
  });
  EXPECT_GT(includes, 0) << "the scan found no include lines";
}

INSTANTIATE_TEST_SUITE_P(Tree, IncludeRules, ::testing::Values("gnc", "fsw", "hal", "sim"),
                         [](const auto& folder) { return std::string(folder.param); });

TEST(Folders, EveryOneSaysInItsFirstLineWhatItIsFor) {
  int folders = 0;
  for (const char* part : {"gnc", "fsw", "hal", "sim", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TUMBLESIGHT_SOURCE_DIR) / part)) {
      if (entry.path().filename() != "CMakeLists.txt") continue;
      ++folders;
      EXPECT_EQ(text_of(entry.path()).rfind("# ", 0), 0U) << entry.path();
    }
  }
  EXPECT_GT(folders, 50);
}

TEST(FolderGraph, NoTwoFoldersOfTheProjectIncludeEachOther) {
  FolderGraph graph;
  for (const char* folder : {"gnc", "fsw", "hal", "sim"}) {
    visit_includes(folder,
                   [&](const std::string& file, const Include& include) { graph.add(file, include); });
  }
  for (const std::string& pair : graph.mutual_pairs()) ADD_FAILURE() << pair;
}

TEST(FolderGraph, MutualPairIsReportedOnceWithAnExampleInEachDirection) {
  FolderGraph graph;
  graph.add("gnc/a/x.cpp", {1, "gnc/b/y.hpp", true});
  graph.add("gnc/a/x.cpp", {2, "gnc/c/y.hpp", true});
  EXPECT_TRUE(graph.mutual_pairs().empty());
  graph.add("gnc/b/z.hpp", {1, "gnc/a/x.hpp", true});
  graph.add("gnc/b/z.hpp", {2, "gnc/a/w.hpp", true});
  EXPECT_EQ(graph.mutual_pairs(),
            (std::vector<std::string>{"gnc/a <-> gnc/b: gnc/a/x.cpp includes gnc/b/y.hpp; gnc/b/z.hpp "
                                      "includes gnc/a/x.hpp"}));
}

TEST(FolderGraph, FolderAndItsOwnSubfolderAreAPairToo) {
  FolderGraph graph;
  graph.add("gnc/a/x.cpp", {1, "gnc/a/b/y.hpp", true});
  graph.add("gnc/a/b/y.hpp", {1, "gnc/a/x.hpp", true});
  EXPECT_EQ(graph.mutual_pairs().size(), 1U);
}

TEST(FolderGraph, IncludesWithinAFolderAndOfLibrariesDoNotCount) {
  FolderGraph graph;
  graph.add("gnc/a/x.cpp", {1, "gnc/a/y.hpp", true});
  graph.add("gnc/a/y.hpp", {1, "gnc/a/x.hpp", true});
  graph.add("gnc/a/x.cpp", {1, "Eigen/Core", false});
  EXPECT_TRUE(graph.mutual_pairs().empty());
}

TEST(IncludeScanner, FindsEveryFormOfInclude) {
  const std::vector<Include> includes = includes_of(
      "// #include \"fsw/app/cycle.hpp\"\n#include <vector>\n  #  include \"gnc/a.hpp\"  // why\nint "
      "include;\n"
      "#if X\n#include<dds/dds.h>\n#endif\n");
  ASSERT_EQ(includes.size(), 3U);
  EXPECT_EQ(includes[0].path, "vector");
  EXPECT_FALSE(includes[0].quoted);
  EXPECT_EQ(includes[0].line, 2);
  EXPECT_EQ(includes[1].path, "gnc/a.hpp");
  EXPECT_TRUE(includes[1].quoted);
  EXPECT_EQ(includes[2].path, "dds/dds.h");
}

TEST(IncludeRule, CatchesEveryForbiddenInclude) {
  const std::vector<std::pair<const char*, const char*>> forbidden{
      {"gnc/rcnn/a.cpp", "#include \"fsw/config/limits.hpp\""},
      {"gnc/rcnn/a.cpp", "#include \"hal/link.hpp\""},
      {"gnc/rcnn/a.cpp", "#include \"a.hpp\""},
      {"gnc/rcnn/a.hpp", "#include \"gnc/registration/pose_tracker.hpp\""},
      {"gnc/rcnn/a.cpp", "#include \"gnc/estimation/attitude_estimator.hpp\""},
      {"gnc/rcnn/a.cpp", "#include <vector>"},
      {"gnc/rcnn/a.cpp", "#include <cstdio>"},
      {"gnc/rcnn/a.hpp", "#include <chrono>"},
      {"fsw/app/a.cpp", "#include \"hal/dds/dds_link.hpp\""},
      {"fsw/app/a.cpp", "#include \"hal/posix/realtime.hpp\""},
      {"fsw/app/a.cpp", "#include \"sim/sil/sil_run.hpp\""},
      {"fsw/app/a.cpp", "#include <dds/dds.h>"},
      {"fsw/app/a.cpp", "#include <time.h>"},
      {"gnc/lidar/a.cpp", "#include <immintrin.h>"},
      {"hal/link.hpp", "#include \"fsw/app/events.hpp\""},
      {"hal/link.hpp", "#include \"hal/posix/realtime.hpp\""},
      {"hal/link.hpp", "#include <string>"},
      {"hal/link.hpp", "#include \"gnc/estimation/attitude_estimator.hpp\""},
      {"hal/messages/telemetry.hpp", "#include \"hal/link.hpp\""},
      {"hal/messages/telemetry.hpp", "#include \"fsw/app/events.hpp\""},
      {"hal/messages/telemetry.hpp", "#include <string>"},
      {"hal/packets/a.hpp", "#include \"hal/link.hpp\""},
      {"hal/packets/a.hpp", "#include \"gnc/attitude/rotation.hpp\""},
      {"hal/packets/a.cpp", "#include <string>"},
      {"hal/messages/a.hpp", "#include \"hal/packets/telemetry_encoder.hpp\""},
      {"fsw/app/a.cpp", "#include \"hal/packets/telemetry_encoder.hpp\""},
      {"fsw/c/a.cpp", "#include \"hal/posix/realtime.hpp\""},
      {"fsw/c/a.h", "#include <stdio.h>"},
      {"fsw/app/a.cpp", "#include <new>"},
      {"sim/sil/a.cpp", "#include \"hal/packets/telemetry_encoder.hpp\""},
      {"sim/recording/a.cpp", "#include \"hal/replay/replay_inputs.hpp\""},
      {"hal/posix/a.cpp", "#include \"fsw/config/limits.hpp\""},
      {"hal/posix/a.cpp", "#include \"hal/dds/dds_link.hpp\""},
      {"hal/posix/a.cpp", "#include \"gnc/estimation/attitude_estimator.hpp\""},
      {"hal/posix/a.cpp", "#include <dds/dds.h>"},
      {"fsw/programs/desktop/main.cpp", "#include \"sim/sil/sil_run.hpp\""},
      {"fsw/app/a.cpp", "#include \"fsw/programs/desktop/flight_task.hpp\""},
      {"hal/posix/main.cpp", "#include \"fsw/app/cycle.hpp\""},
      {"hal/dds/dds_link.cpp", "#include \"fsw/app/cycle.hpp\""},
      {"hal/dds/flight_endpoints.cpp", "#include \"fsw/app/cycle.hpp\""},
      {"hal/dds/flight_bus.cpp", "#include \"fsw/config/limits.hpp\""},
      {"hal/dds/flight_bus.cpp", "#include \"fsw/programs/desktop/flight_task.hpp\""},
      {"fsw/programs/desktop/flight_task.cpp", "#include \"sim/sil/sil_run.hpp\""},
      {"fsw/programs/desktop/main.cpp", "#include \"fsw/programs/replay/a.hpp\""},
      {"fsw/programs/desktop/main.cpp", "#include \"hal/fake/fake_lidar.hpp\""},
      {"fsw/app/a.cpp", "#include \"cmake/version.hpp\""},
      {"hal/flight.hpp", "#include \"fsw/app/cycle.hpp\""},
      {"hal/dds/idl/topics.cpp", "#include \"hal/dds/dds_link.hpp\""},
      {"sim/sil/a.cpp", "#include \"fsw/app/attitude_init_app.hpp\""},
      {"sim/sil/a.cpp", "#include \"hal/dds/dds_link.hpp\""},
      {"sim/sil/a.cpp", "#include \"hal/link.hpp\""},
      {"sim/sil/a.cpp", "#include \"hal/posix/realtime.hpp\""},
      {"sim/evaluation/a.cpp", "#include <dds/dds.h>"},
      {"sim/console/bus_run.cpp", "#include <dds/dds.h>"},
      {"fsw/programs/cfs/tumblesight/fsw/src/tumblesight_app.c", "#include \"sample_app.h\""},
      {"fsw/programs/cfs/tumblesight/fsw/src/tumblesight_app.c", "#include \"sim/sil/hello.hpp\""},
      {"fsw/programs/replay/main.cpp", "#include \"cfe.h\""},
  };
  for (const auto& [file, line] : forbidden) EXPECT_NE(objection_to(file, line), "") << file << ": " << line;
}

TEST(IncludeRule, AcceptsAllowedIncludes) {
  const std::vector<std::pair<const char*, const char*>> allowed{
      {"gnc/rcnn/a.cpp", "#include <Eigen/Core>"},
      {"sim/console/ros2_writer.hpp", "#include <dds/dds.h>"},
      {"gnc/rcnn/a.cpp", "#include \"gnc/lidar/range_image.hpp\""},
      {"gnc/nn/kernels/a.cpp", "#include <immintrin.h>"},
      {"fsw/c/a.cpp", "#include \"hal/packets/telemetry_encoder.hpp\""},
      {"fsw/c/a.h", "#include <stdint.h>"},
      {"fsw/app/a.cpp", "#include \"hal/link.hpp\""},
      {"fsw/app/a.cpp", "#include \"hal/messages/telemetry.hpp\""},
      {"hal/link.hpp", "#include \"hal/messages/telemetry.hpp\""},
      {"hal/lidar.hpp", "#include \"gnc/lidar/range_image.hpp\""},
      {"hal/replay/a.cpp", "#include \"gnc/numerics/crc.hpp\""},
      {"hal/packets/a.cpp", "#include \"gnc/numerics/crc.hpp\""},
      {"hal/packets/a.hpp", "#include \"hal/messages/message_fields.hpp\""},
      {"hal/posix/a.cpp", "#include \"hal/packets/packet_sink.hpp\""},
      {"hal/posix/a.cpp", "#include <time.h>"},
      {"hal/posix/a.cpp", "#include \"hal/posix/a.hpp\""},
      {"fsw/programs/desktop/flight_task.cpp", "#include \"fsw/app/cycle.hpp\""},
      {"fsw/programs/desktop/main.cpp", "#include \"hal/posix/realtime.hpp\""},
      {"fsw/programs/desktop/main.cpp", "#include \"hal/dds/flight_bus.hpp\""},
      {"sim/sil/a.cpp", "#include \"hal/dds/idl/topics.hpp\""},
      {"sim/sil/a.cpp", "#include <dds/dds.h>"},
      {"sim/recording/cdr_sample.cpp", "#include <dds/ddsi/ddsi_cdrstream.h>"},
      {"sim/sil/a.cpp", "#include \"hal/messages/telemetry.hpp\""},
      {"sim/cli/main.cpp", "#include \"cmake/version.hpp\""},
      {"sim/cli/a.cpp", "#include <vector>"},
      {"tests/unit/a.cpp", "#include \"fsw/app/cycle.hpp\""},
  };
  for (const auto& [file, line] : allowed) EXPECT_EQ(objection_to(file, line), "") << file << ": " << line;
}

}  // namespace
}  // namespace tumblesight::structure
