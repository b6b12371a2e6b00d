// Verifies TS-SIL-210. The evaluation judges frames as the flight program does.
#include "sim/evaluation/flight_limits.hpp"

#include <gtest/gtest.h>

#include "fsw/config/limits.hpp"

namespace tumblesight::sim {
namespace {

std::uint32_t initial(fsw::Limit limit) {
  return fsw::config::kLimitRules[static_cast<std::size_t>(limit)].initial;
}

TEST(FlightLimits, AreThoseOfTheFlightProgramAfterInit) {
  EXPECT_EQ(kFlightLimits.time.future_tolerance_ns, fsw::config::kFrameTimeLimits.future_tolerance_ns);
  EXPECT_EQ(kFlightLimits.time.max_age_ns, fsw::config::kFrameTimeLimits.max_age_ns);
  EXPECT_EQ(kFlightLimits.longest_coast_ns, fsw::config::kLongestCoast_ns);
  EXPECT_EQ(kFlightLimits.longest_without_chaser_ns, fsw::config::kLongestWithoutChaser_ns);
  EXPECT_EQ(kFlightLimits.chaser_time_tolerance_ns, fsw::config::kChaserTimeTolerance_ns);
  EXPECT_EQ(kFlightLimits.predicted_error_urad, initial(fsw::Limit::kPredictedError_urad));
  EXPECT_EQ(kFlightLimits.attitude_jump_urad, initial(fsw::Limit::kAttitudeJump_urad));
}

}  // namespace
}  // namespace tumblesight::sim
