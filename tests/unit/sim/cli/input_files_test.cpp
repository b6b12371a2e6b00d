// Whatever a user names in place of an input file, every verb refuses it in time, by its name.
#include <gtest/gtest.h>

#include "tests/support/hostile_files.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kTimedOut = 124;  // of timeout(1)

struct Door {
  std::string ending;
  std::string arguments;  // "%" stands for the file
};

std::vector<Door> doors() {
  const std::string frames = TUMBLESIGHT_SOURCE_DIR "/tests/audit/near_shoemaker.tslr";
  std::vector<Door> doors{{".tsm", "evaluate --sequences 1 --model %"},
                          {".tsm", "quantize --model % --out out.tsm"},
                          {".toml", "evaluate --sequences 1 --mission %"},
                          {".toml", "mesh --mission %"},
                          {".toml", "campaign run %"},
                          {".toml", "campaign status %"},
                          {".json", "evaluate --sequences 1 --sensor %"},
                          {".shard", "merge %"},
                          {".stl", "mesh %"},
                          {".obj", "mesh %"},
                          {".gltf", "mesh %"},
                          {".glb", "mesh %"}};
#ifdef FLIGHT_BINARY
  doors.push_back({".tsm", "simulate --sequences 1 --model %"});
  doors.push_back({".tslr", "replay %"});
  doors.push_back({".mcap", "replay %"});
  doors.push_back({".csv", "replay " + frames + " --truth %"});
  doors.push_back({".tsm", "replay " + frames + " --model %"});
  doors.push_back({".key", "simulate --sequences 1 --command-key %"});
  doors.push_back({".xml", "simulate --sequences 1 --dds-security %"});
#endif
  return doors;
}

TEST(InputFiles, OfAnyKindAreRefusedByNameInTime) {
  const Workplace here;
  for (const Door& door : doors()) {
    const HostileFiles hostile(door.ending);
    for (const HostileFile& file : hostile.files()) {
      std::string line = door.arguments;
      line.replace(line.find('%'), 1, file.path);
      const auto outcome = here.run(line);
      EXPECT_NE(outcome.exit_code, 0) << line;
      EXPECT_NE(outcome.exit_code, kTimedOut) << line;
      EXPECT_LT(outcome.exit_code, 128) << line << ": ended by a signal";
      EXPECT_NE(outcome.errors.find(file.kind + door.ending), std::string::npos) << line << outcome.errors;
      EXPECT_LT(outcome.errors.size(), 2000U) << line;
    }
  }
}

#ifdef FLIGHT_BINARY
TEST(InputFiles, OfTheFlightProgramAreRefusedByNameInTime) {
  const Workplace here;
  for (const char* option : {"--command-key", "--dds-security"}) {
    const HostileFiles hostile(".key");
    for (const HostileFile& file : hostile.files()) {
      const auto outcome = here.run_command(
          std::string("timeout 60 ") + FLIGHT_BINARY + " --domain 97 " + option + " " + file.path, "flight");
      EXPECT_NE(outcome.exit_code, 0) << option << file.kind;
      EXPECT_NE(outcome.exit_code, kTimedOut) << option << file.kind;
      EXPECT_NE(outcome.errors.find(file.path), std::string::npos) << outcome.errors;
    }
  }
}
#endif

}  // namespace
}  // namespace tumblesight::sim
