#include "sim/cli/simulate_arguments.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

TEST(DefaultReportName, IsShortForAUsualRun) {
  SimulateArguments arguments;
  arguments.scenario.condition = "degraded";
  arguments.scenario.seed = 7;
  EXPECT_EQ(default_report_name(arguments), "near_shoemaker_degraded_seed7.html");
}

TEST(DefaultReportName, NamesWhatIsNotAtItsDefault) {
  SimulateArguments arguments;
  arguments.scenario.sequences = 100;
  arguments.speed = "2.5";
  arguments.free_running = true;
  EXPECT_EQ(default_report_name(arguments), "near_shoemaker_nominal_seed1_100x10_speed2.5_free-running.html");
}

TEST(DefaultReportName, TellsDifferentRunsApart) {
  const std::vector<std::function<void(SimulateArguments&)>> changes{
      [](SimulateArguments&) {},
      [](SimulateArguments& a) { a.scenario.target = "magellan"; },
      [](SimulateArguments& a) { a.scenario.condition = "degraded"; },
      [](SimulateArguments& a) { a.scenario.seed = 2; },
      [](SimulateArguments& a) { a.scenario.sequences = 31; },
      [](SimulateArguments& a) { a.scenario.frames = 11; },
      [](SimulateArguments& a) { a.scenario.mesh = "a/near.stl"; },
      [](SimulateArguments& a) { a.scenario.sensor.sensor.settings.rays = 64; },
      [](SimulateArguments& a) { a.scenario.sensor.sensor.settings.rays = 32; },
      [](SimulateArguments& a) {
        a.scenario.sensor.ranges = {30.0, 60.0};
      },
      [](SimulateArguments& a) { a.scenario.mesh = "b/near.stl"; },
      [](SimulateArguments& a) { a.scenario.mesh_up = "z"; },
      [](SimulateArguments& a) { a.scenario.mesh_scale = 0.001; },
      [](SimulateArguments& a) { a.scenario.model = "a/near.tsm"; },
      [](SimulateArguments& a) { a.scenario.model = "b/near.tsm"; },
      [](SimulateArguments& a) { a.scenario.numerics = "float32"; },
      [](SimulateArguments& a) { a.flight = "none"; },
      [](SimulateArguments& a) { a.speed = "1"; },
      [](SimulateArguments& a) { a.free_running = true; },
  };
  std::set<std::string> names;
  for (const auto& change : changes) {
    SimulateArguments arguments;
    change(arguments);
    names.insert(default_report_name(arguments));
  }
  EXPECT_EQ(names.size(), changes.size());
}

TEST(DefaultReportName, StaysAPlainFileNameWhateverThePaths) {
  SimulateArguments arguments;
  arguments.scenario.mesh = "/some where/" + std::string(200, 'm') + "?&#.stl";
  arguments.scenario.model = "../Modèle nº 1.tsm";
  const std::string name = default_report_name(arguments);
  EXPECT_LT(name.size(), 200U);
  EXPECT_EQ(name.find_first_of(" ?&#/\\"), std::string::npos) << name;
  for (const char c : name) EXPECT_GT(c, 0) << name;
}

TEST(RequireSeparateFiles, SeesThroughSpellingsAndLinks) {
  const TemporaryFolder here;
  const std::string file = here.path("in.json");
  std::ofstream(file) << "input";
  std::filesystem::create_symlink(file, here.path("link"));
  std::filesystem::create_hard_link(file, here.path("name"));
  for (const std::string& path : {file, here.path("no/../in.json"), here.path("link"), here.path("name")}) {
    EXPECT_THROW(require_separate_files({{"--mesh", file}}, {{"--json", path}}), ArgumentFault) << path;
    EXPECT_THROW(require_separate_files({}, {{"--report", file}, {"--json", path}}), ArgumentFault);
  }
  EXPECT_NO_THROW(require_separate_files({{"--mesh", file}, {"--sensor", file}}, {{"--json", "out.json"}}));
  EXPECT_NO_THROW(require_separate_files({{"--mesh", ""}}, {{"--json", ""}, {"--report", ""}}));
}

TEST(DefaultReportName, StaysShortEnoughForAFileAndTellsTheRunsApartStill) {
  SimulateArguments arguments;
  arguments.scenario.mesh = std::string(50, 'm') + ".stl";
  arguments.scenario.model = std::string(50, 'n') + ".tsm";
  arguments.scenario.inertia = std::vector<double>(6, -2.2250738585072014e-308);
  arguments.speed = "1." + std::string(300, '0');
  const std::string one = default_report_name(arguments);
  arguments.speed += "1";
  EXPECT_LE(one.size(), 255U);
  EXPECT_NE(one, default_report_name(arguments));
}

}  // namespace
}  // namespace tumblesight::sim
