// Faults that another program puts into a run, from its request to the results of the run.
// Verifies TS-SIL-198.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

#include "sim/sil/domain_lease.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/run_control.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSequences = 2;

const std::vector<Sequence>& sequences() {
  static const std::vector<Sequence> kAll = test::sequences(kSequences, 5);
  return kAll;
}

// With one request as soon as the run takes it.
SilRunResult run_with(const std::string& request) {
  SilSettings settings = test::shipped_settings();
  settings.speed = 20;
  settings.domain = test::spare_domain();
  auto run = std::async(std::launch::async,
                        [&] { return run_sil(settings, test::lidar(), test::kSwath_m, sequences(), {}); });
  std::string answer;
  while (answer.empty() && run.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) {
    try {
      answer = ask_run(static_cast<std::uint32_t>(settings.domain), request, 5000);
    } catch (const SilFailure&) {  // not yet
    }
  }
  EXPECT_EQ(answer.find(R"({"step":)"), 0U) << answer;
  SilRunResult result = run.get();
  EXPECT_EQ(result.failure, "");
  return result;
}

const FrameTruth& truth_of_step(std::uint32_t k) {
  return sequences()[k / kFramesPerSequence].frames[k % kFramesPerSequence];
}

TEST(RequestedFault, IsNamedInTheResults) {
  const SilRunResult run = run_with(R"({"fault":"occlude","strength":0.5,"steps":3})");
  ASSERT_EQ(run.requests.size(), 1U);
  EXPECT_EQ(run.requests[0].what, "occlude 0.5 of the returns for 3 steps");
  const std::uint32_t first = run.requests[0].step;
  for (std::uint32_t k = 0; k < run.steps.size(); ++k) {
    const bool is_on = k >= first && k < first + 3;
    EXPECT_EQ(run.steps[k].truth.occluder.shape != OccluderShape::kNone, is_on) << k;
  }
}

// The answer to a frame that came a step late is compared with the truth at its exposure.
TEST(RequestedFault, ALateFrameIsComparedWithItsOwnTruth) {
  const SilRunResult run = run_with(R"({"fault":"delay","steps":4})");
  ASSERT_EQ(run.requests.size(), 1U);
  std::uint32_t late = 0;
  for (std::uint32_t k = 1; k < run.steps.size(); ++k) {
    const StepResult& step = run.steps[k];
    if (!gives_attitude(step.attitude) || step.attitude.exposure_time_ns == step.time_ns) continue;
    ++late;
    EXPECT_EQ(step.truth.q_lrf_trf.coeffs(), truth_of_step(k - 1).q_lrf_trf.coeffs()) << k;
  }
  EXPECT_GE(late, 2U);
}

TEST(RequestedFault, ATelecommandIsAcceptedAndNamed) {
  const SilRunResult run = run_with(R"({"function":1,"arguments":""})");
  ASSERT_EQ(run.requests.size(), 1U);
  EXPECT_EQ(run.requests[0].what, "telecommand NOOP");
  EXPECT_EQ(run.steps.back().telemetry.commands_refused, 0U);
}

}  // namespace
}  // namespace tumblesight::sim
