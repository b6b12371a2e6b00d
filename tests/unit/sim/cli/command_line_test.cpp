// The command line of the ground tool: refused arguments and their messages, help, and `evaluate`.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/cli/bench_images.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/sensor_arguments.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/world/sensor/effects.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/former_model_image.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

struct Refusal {
  const char* arguments;
  int exit_code;
  const char* message;  // part of the one line on the standard error stream
};

std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {
  return out << refusal.arguments;
}

class BadArguments : public ::testing::TestWithParam<Refusal> {};

TEST_P(BadArguments, GiveOneClearLineAndAnExitCode) {
  ASSERT_STRNE(GetParam().message, "") << "every message has an empty text in it";
  const Workplace here;
  const Outcome outcome = here.run(GetParam().arguments);
  EXPECT_EQ(outcome.exit_code, GetParam().exit_code);
  EXPECT_NE(outcome.errors.find(GetParam().message), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
}

INSTANTIATE_TEST_SUITE_P(
    Evaluate, BadArguments,
    ::testing::Values(
        Refusal{"", 2, "subcommand is required"}, Refusal{"fly", 2, "no subcommand 'fly'"},
        Refusal{"evaluate --sequences 0", 2,
                "--sequences: must be a whole number from 1 to 10000000, not '0'"},
        Refusal{"evaluate --sequences 2.5", 2, "not '2.5'"},
        Refusal{"evaluate --sequences 010", 2, "without leading zeros, not '010'"},
        Refusal{"evaluate --sequences 0x10", 2, "not '0x10'"}, Refusal{"evaluate --frames 08", 2, "not '08'"},
        Refusal{"evaluate --seed 007", 2, "not '007'"}, Refusal{"evaluate --threads 02", 2, "not '02'"},
        Refusal{"evaluate --sequences 100000 --frames 11", 2,
                "1100000 frames in all; a run has at most 1000000; divide it into parts with --shard"},
        Refusal{"evaluate --sequences", 2, "--sequences"},
        Refusal{"evaluate --frames 1001", 2, "from 1 to 1000"}, Refusal{"evaluate --seed -1", 2, "not '-1'"},
        Refusal{"evaluate --threads 9999", 2, "from 0 to 1024"},
        Refusal{"evaluate --condition foggy", 2, "must be one of nominal, degraded, "},
        Refusal{"evaluate --condition foggy", 2, "not 'foggy'"},
        Refusal{"evaluate --condition nominal,nominal", 2, "'nominal' is given twice"},
        Refusal{"evaluate --inertia 1,2,3", 2, "--inertia"},
        Refusal{"evaluate --inertia 1,1,3,0,0,0", 1, "--inertia 1,1,3,0,0,0: no rigid body has this inertia"},
        Refusal{"evaluate --inertia 1,1,nan,0,0,0", 1, "no rigid body has this inertia"},
        Refusal{"evaluate --inertia 4.1e8,3.8e8,3e8,0,0,0", 1, "one in kg mm2 is a million times as large"},
        Refusal{"evaluate --inertia 1e-300,1e-300,1e-300,0,0,0", 1, "must be 1e-06 to 1e+12 kg m2"},
        Refusal{"evaluate --inertia 1e300,1e300,1e300,0,0,0", 1, "must be 1e-06 to 1e+12 kg m2"},
        Refusal{"evaluate --inertia 0.001,1,1,0,0,0", 1, "none below 0.01 of their mean"},
        Refusal{"evaluate --lost-frames 1000", 2,
                "--lost-frames: must be a whole number from 0 to 999, not '1000'"},
        Refusal{"evaluate --lost-frames 10", 2,
                "--lost-frames 10 is too many for --frames 10 with --well-frames 1: give at most 9, or more "
                "--frames"},
        Refusal{"evaluate --frozen 8 --well-frames 2", 2, "give at most 7, or more --frames"},
        Refusal{"evaluate --well-frames 11", 2, "--well-frames 11 is too many for --frames 10"},
        Refusal{"evaluate --loss-every 1", 2, "from 2 to 999, not '1'"},
        Refusal{"evaluate --loss-share 1.5", 2, "--loss-share: must be a number from 0 to 1, not '1.5'"},
        Refusal{"evaluate --period 0", 2, "--period: must be a number from 0.1 to 60, not '0'"},
        Refusal{"evaluate --period-jitter 1", 2, "from 0 to 0.9, not '1'"},
        Refusal{"evaluate --chaser-rate nan", 2, "from 0 to 20, not 'nan'"},
        Refusal{"evaluate --period 0.1 --period-jitter 0.9", 2,
                "--period 0.1 with --period-jitter 0.9 has frames"},
        Refusal{"record --out x --period 0.15 --period-jitter 0.5", 2, "give at least --period 0.2"},
        Refusal{"evaluate --json ''", 2, "--json: must be a path, not ''"},
        Refusal{"evaluate --mesh ''", 2, "--mesh: must be a path, not ''"},
        Refusal{"evaluate --model ''", 2, "--model: must be a path, not ''"},
        Refusal{"record --out ''", 2, "--out: must be a path, not ''"},
        Refusal{"bench --onnxruntime /dev", 2, "--onnxruntime: '/dev' is a folder; give a file"},
        Refusal{"merge /dev/null --out x", 2, "'/dev/null' is a device; give a file"},
        Refusal{"replay /dev", 2, "'/dev' is a folder; give a file"},
        Refusal{"console --dds-security /dev", 2, "--dds-security: '/dev' is a folder; give a file"},
        Refusal{"evaluate --effect fog=1", 2,
                "--effect: effect 'fog' is unknown; the effects are: joints, wrong_object, "},
        Refusal{"evaluate --effect noise=50", 2, "must be a number from 0.01 to 20 times, not '50'"},
        Refusal{"record --out x.tslr --effect plume", 2, "from 0.0001 to 0.5 of the rays, not ''"},
        Refusal{"evaluate --effect noise=5,noise=4", 2, "effect noise is given twice"},
        Refusal{"evaluate --paper --effect noise=5", 2, "--paper: sets --effect itself"},
        Refusal{"evaluate --sensor sonar", 2,
                "--sensor: 'sonar' is neither a file nor a sensor that ships; those are: paper, flash_256, "},
        Refusal{"record --out x.tslr --sensor /dev", 2,
                "sensor description '/dev' cannot be read: it is a folder"},
        Refusal{"evaluate --range 20", 2,
                "--range: must be NEAREST,FARTHEST, two ascending ranges from 10 to "},
        Refusal{"evaluate --range 100,20", 2, "not '100,20'"},
        Refusal{"simulate --range 9,20", 2, "from 10 to 500 m, not '9,20'"},
        Refusal{"quantize --model " TUMBLESIGHT_SOURCE_DIR
                "/fsw/models/near_shoemaker.float32.tsm --range 20,nan",
                2, "--range: must be NEAREST,FARTHEST, two ascending ranges from 10 to 500 m, not '20,nan'"},
        Refusal{"evaluate --paper --sensor flash_256", 2, "--paper: sets --sensor itself"},
        Refusal{"evaluate --paper --range 20,50", 2, "--paper: sets --range itself"},
        Refusal{"evaluate --paper --frozen 1", 2, "--paper: sets --frozen itself"},
        Refusal{"evaluate --paper --target magellan", 2, "--paper: sets --target itself"},
        Refusal{"evaluate --paper --numerics float32", 2, "--paper: sets --numerics itself"},
        Refusal{"bench --onnxruntime /proc/self/comm", 1, "--onnxruntime: "},
        Refusal{"evaluate --paper --frames 5", 2, "sets --frames itself"},
        Refusal{"evaluate --mesh-folder meshes", 2, "requires --paper"},
        Refusal{"evaluate --out folder", 2, "requires --paper"},
        Refusal{"evaluate --paper --mesh-folder /no/such", 1, "--mesh-folder '/no/such' is not a folder"},
        Refusal{"evaluate --no-baseline --baseline-sequences 5", 2, "excludes"},
        Refusal{"evaluate --csv same --json same", 2, "'same' is also the file of --json"},
        Refusal{"evaluate --report /proc/none/x.html", 1, "--report /proc/none/x.html"},
        Refusal{"evaluate --target 'a b'", 2, "must be 1 to 31 characters of a-z"},
        Refusal{"evaluate --mesh x.stl --mesh-scale 0", 2, "from 1e-06 to 1e+06"},
        Refusal{"evaluate --mesh x.stl --mesh-up x", 2, "must be one of y, z, not 'x'"},
        Refusal{"evaluate --mesh-up z", 2, "requires --mesh"},
        Refusal{"evaluate --mesh parametric --mesh-up z", 2, "--mesh-up: is for mesh files"},
        Refusal{"evaluate --mesh parametric --mesh-scale 2", 2, "or give a file with --mesh"},
        Refusal{"record --out x --mesh parametric --mesh-scale 2", 2, "--mesh-scale: is for mesh files"},
        Refusal{"quantize --model " TUMBLESIGHT_SOURCE_DIR
                "/fsw/models/near_shoemaker.float32.tsm --mesh parametric --mesh-scale 2",
                2, "leave --mesh-scale out"},
        Refusal{"evaluate --colour", 2, "--colour"},
        Refusal{"evalute", 2, "there is no subcommand 'evalute'; did you mean 'evaluate'? (see"},
        Refusal{"evaluate --sequencs 5", 2, "there is no option '--sequencs'; did you mean '--sequences'?"},
        Refusal{"quantize --modl x", 2, "there is no option '--modl'; did you mean '--model'?"},
        Refusal{"evaluate --condition nominl", 2, "not 'nominl'; did you mean 'nominal'?"},
        Refusal{"evaluate --effect nois=1", 2, "did you mean 'noise'?"},
        Refusal{"evaluate --sensor flash_265", 2, "did you mean 'flash_256'?"},
        Refusal{"evaluate --target magelan", 1, "did you mean 'magellan'?"},
        Refusal{"evaluate --target sputnik", 1, "near_shoemaker"},
        Refusal{"evaluate --target mine --mesh /no/such.stl", 1, "/no/such.stl"},
        Refusal{"evaluate --target mine", 1,
                "'mine' does not ship, so there is no mesh of it here; give its file"},
        Refusal{"evaluate --symmetry z:1 --sequences 1", 2, "--symmetry: 'z:1' is not AXIS:FOLD"},
        Refusal{"evaluate --symmetry z:7 --symmetry x:3", 2,
                "--symmetry: these axes make more than 60 attitudes"},
        Refusal{"evaluate --paper --symmetry z:4", 2, "--paper: sets --symmetry itself"},
        Refusal{"record --out x --model none.tsm", 2, "--model: model image 'none.tsm' does not exist"},
        Refusal{"evaluate --model /no/such.tsm", 1, "'/no/such.tsm' does not exist"},
        Refusal{"evaluate --model /dev", 1, "'/dev' is a folder; give a file"},
        Refusal{"quantize --model /dev", 2, "'/dev' is a folder; give a file"},
        Refusal{"quantize --model /no/such.tsm", 2, "'/no/such.tsm' does not exist"},
        Refusal{"quantize --model " TUMBLESIGHT_SOURCE_DIR
                "/fsw/models/near_shoemaker.float32.tsm --effect noise=50",
                2, "from 0.01 to 20 times, not '50'"},
        Refusal{"quantize --model " TUMBLESIGHT_SOURCE_DIR
                "/fsw/models/near_shoemaker.float32.tsm --effect sphere=1",
                2, "--effect: wrong_object and sphere are for tests only"},
        Refusal{"evaluate --model /dev/null", 1,
                "model image '/dev/null' cannot be read: it is a device; give a file"},
        Refusal{"evaluate --json /proc/none/x.json", 1, "--json /proc/none/x.json"}));

// `count` times the letter.
std::string letters(std::size_t count) {
  return std::string(count, 'a');
}

// Verifies TS-SIL-160.
TEST(Outputs, LinksStayAsTheyAreWhenARunIsRefused) {
  const Workplace here;
  std::filesystem::create_symlink(here.path("b"), here.path("a"));
  std::filesystem::create_symlink(here.path("c"), here.path("b"));
  EXPECT_NE(here.run("evaluate --sequences 1 --no-baseline --model none.tsm --json a").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(here.path("b")));
  EXPECT_FALSE(std::filesystem::exists(here.path("c")));
}

// Verifies TS-SIL-160.
TEST(Outputs, ThatCouldNotBeWrittenAreRefusedAtTheStart) {
  const Workplace here;
  here.model();
  std::filesystem::create_symlink(here.path("none/x.json"), here.path("dangling.json"));
  const auto errors = [&](const std::string& file) {
    const Outcome outcome =
        here.run("evaluate --sequences 1 --frames 1 --no-baseline --model model.tsm --json " + file);
    EXPECT_EQ(outcome.exit_code, 1) << file;
    EXPECT_EQ(outcome.output, "") << "it began";
    EXPECT_NE(outcome.errors.find("--json " + file), std::string::npos) << outcome.errors;
    return outcome.errors;
  };
  // A file that may be written, in a folder that takes no other one beside it.
  EXPECT_NE(errors("/proc/self/comm").find("no file can be made in its folder: "), std::string::npos);
  EXPECT_NE(errors("/proc/self/comm").find("choose another folder"), std::string::npos);
  EXPECT_NE(errors("dangling.json").find("no file can be made in its folder: "), std::string::npos);
  EXPECT_NE(errors("new/").find("ends as a folder does; add a file name"), std::string::npos);
  EXPECT_NE(errors("new/.").find("ends as a folder does; add a file name"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(here.path("new")));
  for (const std::size_t length : {250U, 300U})
    EXPECT_NE(errors(letters(length)).find("too long to be written; give a shorter one"), std::string::npos);
  EXPECT_EQ(here.run("record --sequences 1 --frames 1 --truth none --out " + letters(200)).exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(here.path("")))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

TEST(Help, TeachesWithAnExample) {
  const Workplace here;
  const Outcome outcome = here.run("evaluate --help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* part : {"--target", "--mesh", "--condition", "--sequences", "--seed", "--json", "--report",
                           "--paper", "--lost-frames", "--chaser-rate", "--well-frames", "Example:"}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part;
  }
}

// In one line, whatever the line breaks.
std::string words_of(const std::string& text) {
  std::string words;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n';
    if (!space || words.empty() || words.back() != ' ') words += space ? ' ' : c;
  }
  return words;
}

TEST(Help, NamesTheLimitsOfTheDisturbances) {
  const Workplace here;
  for (const char* verb : {"evaluate", "record"}) {
    const std::string help = words_of(here.run(std::string(verb) + " --help").output);
    for (const char* part :
         {"are lost (0 to 999)", "before the last (2 to 999)", "probability X (0 to 1)", "times (0 to 998)",
          "means these (1 to 1000)", "in seconds (0.1 to 60)", "uniformly (0 to 0.9)", "around it (0 to 20)",
          "sequences to run (1 to 100000"}) {
      EXPECT_NE(help.find(part), std::string::npos) << part << " in: " << help;
    }
  }
}

// A small mesh that is not a shipped target.
std::string own_mesh(const Workplace& here) {
  std::ofstream(here.path("mine.obj"))
      << "v -1 -1 0\nv 1 -1 0.5\nv 0 1.5 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 2 3 4\n";
  return here.path("mine.obj");
}

// Columns, not bytes: the texts are in UTF-8.
std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  std::size_t columns = 0;
  for (const char c : text) {
    if (c == '\n') columns = 0;
    if (c != '\n' && (static_cast<unsigned char>(c) & 0xC0) != 0x80) ++columns;
    widest = std::max(widest, columns);
  }
  return widest;
}

