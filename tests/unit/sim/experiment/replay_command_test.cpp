#include "sim/experiment/replay_command.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

TEST(ReplayCommand, KeepsWhatMakesTheFramesAndLeavesOutTheRest) {
  EXPECT_EQ(
      replay_command("tumblesight evaluate --target magellan --sequences 900 --condition nominal,degraded "
                     "--seed=7 --threads=2 --no-baseline --effect noise=5 --json a.json --csv=b.csv "
                     "--report r.html --curves --lost-frames 2",
                     Condition::kDegraded),
      "tumblesight simulate --target magellan --seed=7 --effect noise=5 --lost-frames 2 --condition degraded "
      "--only ");
}

TEST(ReplayCommand, OfADefaultEvaluationNamesTheCondition) {
  EXPECT_EQ(replay_command("tumblesight evaluate", Condition::kNominal),
            "tumblesight simulate --condition nominal --only ");
}

TEST(ReplayCommand, KeepsQuotedWordsWhole) {
  EXPECT_EQ(replay_command("tumblesight evaluate --mesh 'my meshes/a --csv b.stl' --json 'out dir/x.json'",
                           Condition::kNominal),
            "tumblesight simulate --mesh 'my meshes/a --csv b.stl' --condition nominal --only ");
}

TEST(ReplayCommand, KeepsApostrophesAndLeavesOutListsOfValues) {
  EXPECT_EQ(replay_command("tumblesight evaluate --model 'o'\\''brien x/m.tsm' --condition nominal degraded "
                           "--sequences 3 --json 'bob'\\''s own.json' --frames 5",
                           Condition::kDegraded),
            "tumblesight simulate --model 'o'\\''brien x/m.tsm' --frames 5 --condition degraded --only ");
}

}  // namespace
}  // namespace tumblesight::sim
