// The whole flight program for Zephyr, on the stub.
#include <gtest/gtest.h>

#include "fsw/programs/rtos/zephyr/flight.hpp"
#include "tests/support/stubs/zephyr/zephyr_stub.hpp"
#include "tests/unit/fsw/programs/rtos/replay_board.hpp"

int zephyr_main();  // main() of fsw/programs/rtos/zephyr/main.cpp

namespace tumblesight::fsw::rtos {

void start_drivers(ZephyrFlight& flight) {
  ++replay_board()->drivers_started;
  test::zephyr().on_release = [&flight](std::int64_t& now_ticks) {
    std::int64_t now_ns = 0;
    const bool goes_on = replay_board()->exchange(flight, now_ns);
    now_ticks = now_ns / STUB_NS_PER_TICK;
    return goes_on;
  };
}

namespace {

TEST(ZephyrProgram, HasTheGoldenDigest) {
  replay_board() = std::make_unique<ReplayBoard>();
  test::zephyr() = {};
  EXPECT_EQ(zephyr_main(), 0);
  EXPECT_EQ(replay_board()->replay.digest(), test::GoldenReplay::golden_digest());
  EXPECT_TRUE(replay_board()->replay.recording.was_read());
  EXPECT_EQ(replay_board()->watchdog.kicks, 20);
  EXPECT_EQ(replay_board()->drivers_started, 1);
  EXPECT_EQ(replay_board()->replay.telemetry().cycle_slips, 0U);
  EXPECT_EQ(replay_board()->log, "Zephyr stopped the timer");
}

}  // namespace
}  // namespace tumblesight::fsw::rtos