TEST(Help, FitsATerminal) {
  const Workplace here;
  for (const std::string verb : {"", "simulate", "replay", "console", "mesh", "evaluate", "merge", "campaign",
                                 "campaign run", "campaign work", "campaign status", "campaign report",
                                 "quantize", "record", "bench", "export", "train", "adopt"}) {
    const Outcome outcome = here.run(verb + " --help");
    EXPECT_LE(widest_line(outcome.output), 80U) << outcome.output;
  }
}

// Two seconds after it has shown what it is going to do.
Outcome interrupted(const Workplace& here, const std::string& arguments) {
  // A shell's background jobs ignore SIGINT, and a script cannot undo that. `env` can.
  return here.run_command(std::string("timeout 100 sh -c 'env --default-signal=INT ") + TUMBLESIGHT_BINARY +
                              " " + arguments +
                              " & n=0; while ! grep -q seed interrupted.out && [ $n -lt 300 ]; do sleep 0.1; "
                              "n=$((n+1)); done; sleep 2; kill -INT $!; wait $!'",
                          "interrupted");
}

// What is done is shown, and marked as a part.
TEST(Evaluate, ShowsTheFiguresSoFarWhenItIsInterrupted) {
  const Workplace here;
  here.model();
  const Outcome outcome =
      interrupted(here, "evaluate --sequences 50000 --no-baseline --model model.tsm --json figures.json");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
  EXPECT_NE(outcome.output.find("The figures so far, of "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("of the 50000 sequences:"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.errors.find("interrupted by signal 2 after "), std::string::npos) << outcome.errors;
  EXPECT_FALSE(std::filesystem::exists(here.path("figures.json")));
}

TEST(Evaluate, SaysThatNothingWasWrittenWhenItsOtherKindsAreInterrupted) {
  const Workplace here;
  here.model();
  for (const std::string kind : {"--paper --out tables", "--effect-limit footprint --model model.tsm"}) {
    const Outcome outcome = interrupted(here, "evaluate --sequences 50000 --no-baseline " + kind);
    EXPECT_EQ(outcome.exit_code, 130) << kind << outcome.output << outcome.errors;
    EXPECT_NE(outcome.errors.find("interrupted by signal 2"), std::string::npos) << outcome.errors;
    EXPECT_NE(outcome.errors.find("no file was written"), std::string::npos) << outcome.errors;
  }
}

// Verifies TS-SIL-060.
TEST(Evaluate, GivesTheSameFiguresWithOneAndTwoThreads) {
  const Workplace here;
  const std::string common =
      "evaluate --sequences 3 --frames 2 --seed 9 --no-baseline --model " + here.model();
  ASSERT_EQ(here.run(common + " --threads 1 --json " + here.path("one.json")).exit_code, kGuessed);
  ASSERT_EQ(here.run(common + " --threads 2 --json " + here.path("two.json")).exit_code, kGuessed);
  const std::string one = content(here.path("one.json"));
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(one, content(here.path("two.json")));
}

TEST(Evaluate, WritesARowWithAllEstimatorsForEachCondition) {
  const Workplace here;
  const Outcome outcome = here.run(
      "evaluate --sequences 2 --frames 2 --baseline-sequences 1 --condition degraded,offset --model " +
      here.model() + " --json " + here.path("rows.json"));
  ASSERT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("near_shoemaker, degraded, offset, 2 sequences of 2 frames, seed 1"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("last frame of the first 1 sequence\n"), std::string::npos) << outcome.output;
  const auto rows = nlohmann::json::parse(content(here.path("rows.json"))).at("rows");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("target"), "near_shoemaker");
  EXPECT_EQ(rows[0].at("mesh"), "parametric");
  EXPECT_EQ(rows[0].at("condition"), "degraded");
  EXPECT_EQ(rows[1].at("condition"), "offset");
  EXPECT_EQ(rows[0].at("sequences"), 2);
  for (const char* estimator : {"rcnn", "cnn", "baseline"}) {
    for (const char* figure : {"mean_deg", "median_deg", "within_20deg", "within_5deg"}) {
      EXPECT_TRUE(rows[0].at(estimator).at(figure).is_number()) << estimator << " " << figure;
    }
  }
}

// Verifies TS-SIL-300.
TEST(Evaluate, TakesEffectsTogetherAndNamesThem) {
  const Workplace here;
  const std::string common = "evaluate --sequences 2 --frames 2 --no-baseline --model " + here.model();
  const Outcome outcome =
      here.run(common + " --condition occluded --effect noise=5,rays=64 --json " + here.path("rows.json"));
  ASSERT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("effect: rays=64,noise=5\n"), std::string::npos) << outcome.output;
  const auto rows = nlohmann::json::parse(content(here.path("rows.json"))).at("rows");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at("effect"), "rays=64,noise=5");
  EXPECT_TRUE(rows[0].at("rcnn").at("error_below_3_expected").is_number());
  EXPECT_TRUE(rows[0].at("rcnn").at("expected_over_real").is_number());
}

