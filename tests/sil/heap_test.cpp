// Verifies TS-MEM-020, TS-MEM-100.
#include <gtest/gtest.h>

#include "hal/posix/painted_stack.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

// Inference, commands, events and refusals. The trap is armed on the flight task in all cycles.
TEST(Heap, TenThousandStepsWithoutAnAllocationOfTheFlightTask) {
  constexpr std::uint32_t kSteps = 10'500;
  test::Conversation conversation(test::settings());
  StepAnswer answer;
  for (std::uint32_t k = 0; k + 1 < kSteps; ++k) {
    gnc::RangeImage frame = conversation.good_frame();
    if (k % 97 == 0) frame.ranges.fill(0);
    std::vector<Telecommand> commands;
    if (k % 10 == 0) commands = {reset_sequence(), {hal::FunctionCode{199}, {}}};
    answer = conversation.step({frame}, commands);
    ASSERT_EQ(answer.telemetry.heap_allocations, 0U) << "step " << k;
  }
  answer = conversation.finish();
  EXPECT_EQ(answer.telemetry.cycles, kSteps);
  EXPECT_EQ(answer.telemetry.heap_allocations, 0U);
  EXPECT_GT(answer.telemetry.stack_left_min_bytes, hal::posix::PaintedStack::kBytes / 4);
  EXPECT_LT(answer.telemetry.stack_left_min_bytes, hal::posix::PaintedStack::kBytes);
  EXPECT_EQ(answer.telemetry.frames_bad, (kSteps - 2) / 97 + 1);
  EXPECT_EQ(answer.telemetry.frames_used, kSteps - answer.telemetry.frames_bad);
}

}  // namespace
}  // namespace tumblesight::sim
