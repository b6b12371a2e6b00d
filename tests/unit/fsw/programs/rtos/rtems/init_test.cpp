// The whole flight program for RTEMS, on the stub.
#include <gtest/gtest.h>

#include "fsw/programs/rtos/rtems/flight.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/stubs/rtems/rtems_stub.hpp"
#include "tests/unit/fsw/programs/rtos/replay_board.hpp"

namespace tumblesight::fsw::rtos {

void start_drivers(RtemsFlight& flight) {
  ++replay_board()->drivers_started;
  test::rtems().on_release = [&flight](std::int64_t& now_ns) {
    return replay_board()->exchange(flight, now_ns);
  };
}

namespace {

class RtemsProgram : public ::testing::Test {
 protected:
  RtemsProgram() {
    replay_board() = std::make_unique<ReplayBoard>();
    test::rtems() = {};
    test::rtems().limits = rtems_configured;
  }
};

TEST_F(RtemsProgram, HasTheGoldenDigest) {
  Init(0);
  EXPECT_EQ(replay_board()->replay.digest(), test::GoldenReplay::golden_digest());
  EXPECT_TRUE(replay_board()->replay.recording.was_read());
  EXPECT_EQ(replay_board()->watchdog.kicks, 20);
  EXPECT_EQ(replay_board()->replay.telemetry().cycle_slips, 0U);
  EXPECT_EQ(replay_board()->log, "RTEMS refused the rate-monotonic period");
  EXPECT_EQ(test::rtems().task_exits, 1);
}

TEST_F(RtemsProgram, CarriesOutACommandWithTheBoardsKeyOnce) {
  replay_board()->keys = &kTestKeys;
  replay_board()->command = signed_with(kTestKey, 1, packet_of(1));
  Init(0);
  constexpr auto kReplayed = static_cast<std::size_t>(hal::CommandRefusal::kReplayed);
  EXPECT_EQ(replay_board()->replay.telemetry().commands_accepted, 1U);
  EXPECT_EQ(replay_board()->replay.telemetry().commands_refused_by[kReplayed], 19U);
}

TEST_F(RtemsProgram, EndsIfTheConfigurationHasTooFewQueues) {
  for (const std::uint32_t queues : {2U, 6U}) {  // too few for the LiDAR, and for the link
    test::rtems() = {};
    test::rtems().limits.message_queues = queues;
    replay_board()->log.clear();
    Init(0);
    EXPECT_EQ(replay_board()->log, "RTEMS has too few message queues: CONFIGURE_MAXIMUM_MESSAGE_QUEUES");
    EXPECT_EQ(replay_board()->drivers_started, 0);
    EXPECT_EQ(test::rtems().task_exits, 1);
  }
}

TEST_F(RtemsProgram, EndsIfTheConfigurationHasNoPeriod) {
  test::rtems().limits.periods = 0;
  Init(0);
  EXPECT_EQ(replay_board()->log, "RTEMS refused the rate-monotonic period");
  EXPECT_EQ(replay_board()->watchdog.kicks, 0);
}

}  // namespace
}  // namespace tumblesight::fsw::rtos