// Verifies TS-SIL-170.
TEST(Evaluate, SearchesTheStrengthOfAnEffect) {
  const Workplace here;
  const std::string common = "evaluate --sequences 2 --frames 1 --model " + here.model();
  const Outcome outcome = here.run(common + " --effect-limit range_bias --effect noise=2 --json limit.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("  range_bias=0: "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("  range_bias=-5: "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("from 0 to 5: at neither end"), std::string::npos)
      << "the weights are random";
  const auto json = nlohmann::json::parse(content(here.path("limit.json")));
  EXPECT_EQ(json.at("effect"), "range_bias");
  EXPECT_EQ(json.at("unit"), "m");
  EXPECT_EQ(json.at("other_effects"), "noise=2");
  EXPECT_EQ(json.at("sequences"), 2);
  ASSERT_EQ(json.at("limits").size(), 2U);
  EXPECT_TRUE(json.at("limits")[0].at("holds_at").is_null());
  EXPECT_EQ(json.at("limits")[0].at("trials").size(), 2U);
  EXPECT_EQ(json.at("limits")[0].at("trials")[1].at("strength"), -5.0);
  EXPECT_NE(
      here.run(common + " --effect-limit noise --csv x.csv").errors.find("makes no tables; leave --csv out"),
      std::string::npos);
  for (const char* refused :
       {" --effect-limit sphere", " --effect-limit part_missing", " --effect-limit scan_time",
        " --effect-limit noise --paper", " --effect-limit noise --effect noise=2",
        " --effect-limit noise --curves", " --effect-limit noise --condition nominal,degraded"})
    EXPECT_EQ(here.run(common + refused).exit_code, 2) << refused;
}

TEST(Effects, AreListedWithTheirRangesAndModels) {
  const Workplace here;
  for (const char* verb : {"evaluate", "record", "quantize"}) {
    const Outcome outcome = here.run(std::string(verb) + " --effect list");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    for (const EffectRow& row : effect_table())
      EXPECT_NE(outcome.output.find(row.explanation), std::string::npos) << verb << " " << row.name;
  }
}

// Verifies TS-SIL-340.
TEST(Effects, HaveOneStrengthOutsideOfTraining) {
  const Workplace here;
  for (const char* verb : {"evaluate", "simulate", "quantize"}) {
    const Outcome outcome = here.run(std::string(verb) + " --model " + here.model() + " --effect noise=1:5");
    EXPECT_NE(outcome.exit_code, 0) << verb;
    EXPECT_NE(outcome.errors.find("a range is possible after train --effect-set"), std::string::npos)
        << verb << outcome.errors;
  }
}

TEST(Sensors, AreListedWithTheFieldsOfADescription) {
  const Workplace here;
  const Outcome outcome = here.run("record --sensor list");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* what :
       {"paper ", "flash_256 ", "scan_128 ", "footprint_rays ", "/descriptions/scan_128.json"})
    EXPECT_NE(outcome.output.find(what), std::string::npos) << what;
}

