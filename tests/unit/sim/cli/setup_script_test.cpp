// cmake/setup.sh: its background jobs end with it.
#include <gtest/gtest.h>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

class SetUpScript : public ::testing::TestWithParam<const char*> {};

// The job writes its process ids, including one of a grandchild, and would run for a minute.
TEST_P(SetUpScript, EndsItsJobWhenInterrupted) {
  const Workplace here;
  const std::string job =
      here.script("job.sh", "sleep 60 & echo $! >" + here.path("ids") + "; echo $$ >>" + here.path("ids") +
                                "; echo x >" + here.path("started") + "; wait");
  const std::string set_up = here.path("set_up.sh");
  std::ofstream(set_up) << "set -euo pipefail\nroot=" << here.path("") << "\n. " << TUMBLESIGHT_SOURCE_DIR
                        << "/cmake/setup.sh\nquietly working " << here.path("log") << " " << job
                        << "\necho went on\n";
  // A shell's background jobs ignore SIGINT, and a script cannot undo that. `env` can.
  const Outcome outcome = here.run_command(
      "timeout 30 sh -c 'env --default-signal=INT bash " + set_up + " & n=0; while [ ! -e " +
          here.path("started") + " ] && [ $n -lt 100 ]; do sleep 0.1; n=$((n+1)); done; kill -" + GetParam() +
          " $!; wait $!'",
      "interrupted");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("interrupted"), std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.output.find("went on"), std::string::npos) << outcome.output;
  const Outcome alive =
      here.run_command("sh -c 'sleep 0.2; for id in $(cat " + here.path("ids") +
                           "); do grep -s State: /proc/$id/status; done | grep -v zombie; true'",
                       "alive");
  EXPECT_FALSE(content(here.path("ids")).empty());
  EXPECT_EQ(alive.output, "");
}

INSTANTIATE_TEST_SUITE_P(CtrlCAndKill, SetUpScript, ::testing::Values("INT", "TERM"));

TEST(SetUpScriptRuns, AJobAndShowsTheLogOfAFailedOne) {
  const Workplace here;
  const std::string set_up = here.path("set_up.sh");
  std::ofstream(set_up) << "set -euo pipefail\n. " << TUMBLESIGHT_SOURCE_DIR
                        << "/cmake/setup.sh\nquietly good " << here.path("log") << " true\nquietly bad "
                        << here.path("log") << " bash -c 'echo the reason; exit 3'\n";
  const Outcome outcome = here.run_command("timeout 30 bash " + set_up, "set_up");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("good: done"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.errors, "the reason\n");
}

}  // namespace
}  // namespace tumblesight::sim
