// Verifies TS-SIL-210. The evaluation judges frames as the flight program does.
#include "sim/evaluation/flight_limits.hpp"

#include <gtest/gtest.h>

#include "fsw/config/parameters.hpp"

namespace tumblesight::sim {
namespace {

std::int64_t initial(fsw::Parameter parameter) {
  return fsw::config::rule_of(parameter).initial;
}

TEST(FlightLimits, AreThoseOfTheFlightProgramAfterInit) {
  EXPECT_EQ(kFlightLimits.time.future_tolerance_ns, 1'000 * initial(fsw::Parameter::kFutureTolerance_us));
  EXPECT_EQ(kFlightLimits.time.max_age_ns, 1'000'000 * initial(fsw::Parameter::kMaxFrameAge_ms));
  EXPECT_EQ(kFlightLimits.longest_coast_ns, 1'000'000 * initial(fsw::Parameter::kLongestCoast_ms));
  EXPECT_EQ(kFlightLimits.longest_without_chaser_ns,
            1'000'000 * initial(fsw::Parameter::kLongestWithoutChaser_ms));
  EXPECT_EQ(kFlightLimits.chaser_time_tolerance_ns, 1'000 * initial(fsw::Parameter::kChaserTimeTolerance_us));
  EXPECT_EQ(kFlightLimits.predicted_error_urad, initial(fsw::Parameter::kPredictedError_urad));
  EXPECT_EQ(kFlightLimits.attitude_jump_urad, initial(fsw::Parameter::kAttitudeJump_urad));
}

}  // namespace
}  // namespace tumblesight::sim