// Verifies TS-SIL-320.
TEST(Evaluate, TakesAnotherSensorAndNamesItAndItsPeriod) {
  const Workplace here;
  SensorDescription own = sensor_named("flash_256");
  own.name = "own";
  own.period_s = 1.5;
  std::ofstream(here.path("own.json")) << to_json(own);
  const std::string common = "evaluate --sequences 2 --frames 2 --no-baseline --model " + here.model();
  const Outcome outcome =
      here.run(common + " --sensor own.json --range 30,60 --json rows.json --csv rows.csv");
  ASSERT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("sensor: own (CRC-32 "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("ranges: 30 to 60 m"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.errors.find("No model.sensor.json says for which sensor"), std::string::npos)
      << outcome.errors;
  const auto row = nlohmann::json::parse(content(here.path("rows.json"))).at("rows")[0];
  EXPECT_EQ(row.at("sensor").at("name"), "own");
  EXPECT_EQ(row.at("ranges_m"), nlohmann::json::parse("[30.0, 60.0]"));
  EXPECT_EQ(row.at("disturbances").at("period"), 1.5);
  EXPECT_EQ(row.at("by_range_m").size(), 8U);
  EXPECT_NE(content(here.path("rows.csv")).find("sensor,ranges_m\n"), std::string::npos);
  const Outcome slower = here.run(common + " --sensor own.json --period 2 --json slower.json");
  EXPECT_EQ(
      nlohmann::json::parse(content(here.path("slower.json"))).at("rows")[0].at("disturbances").at("period"),
      2.0);
  ASSERT_EQ(here.run(common + " --json plain.json").exit_code, kGuessed);
  const std::string plain = content(here.path("plain.json"));
  for (const char* word : {"\"sensor\"", "ranges_m", "by_range_m"})
    EXPECT_EQ(plain.find(word), std::string::npos) << word;
}

// Verifies TS-SIL-320.
TEST(Evaluate, RefusesANetworkThatWasTrainedForAnotherSensor) {
  const Workplace here;
  const std::string common = "evaluate --sequences 1 --frames 1 --no-baseline --model " + here.model();
  const SensorDescription scan = sensor_named("scan_128");
  write_sensor_file(here.path("model.tsm"), scan);
  EXPECT_EQ(here.run(common + " --sensor scan_128").exit_code, kGuessed);
  const Outcome other = here.run(common + " --sensor flash_256");
  EXPECT_EQ(other.exit_code, 1);
  for (const std::string& what :
       {to_string(scan), to_string(sensor_named("flash_256")), std::string("--sensor ")})
    EXPECT_NE(other.errors.find(what), std::string::npos) << other.errors;
  EXPECT_EQ(here.run(common).exit_code, 1) << "the paper's is another one too";
}

// Verifies TS-SIL-320.
TEST(Ranges, OutsideTheGateOfTheSensorAreRefused) {
  const Workplace here;
  SensorDescription own;
  own.name = "own";
  own.settings.farthest_m = 60.0;
  std::ofstream(here.path("own.json")) << to_json(own);
  own.settings.nearest_m = 5.0;
  own.settings.farthest_m = 15.0;
  std::ofstream(here.path("near.json")) << to_json(own);
  const std::string record =
      "record --target mine --mesh " + own_mesh(here) + " --sequences 1 --frames 1 --out x.tslr --sensor ";
  const Outcome outcome = here.run(record + "own.json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(
      outcome.errors.find("sensor own: its range gate is 0 to 60 m, and the ranges to draw from are 20 to "
                          "100 m; give ranges inside it, for example --range 20,60"),
      std::string::npos)
      << outcome.errors;
  EXPECT_EQ(here.run(record + "own.json --range 50,60.5").exit_code, 1);
  EXPECT_NE(here.run(record + "near.json").errors.find("give ranges inside it with --range"),
            std::string::npos);
  EXPECT_EQ(here.run(record + "own.json --range 20,60").exit_code, 0);
}

// Verifies TS-SIL-320.
TEST(Period, IsNotShorterThanAScan) {
  const Workplace here;
  SensorDescription own;
  own.settings.scan_time_s = 1.5;
  std::ofstream(here.path("own.json")) << to_json(own);
  const std::string record = "record --out x.tslr --frames 1 --sequences 1 ";
  for (const char* scan : {"--sensor own.json", "--effect scan_time=1.5"}) {
    const Outcome outcome = here.run(record + "--period 1 " + scan);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.errors.find("--period: 1 s is shorter than a scan of 1.5 s"), std::string::npos)
        << outcome.errors;
  }
  EXPECT_EQ(here.run(record + "--period 1.5 --sensor own.json").exit_code, 0);
}

TEST(SensorFile, BelongsToBothImagesOfATarget) {
  EXPECT_EQ(sensor_file_of("out/near.v1"), "out/near.v1.sensor.json") << "near.v2 has another one";
  EXPECT_EQ(sensor_file_of("out/near.tsm"), "out/near.sensor.json");
  EXPECT_EQ(sensor_file_of("out/near.float32.tsm"), "out/near.sensor.json");
}

TEST(Evaluate, WritesACsvFileAndAPage) {
  const Workplace here;
  const Outcome outcome = here.run("evaluate --sequences 2 --frames 2 --no-baseline --model " + here.model() +
                                   " --csv " + here.path("rows.csv") + " --report " + here.path("page.html"));
  ASSERT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_EQ(content(here.path("rows.csv")).substr(0, 12), "target,mesh,");
  EXPECT_NE(content(here.path("page.html")).find("--sequences 2"), std::string::npos);
}

// Verifies TS-SIL-160.
TEST(Inputs, AreNeverOverwritten) {
  const Workplace here;
  const std::string mesh = " --target mine --mesh " + own_mesh(here), sensor = " --sensor own.json";
  std::ofstream(here.path("own.json")) << to_json(SensorDescription{});
  std::filesystem::create_symlink(here.path("own.json"), here.path("link.json"));
  std::filesystem::create_hard_link(here.path("own.json"), here.path("name.json"));
  here.model();
  std::ofstream(here.path("parts.obj")) << "mtllib my paint.mtl\nmtllib a.mtl b.mtl\r\n"
                                        << content(here.path("mine.obj"));
  std::ofstream(here.path("parts.gltf"))
      << R"({"asset":{"version":"2.0"},"buffers":[{"uri":"data:,x"},{"uri":"my%20mesh.bin"}],)"
      << R"("images":[{"uri":"skin.png"}]})";
  std::ofstream(here.path("bus.xml")) << "<PrivateKey>file:" << here.path("key.pem") << "</PrivateKey>";
  std::filesystem::copy(here.path("model.tsm"), here.path("net.cnn.onnx"));
  std::filesystem::copy(here.path("model.tsm"), here.path("mine.tsm"));
  const std::string help = here.run("--help").output;
  const struct {
    std::string arguments;
    const char* message;
  } kRefused[] = {
      {"record --out own.json" + mesh + sensor, "--out: 'own.json' is also the file of --sensor"},
      {"record --out link.json" + mesh + sensor, "is also the file of --sensor"},
      {"record --out name.json" + mesh + sensor, "is also the file of --sensor"},
      {"record --out x.tslr --truth ./mine.obj" + mesh, "--truth: './mine.obj' is also the file of --mesh"},
      {"evaluate --json own.json" + sensor, "--json: 'own.json' is also the file of --sensor"},
      {"evaluate --csv mine.obj" + mesh, "--csv: 'mine.obj' is also the file of --mesh"},
      {"evaluate --report model.tsm --model model.tsm", "is also the file of --model"},
      {"evaluate --json model.sensor.json --model model.tsm", "is also the file of --model (its sensor)"},
      {"simulate --json model.float32.tsm --report r.html --model model.tsm",
       "is also the file of --model (its float32 image)"},
      {"simulate --json own.json --report r.html" + sensor, "is also the file of --sensor"},
      {"simulate --report mine.obj" + mesh, "is also the file of --mesh"},
      {"simulate --report own.json --command-key own.json", "is also the file of --command-key"},
      {"quantize --model model.tsm --out mine.obj --mesh mine.obj", "is also the file of --mesh"},
      {"quantize --model model.tsm --out own.json" + sensor, "is also the file of --sensor"},
      {"quantize --model model.tsm --out link.json" + sensor, "is also the file of --sensor"},
      {"quantize --model model.tsm --out ./model.tsm", "--out: './model.tsm' is also the file of --model"},
      {"evaluate --json mine.mtl" + mesh, "--json: 'mine.mtl' is also the file of --mesh (part of its mesh)"},
      {"evaluate --json 'my paint.mtl' --target mine --mesh parts.obj",
       "is also the file of --mesh (part of its mesh)"},
      {"record --out a.mtl --target mine --mesh parts.obj", "is also the file of --mesh (part of its mesh)"},
      {"quantize --model model.tsm --out b.mtl --mesh parts.obj",
       "is also the file of --mesh (part of its mesh)"},
      {"simulate --json 'my mesh.bin' --report r.html --target mine --mesh parts.gltf",
       "is also the file of --mesh (part of its mesh)"},
      {"record --out skin.png --target mine --mesh parts.gltf",
       "is also the file of --mesh (part of its mesh)"},
      {"simulate --json key.pem --report r.html --dds-security bus.xml",
       "is also the file of --dds-security (a file that it names)"},
      {"bench --onnxruntime own.json --json own.json", "is also the file of --onnxruntime"},
      {"export --model net.cnn.onnx --onnx net", "--onnx: 'net.cnn.onnx' is also the file of --model"},
      {"train --target mine --out . --start-from mine.tsm", "is also the file of --start-from"},
      {"train --target mine --out . --mesh mine.tsm", "is also the file of --mesh"},
  };
  const std::string json = content(here.path("own.json")), obj = content(here.path("mine.obj"));
  for (const auto& [arguments, message] : kRefused) {
    if (help.find("\n  " + arguments.substr(0, arguments.find(' '))) == std::string::npos)
      continue;  // not built
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << arguments << "\n" << outcome.errors;
  }
  EXPECT_EQ(content(here.path("own.json")), json);
  EXPECT_EQ(content(here.path("mine.obj")), obj);
}

