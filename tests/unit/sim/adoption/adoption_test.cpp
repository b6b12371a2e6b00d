// Verifies TS-TRN-080.
// From a mission file to a verdict, with the program: half a minute of training gives a network that flies
// and an honest NO-GO.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/inspection/write_mesh.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

class Adopted : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("adoption_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_mission(const std::string& more) const {
    std::ofstream(folder_ / "craft.toml") << "name = \"craft\"\nmesh = \"craft.stl\"\nup = \"z\"\n" << more;
  }
  int adopt(const std::string& more) const {
    const std::string command = std::string(TUMBLESIGHT_PROGRAM) + " adopt " +
                                (folder_ / "craft.toml").string() + " --out " + (folder_ / "out").string() +
                                " " + more + " > " + (folder_ / "output.txt").string() + " 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text_of(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

TEST_F(Adopted, ANetworkOfHalfAMinuteFliesAndIsNotToBeFlown) {
  write_mesh((folder_ / "craft.stl").string(), target_by_name("magellan"));
  write_mission("inertia = [3266, 4772, 2897, 2, 36, -42]\n[panels]\nturn_deg = [-90, 90]\n");
  ASSERT_EQ(adopt("--minutes 0.8 --sequences 2 --threads 1"), 4) << text_of("output.txt");
  const nlohmann::json verdict = nlohmann::json::parse(text_of("out/verdict.json"));
  EXPECT_EQ(verdict.at("verdict"), "NO-GO");
  EXPECT_FALSE(verdict.at("reasons").empty());
  ASSERT_EQ(verdict.at("rows").size(), 4U) << "nominal, degraded, occluded, tumbling";
  EXPECT_EQ(verdict.at("rows")[3].at("condition"), "tumbling");
  EXPECT_EQ(verdict.at("joints").size(), 4U) << "both ends and their halves";
  EXPECT_TRUE(verdict.at("flight").at("well")) << text_of("out/flight.log");
  for (const char* file : {"craft.tsm", "craft.float32.tsm", "report.html", "progress.html", "mesh.html",
                           "evaluation.html", "flight.html"})
    EXPECT_TRUE(fs::is_regular_file(folder_ / "out" / file)) << file;
  EXPECT_NE(text_of("out/report.html").find("NO-GO"), std::string::npos);
}

TEST_F(Adopted, ASphereIsRefusedBeforeTheTraining) {
  Outline profile;
  for (int i = 0; i <= 24; ++i) {
    const float angle = 3.14159265F * static_cast<float>(i) / 24.0F;
    profile.emplace_back(i == 0 || i == 24 ? 0.0F : 2.0F * std::sin(angle), -2.0F * std::cos(angle));
  }
  write_mesh((folder_ / "craft.stl").string(), revolve(profile, 48));
  write_mission("");
  EXPECT_EQ(adopt("--minutes 60"), 4) << text_of("output.txt");
  const nlohmann::json verdict = nlohmann::json::parse(text_of("out/verdict.json"));
  EXPECT_EQ(verdict.at("verdict"), "NO-GO");
  EXPECT_NE(verdict.at("reasons")[0].get<std::string>().find("sphere"), std::string::npos);
  EXPECT_TRUE(verdict.at("rows").empty());
}

TEST_F(Adopted, AMissionThatIsWrongIsNamed) {
  write_mesh((folder_ / "craft.stl").string(), target_by_name("magellan"));
  write_mission("ups = 1\n");
  EXPECT_EQ(adopt(""), 2);
  EXPECT_NE(text_of("output.txt").find("no key 'ups'"), std::string::npos) << text_of("output.txt");
}

}  // namespace
}  // namespace tumblesight::sim