// Verifies TS-SIL-120.
TEST(Evaluate, SaysWhatWrongAttitudesOfAMeshOfTheUsersOwnCanMean) {
  const Workplace here;
  const Outcome outcome =
      here.run("evaluate --sequences 6 --frames 1 --no-baseline --target near_shoemaker --mesh " +
               own_mesh(here) + " --model " + here.model());
  EXPECT_EQ(outcome.exit_code, kOfNoUse) << outcome.errors;
  for (const char* part :
       {"more than 20° off", "another spacecraft", "docs/training.md", "--mesh-up y", "--mesh-scale 1"})
    EXPECT_NE(words_of(outcome.output).find(part), std::string::npos) << part << " in: " << outcome.output;
  const Outcome shipped = here.run("evaluate --sequences 6 --frames 1 --no-baseline --model " + here.model());
  EXPECT_EQ(shipped.output.find("another spacecraft"), std::string::npos) << shipped.output;
}

// Verifies TS-SIL-380. Random weights, so that the attitudes are guesses.
TEST(Evaluate, SaysWhatGuessingGivesAndFailsWithAStatusOfItsOwn) {
  const Workplace here;
  const std::string common = "evaluate --sequences 40 --frames 1 --no-baseline --model " + here.model();
  const Outcome outcome = here.run(common + " --report page.html --json rows.json");
  EXPECT_EQ(outcome.exit_code, kOfNoUse) << outcome.errors;
  for (const char* part : {"Condition nominal: ", " % of the attitudes are more than 20° off",
                           "is what guessing gives: an attitude drawn at random is off by 126.5° on average",
                           "a network that was not trained"})
    EXPECT_NE(words_of(outcome.output).find(part), std::string::npos) << part << " in: " << outcome.output;
  EXPECT_NE(content(here.path("page.html")).find("does not know the attitude of NEAR Shoemaker"),
            std::string::npos);
  EXPECT_TRUE(
      nlohmann::json::parse(content(here.path("rows.json"))).at("rows")[0].at("mostly_wrong").get<bool>());
  for (const char* another : {"sphere=1", "wrong_object=1"}) {
    const Outcome other = here.run(common + " --effect " + another);
    EXPECT_EQ(other.exit_code, 0) << another << other.errors;
    EXPECT_EQ(other.output.find("guessing"), std::string::npos) << other.output;
  }
  const Outcome right = here.run("evaluate --sequences 6 --no-baseline");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_EQ(right.output.find("more than 20° off"), std::string::npos) << right.output;
}

// Verifies TS-SIL-380.
TEST(Mesh, OfTheUsersOwnNeedsANameInEveryVerb) {
  const Workplace here;
  const std::string mesh = " --mesh " + own_mesh(here), help = here.run("--help").output;
  for (const std::string verb : {"simulate", "evaluate", "record --out x.tslr", "train --out out"}) {
    if (help.find("\n  " + verb.substr(0, verb.find(' '))) == std::string::npos) continue;  // not built
    const Outcome outcome = here.run(verb + mesh);
    EXPECT_EQ(outcome.exit_code, kBadArguments) << verb;
    EXPECT_NE(
        outcome.errors.find("--mesh: name the spacecraft of the file with --target: a name of your own"),
        std::string::npos)
        << outcome.errors;
    EXPECT_EQ(outcome.output, "") << "it began";
  }
  EXPECT_EQ(here.run("record --out x.tslr --frames 1 --sequences 1 --mesh parametric").exit_code, 0);
}

// Verifies TS-SIL-390.
TEST(Evaluate, GivesErrorsModuloTheSymmetryOfTheTarget) {
  const Workplace here;
  const std::string common =
      "evaluate --sequences 4 --frames 1 --no-baseline --model " + here.model() + " --json ";
  (void)here.run(common + "plain.json");
  const Outcome outcome = here.run(common + "any.json --symmetry z:any --symmetry x:2");
  EXPECT_NE(outcome.output.find("errors modulo the symmetry: any turn about z, 1/2 turn about x"),
            std::string::npos)
      << outcome.output << outcome.errors;
  const auto row = [&](const char* name) {
    return nlohmann::json::parse(content(here.path(name))).at("rows").at(0);
  };
  EXPECT_EQ(row("any.json").at("symmetry"), "any turn about z, 1/2 turn about x");
  EXPECT_TRUE(row("any.json").at("paper_rcnn").is_null());
  EXPECT_FALSE(row("plain.json").at("paper_rcnn").is_null());
  for (const char* estimator : {"rcnn", "cnn"}) {
    const auto mean_deg = [&](const char* name) {
      return row(name).at(estimator).at("mean_deg").get<double>();
    };
    EXPECT_LE(mean_deg("any.json"), 90.0);
    EXPECT_LT(mean_deg("any.json"), mean_deg("plain.json"));
  }
}

// Verifies TS-TRN-100.
TEST(Quantize, WritesNoImageThatIsAnotherNetwork) {
  const Workplace here;
  const std::string quantize = "quantize --sequences 40 --out x.tsm --model " TUMBLESIGHT_SOURCE_DIR
                               "/fsw/models/near_shoemaker.float32.tsm --mesh ";
  const Outcome outcome = here.run(quantize + own_mesh(here) + " --mesh-scale 1.4");
  EXPECT_EQ(outcome.exit_code, kOfNoUse) << outcome.output << outcome.errors;
  for (const char* part :
       {"the attitudes in fixed point are ", "° (mean) from those in float32, more than 5°",
        "x.tsm is not written", "--mesh-up, --mesh-scale", "its target is near_shoemaker"})
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << " in: " << outcome.errors;
  EXPECT_FALSE(std::filesystem::exists(here.path("x.tsm")));
  const Outcome right = here.run(quantize + "parametric");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_TRUE(std::filesystem::exists(here.path("x.tsm")));
}

TEST(Record, TakesTheSwathAndTheSensorOfAModel) {
  const Workplace here;
  const std::string record = "record --target mine --sequences 1 --frames 1 --mesh " + own_mesh(here);
  const std::string model = here.model("mine", 5000);
  ASSERT_EQ(here.run(record + " --out mesh.tslr").exit_code, 0);
  const Outcome outcome = here.run(record + " --out model.tslr --model " + model);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("The network was trained for 5.00 m, which is used"), std::string::npos)
      << outcome.errors;
  EXPECT_NE(content(here.path("model.tslr")), content(here.path("mesh.tslr")));
  EXPECT_NE(
      here.run(record + " --out x.tslr --model " + here.model("magellan")).errors.find("it is for magellan"),
      std::string::npos);
  here.model("mine", 5000);
  write_sensor_file(model, sensor_named("scan_128"));
  const Outcome other = here.run(record + " --out x.tslr --model " + model);
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.errors.find("is for sensor scan_128"), std::string::npos) << other.errors;
}

TEST(MeshAdvice, NamesTheOtherAxisOrTheTurn) {
  ScenarioArguments arguments;
  arguments.mesh = "near.stl";
  ErrorSummary wrong;
  wrong.count = 10;
  CommonTurn common{0.9, Eigen::AngleAxisd(1.6, -Eigen::Vector3d::UnitX())};
  const std::string up = words_of(mesh_advice(arguments, {5.9, 5.9}, wrong, common));
  EXPECT_NE(up.find("about the axis -x"), std::string::npos) << up;
  EXPECT_NE(up.find("Try --mesh-up z."), std::string::npos) << up;
  EXPECT_EQ(up.find("another spacecraft"), std::string::npos) << up;
  common.turn.axis() = Eigen::Vector3d::UnitZ();
  const std::string turn = words_of(mesh_advice(arguments, {5.9, 5.9}, wrong, common));
  EXPECT_NE(turn.find("about the axis z"), std::string::npos) << turn;
  EXPECT_NE(turn.find("modelling tool"), std::string::npos) << turn;
  wrong.within_20deg = 0.6;
  EXPECT_EQ(mesh_advice(arguments, {5.9, 5.9}, wrong, common), "");
  wrong.within_20deg = 0.4;
  arguments.mesh.clear();
  const std::string shipped = words_of(mesh_advice(arguments, {5.9, 5.9}, wrong, common));
  EXPECT_NE(shipped.find("a network that was not trained"), std::string::npos) << shipped;
  EXPECT_EQ(shipped.find("--mesh-up"), std::string::npos) << shipped;
}

TEST(Evaluate, NeedsTheInertiaOfATumblingTargetOfTheUsersOwn) {
  const Workplace here;
  const std::string common =
      "evaluate --sequences 1 --frames 2 --no-baseline --target mine --condition tumbling --mesh " +
      own_mesh(here) + " --model " + here.model("mine", 4000);
  const Outcome without = here.run(common);
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.errors.find("needs the inertia of 'mine'"), std::string::npos) << without.errors;
  EXPECT_NE(without.errors.find("--inertia Ixx,Iyy,Izz,Ixy,Ixz,Iyz"), std::string::npos) << without.errors;
  const Outcome with = here.run(common + " --inertia 10,12,9,0,-1,0.5");
  EXPECT_EQ(with.exit_code, kGuessed) << with.errors;
}

TEST(Evaluate, NamesTheFaultOfAModelImage) {
  const Workplace here;
  const Outcome outcome = here.run("evaluate --sequences 1 --model " + here.model("magellan"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("is refused"), std::string::npos) << outcome.errors;
}

TEST(Evaluate, SaysForWhichTargetAModelImageIs) {
  const Workplace here;
  const Outcome outcome = here.run("evaluate --sequences 1 --model " + here.model("magellan"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find(
                "it is for magellan, and the run is for near_shoemaker; give --target magellan, or the "
                "model of near_shoemaker, which `tumblesight train --target near_shoemaker` makes"),
            std::string::npos)
      << outcome.errors;
}

TEST(Evaluate, WarnsWhenTheNetworkWasTrainedForAnotherSwath) {
  const Workplace here;
  const Outcome outcome = here.run("evaluate --sequences 1 --frames 1 --no-baseline --model " +
                                   here.model("near_shoemaker", 11000));
  EXPECT_EQ(outcome.exit_code, kGuessed);
  EXPECT_NE(outcome.errors.find("trained for 11.00 m"), std::string::npos) << outcome.errors;
}

TEST(EvaluatePaper, LeavesNoFolderWhenItFails) {
  const Workplace here;
  EXPECT_EQ(here.run("evaluate --paper --out figures --mesh-folder /no/such").exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(here.path("figures")));
}

TEST(Quantize, SaysThatAnImageIsInFixedPointAlready) {
  const Workplace here;
  const Outcome outcome = here.run("quantize --model " + here.model());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(
      outcome.errors.find("model.tsm' is in fixed point; give the one in float32, as `tumblesight train` "
                          "writes it: near_shoemaker.float32.tsm"),
      std::string::npos)
      << outcome.errors;
  const Outcome beside = here.run("quantize --model " TUMBLESIGHT_SOURCE_DIR "/fsw/models/magellan.tsm");
  EXPECT_NE(
      beside.errors.find("writes it: --model " TUMBLESIGHT_SOURCE_DIR "/fsw/models/magellan.float32.tsm"),
      std::string::npos)
      << beside.errors;
}

TEST(Quantize, SaysThatASurfaceNeedsAnImageInFixedPoint) {
  const Workplace here;
  const std::string image = TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.float32.tsm";
  const Outcome outcome = here.run("quantize --surface-only --out x.tsm --model " + image);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("near_shoemaker.float32.tsm' is in float32; give the one in fixed point "
                                "(near_shoemaker.tsm), as `tumblesight quantize --model " +
                                image + "` makes it"),
            std::string::npos)
      << outcome.errors;
}

TEST(Quantize, RefusesAScanThatIsLongerThanThePeriod) {
  const Workplace here;
  SensorDescription own;
  own.name = "own";
  own.period_s = 1.0;
  std::ofstream(here.path("own.json")) << to_json(own);
  const std::string options = " --sensor own.json --effect scan_time=";
  const std::string quantize = "quantize --out x.tsm --model " TUMBLESIGHT_SOURCE_DIR
                               "/fsw/models/near_shoemaker.float32.tsm --sequences 10" +
                               options;
  const Outcome outcome = here.run(quantize + "1.5");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(
      outcome.errors.find("--effect: scan_time=1.5 is longer than the period of sensor own, 1 s; give at "
                          "most scan_time=1, or a --sensor with a longer period"),
      std::string::npos)
      << outcome.errors;
  EXPECT_EQ(here.run(quantize + "1").exit_code, 0);
  if (here.run("--help").output.find("train") == std::string::npos) GTEST_SKIP() << "built without training";
  EXPECT_NE(
      here.run("train --out out" + options + "1.5").errors.find("--effect: scan_time=1.5 is longer than"),
      std::string::npos);
  EXPECT_NE(here.run("train --out out --sensor own.json --effect-set none --effect-set scan_time=1.5")
                .errors.find("--effect-set: scan_time=1.5 is longer than"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(here.path("out")));
}

TEST(Quantize, RefusesASurfaceWithTheOtherAxisUp) {
  const Workplace here;
  const TriangleMesh mesh = target_by_name("magellan");
  std::ofstream file(here.path("z_up.obj"));
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m)
    file << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const auto& [a, b, c] : mesh.triangles) file << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  file.close();
  const std::string image = TUMBLESIGHT_SOURCE_DIR "/fsw/models/magellan.tsm";
  const std::string surface = "quantize --surface-only --out x.tsm --mesh z_up.obj --model " + image;
  const Outcome wrong = here.run(surface);
  EXPECT_EQ(wrong.exit_code, 1);
  for (const std::string& part :
       {"mesh z_up.obj does not fit the surface in model image '" + image,
        std::string("with the other axis up it fits: give --mesh-up z"), std::string("make the image anew")})
    EXPECT_NE(wrong.errors.find(part), std::string::npos) << wrong.errors;
  EXPECT_FALSE(std::filesystem::exists(here.path("x.tsm")));
  const Outcome right = here.run(surface + " --mesh-up z");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_TRUE(std::filesystem::exists(here.path("x.tsm")));
}

std::string image_of_size(const Workplace& here, const gnc::DepthProjection& projection) {
  gnc::ModelHeader header = gnc::test_header();
  header.projection = projection;
  EXPECT_TRUE(gnc::set_target(header, "near_shoemaker"));
  return here.put("model.tsm", gnc::random_model_image<gnc::FixedPoint>(4711, header));
}

// Verifies TS-SIL-320.
TEST(Quantize, KeepsTheSensorOfAnImageWhoseSurfaceItReplaces) {
  const Workplace here;
  const std::string surface = "quantize --surface-only --mesh " + own_mesh(here) + " --model " +
                              image_of_size(here, {4200, 2000}) + " --out ";
  const SensorDescription scan = sensor_named("scan_128");
  write_sensor_file(here.path("stale.tsm"), scan);
  const Outcome stale = here.run(surface + "stale.tsm");
  EXPECT_EQ(stale.exit_code, 1);
  EXPECT_NE(
      stale.errors.find("stale.sensor.json' says for which sensor an earlier image of this name was trained"),
      std::string::npos)
      << stale.errors;
  EXPECT_FALSE(std::filesystem::exists(here.path("stale.tsm")));
  write_sensor_file(here.path("model.tsm"), scan);
  const Outcome outcome = here.run(surface + "stale.tsm");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(content(here.path("stale.sensor.json")), to_json(scan));
}

// Verifies TS-TRN-020. Images that an earlier program made can fly again; their weights are the same bytes.
TEST(Quantize, WithSurfaceOnlyRenewsAnImageOfAnEarlierFormatVersion) {
  const Workplace here;
  const std::string shipped = content(TUMBLESIGHT_SOURCE_DIR "/fsw/models/sacd_aquarius.tsm");
  const std::vector<std::uint8_t> today(shipped.begin(), shipped.end());
  constexpr std::size_t kWeights = gnc::kModelDataOffset<gnc::FixedPoint>;
  for (const int version : {3, 4}) {
    SCOPED_TRACE(version);
    const std::vector<std::uint8_t> former = gnc::former_model_image(version, today);
    const std::string old = here.put("old.tsm", former);
    const Outcome outcome =
        here.run("quantize --surface-only --mesh parametric --model " + old + " --out new.tsm");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    const std::string text = words_of(outcome.output);
    for (const char* part : {"2048 points of the surface, ", " mm apart; ", " triangles, ",
                             " edges, at most ", " mm from the mesh"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
    const std::string renewed = content(here.path("new.tsm"));
    ASSERT_EQ(renewed.size(), today.size());
    EXPECT_EQ(renewed[4], 5) << "format version";
    EXPECT_TRUE(std::equal(former.begin() + kWeights,
                           former.begin() + kWeights + gnc::kWeightBytes<gnc::FixedPoint>,
                           renewed.begin() + kWeights,
                           [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }));
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(renewed.data());
    EXPECT_NEAR(gnc::surface_mesh_of<gnc::FixedPoint>(bytes).triangles(),
                gnc::surface_mesh_of<gnc::FixedPoint>(today.data()).triangles(), 200);
  }
}

TEST(Quantize, RefusesASurfaceOfAnotherSizeWithBothSizes) {
  const Workplace here;
  gnc::DepthProjection other = projection_of(target_by_name("near_shoemaker"));
  const auto changed = [](std::uint32_t size, double factor) {
    return static_cast<std::uint32_t>(factor * size);
  };
  const gnc::DepthProjection fitting = other;
  other.swath_mm = changed(fitting.swath_mm, 1.03);
  const auto errors = [&] {
    const Outcome outcome =
        here.run("quantize --surface-only --out x.tsm --model " + image_of_size(here, other));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(here.path("x.tsm")));
    return outcome.errors;
  };
  EXPECT_NE(errors().find("mesh near_shoemaker has a radius of 2."), std::string::npos) << errors();
  EXPECT_NE(errors().find("the network was trained for 2."), std::string::npos) << errors();
  other = fitting;
  other.target_radius_mm = changed(fitting.target_radius_mm, 0.97);
  EXPECT_NE(errors().find("has a radius of"), std::string::npos) << errors();
}

TEST(Quantize, NotesThatTheMeshOfTheSurfaceHasAnotherSize) {
  const Workplace here;
  const Outcome outcome =
      here.run("quantize --effect panel_turn=10 --out x.tsm --mesh " + own_mesh(here) +
               " --model " TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.float32.tsm");
  EXPECT_NE(
      outcome.errors.find("mine.obj has a radius of 2.000 m and a swath of 4.200 m, and the network was "),
      std::string::npos)
      << outcome.errors;
}

TEST(Quantize, RefusesOptionsOfTheCalibrationWithASurface) {
  const Workplace here;
  const std::string surface = "quantize --surface-only --out x.tsm --model " + here.model();
  for (const char* option : {"--effect noise=2", "--sensor paper", "--range 20,50", "--sequences 20"}) {
    const Outcome outcome = here.run(surface + " " + option);
    EXPECT_EQ(outcome.exit_code, 2) << option;
    EXPECT_NE(outcome.errors.find(" excludes --surface-only"), std::string::npos) << outcome.errors;
  }
  EXPECT_NE(here.run(surface + " --symmetry z:4").errors.find("leave --symmetry out"), std::string::npos);
  EXPECT_NE(here.run(surface + " --effect-set noise=2").errors.find("leave --effect-set out"),
            std::string::npos);
  EXPECT_NE(here.run(surface + " --mesh a.stl --mesh b.stl").errors.find("give one --mesh"),
            std::string::npos);
  EXPECT_NE(here.run("quantize --surface-only --model model.tsm").errors.find("requires --out"),
            std::string::npos);
  const std::string help = words_of(here.run("quantize --help").output);
  EXPECT_NE(help.find("with --surface-only or --to-float32: a model image in fixed point"), std::string::npos)
      << help;
  EXPECT_NE(help.find("--surface-only has no default"), std::string::npos) << help;
}

TEST(Record, NeedsNoModelForAMeshOfTheUsersOwn) {
  const Workplace here;
  const Outcome outcome =
      here.run("record --target mine --mesh " + own_mesh(here) + " --sequences 1 --frames 1 --out mine.tslr");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("mine, nominal: 1 frame, "), std::string::npos) << outcome.output;
  EXPECT_GT(content(here.path("mine.tslr")).size(), 1000U);
}

// Verifies TS-SIL-130.
TEST(Record, WritesTheTruthBesideTheFramesUnlessToldOtherwise) {
  const Workplace here;
  const std::string common = "record --target mine --mesh " + own_mesh(here) + " --sequences 1 --frames 2";
  const Outcome outcome = here.run(common + " --out mine.tslr");
  EXPECT_NE(outcome.output.find("/mine.truth.csv\n"), std::string::npos) << outcome.output << outcome.errors;
  const SensorDescription paper;
  EXPECT_NE(outcome.output.find("sensor " + to_string(paper) + ", 20 to 100 m\n"), std::string::npos)
      << outcome.output;
  const std::string truth = content(here.path("mine.truth.csv"));
  EXPECT_NE(truth.find(",target,sensor,sensor_crc32\n"), std::string::npos) << truth;
  EXPECT_NE(truth.find(",mine,paper,"), std::string::npos) << truth;
  EXPECT_EQ(truth.find("sequence_number,exposure_time_ns,q_lrf_trf_w,"), 0U) << truth;
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 3);
  ASSERT_EQ(here.run(common + " --out other.tslr --truth elsewhere.csv").exit_code, 0);
  EXPECT_EQ(content(here.path("elsewhere.csv")), truth);
  ASSERT_EQ(here.run(common + " --out other.tslr --truth none").exit_code, 0);
  ASSERT_EQ(here.run(common + " --out /dev/null").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(here.path("other.truth.csv")));
  EXPECT_FALSE(std::filesystem::exists("/dev/null.truth.csv"));
  const Outcome stale = here.run(common + " --out mine.tslr --truth none");
  EXPECT_EQ(stale.exit_code, 1);
  EXPECT_NE(stale.errors.find("mine.truth.csv' is the truth of an earlier recording"), std::string::npos)
      << stale.errors;
  const Outcome refused = here.run(common + " --out same --truth ./same");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("--truth: './same' is also the file of --out"), std::string::npos)
      << refused.errors;
}

// Verifies TS-SIL-330. A target of 40 m across.
TEST(Record, SeesALargeTargetFromWhereItFitsIntoTheViewTo500m) {
  const Workplace here;
  const std::string large = " --target mine --mesh " + own_mesh(here);
  const std::string common = "record --sequences 3 --frames 1 --out x.tslr" + large;
  const std::string record = common + " --mesh-scale 9.9";
  const Outcome near = here.run(record);
  EXPECT_EQ(near.exit_code, 0) << near.errors;
  const Outcome inside = here.run(record + " --range 20,30");
  EXPECT_EQ(inside.exit_code, 0) << inside.errors;
  EXPECT_NE(inside.errors.find("The target fills the view of sensor paper at "), std::string::npos)
      << inside.errors;
  const Outcome far = here.run(record + " --range 400,470");
  EXPECT_EQ(far.exit_code, 0) << far.errors;
  EXPECT_GT(content(here.path("x.tslr")).size(), 10'000U);
  const Outcome larger = here.run(common + " --mesh-scale 10.1");
  EXPECT_NE(larger.errors.find("20.2 m from the origin, at most 20 m are supported"), std::string::npos)
      << larger.errors;
  SensorDescription narrow;
  narrow.name = "narrow";
  narrow.settings.fov_deg = 5.0;
  std::ofstream(here.path("narrow.json")) << to_json(narrow);
  const Outcome refused = here.run(record + " --sensor narrow.json");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("give the ranges, for example --range "), std::string::npos)
      << refused.errors;
}

// Verifies TS-SIL-300, TS-SIL-310, TS-SIL-320.
TEST(Record, ShowsWhatTheEffectsAdd) {
  const Workplace here;
  const std::string common = "record --target mine --mesh " + own_mesh(here) + " --sequences 1 --frames 2";
  ASSERT_EQ(here.run(common + " --out plain.tslr").exit_code, 0);
  ASSERT_EQ(here.run(common + " --effect rays=32 --out small.tslr").exit_code, 0);
  ASSERT_EQ(here.run(common + " --effect false_returns=0.1 --out false.tslr").exit_code, 0);
  const std::string plain = content(here.path("plain.tslr"));
  EXPECT_LT(content(here.path("small.tslr")).size(), plain.size() / 8);
  EXPECT_GT(content(here.path("false.tslr")).size(), 2 * plain.size()) << "a recording leaves out empty rays";
  ASSERT_EQ(here.run(common + " --sensor flash_256 --out flash.tslr").exit_code, 0);
  EXPECT_NE(content(here.path("flash.tslr")), plain);
  EXPECT_EQ(content(here.path("flash.tslr"))[6], plain[6]) << "frames have 128 rays";
  ASSERT_EQ(here.run(common + " --sensor paper --out paper.tslr").exit_code, 0);
  EXPECT_EQ(content(here.path("paper.tslr")), plain);
  const Outcome refused = here.run(common + " --effect panel_turn=10 --out turned.tslr");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("effect panel_turn: no solar panels are found on "), std::string::npos)
      << refused.errors;
}

TEST(Train, RefusesAFileAsItsFolder) {
  const Workplace here;
  if (here.run("--help").output.find("train") == std::string::npos) GTEST_SKIP() << "built without training";
  const Outcome outcome = here.run("train --out " + here.model());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("model.tsm: is a file; give a folder"), std::string::npos) << outcome.errors;
}

TEST(Train, AsksForTheNameOfAMeshOfTheUsersOwn) {
  const Workplace here;
  if (here.run("--help").output.find("train") == std::string::npos) GTEST_SKIP() << "built without training";
  const Outcome outcome = here.run("train --out out --mesh " + own_mesh(here));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("--mesh: name the spacecraft of the file with --target"), std::string::npos)
      << outcome.errors;
  EXPECT_FALSE(std::filesystem::exists(here.path("out")));
}

TEST(Train, RefusesSetsOfEffectsThatAreWrong) {
  const Workplace here;
  if (here.run("--help").output.find("train") == std::string::npos) GTEST_SKIP() << "built without training";
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"--effect-set none --effect-set fog=1", "--effect-set: effect 'fog' is unknown"},
           {"--effect-set noise=5,noise=4", "--effect-set: effect noise is given twice"},
           {"--effect-set none,noise=5", "--effect-set: effect 'none' is unknown"},
           {"--effect-set noise=5:1", "--effect-set: effect noise: a range must be LOW:HIGH"},
           {"--effect noise=1:5",
            "--effect: effect noise: give one strength here; a range is possible after"},
           {"--effect-set sphere=0.5:1", "wrong_object and sphere are for tests only"},
           {"--effect-set none --effect-set sphere=1", "wrong_object and sphere are for tests only"},
           {"--effect noise=5 --effect-set none", "--effect excludes --effect-set"}}) {
    const Outcome outcome = here.run("train --out out " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
  }
}

// Verifies TS-SIL-320.
TEST(Train, RefusesToContinueWithAnotherSensor) {
  const Workplace here;
  if (here.run("--help").output.find("train") == std::string::npos) GTEST_SKIP() << "built without training";
  write_sensor_file(here.path("near_shoemaker.tsm"), sensor_named("scan_128"));
  const Outcome outcome = here.run("train --out .");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("is for sensor " + to_string(sensor_named("scan_128"))), std::string::npos)
      << outcome.errors;
  EXPECT_NE(outcome.errors.find("with sensor paper (CRC-32 "), std::string::npos) << outcome.errors;
}

TEST(Bench, ReadsBothImagesBeforeItMeasures) {
  const Workplace here;
  here.put("x.tsm", arbitrary_model("x", 7000));
  std::ofstream(here.path("fetch_images")) << "";
  try {
    (void)read_bench_images(here.path(""), "x");
    FAIL() << "the float32 image is missing";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("x.float32.tsm' does not exist; get it with: fsw/models/fetch_images x.float32"),
              std::string::npos)
        << error.what();
  }
}

// Taken out of its folder, without the files that belong to it.
TEST(Program, ThatLacksItsFilesSaysWhatToDo) {
  const Workplace here;
  std::filesystem::create_directory(here.path("bin"));
  std::filesystem::copy_file(TUMBLESIGHT_BINARY, here.path("bin/tumblesight"));
  const Outcome without_verb = here.run_command("bin/tumblesight evaluate", "without_verb");
  EXPECT_EQ(without_verb.exit_code, kFailed);
  EXPECT_NE(
      without_verb.errors.find("the program tumblesight-evaluate is missing: install the package again"),
      std::string::npos)
      << without_verb.errors;
  std::filesystem::copy_file(TUMBLESIGHT_BINARY "-evaluate", here.path("bin/tumblesight-evaluate"));
  const Outcome outcome = here.run_command("bin/tumblesight evaluate", "copied");
  EXPECT_EQ(outcome.exit_code, kFailed);
  EXPECT_NE(outcome.errors.find("/share/tumblesight/missions' is missing, which belongs to tumblesight"),
            std::string::npos)
      << outcome.errors;
  EXPECT_NE(outcome.errors.find("install the package"), std::string::npos) << outcome.errors;
}

TEST(ModelImage, ThatIsInTheHistoryOnlyIsRefusedWithTheCommandThatGetsIt) {
  const Workplace here;
  const std::string image = TUMBLESIGHT_SOURCE_DIR "/fsw/models/none.float32.tsm";
  for (const char* const command : {"evaluate --model ", "quantize --mesh parametric --model "}) {
    const Outcome outcome = here.run(command + image);
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_NE(outcome.errors.find("fsw/models/fetch_images none.float32"), std::string::npos)
        << outcome.errors;
  }
}

}  // namespace
}  // namespace tumblesight::sim
