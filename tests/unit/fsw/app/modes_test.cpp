// Every pair of mode and cause, compared with the intended transitions.
// Verifies TS-MODE-010.
#include "fsw/app/modes.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "fsw/app/command_table.hpp"

namespace tumblesight::fsw {
namespace {

TEST(Modes, EveryCauseLeadsToTheIntendedModeOnly) {
  const Mode kBoot = Mode::kBoot, kStandby = Mode::kStandby, kRun = Mode::kRun, kSafe = Mode::kSafe;
  const std::map<std::pair<Mode, Cause>, Mode> meant{
      {{kBoot, Cause::kModelFound}, kRun},         {{kBoot, Cause::kNoModel}, kSafe},
      {{kBoot, Cause::kAssertion}, kSafe},         {{kStandby, Cause::kCommandStandby}, kStandby},
      {{kStandby, Cause::kCommandRun}, kRun},      {{kStandby, Cause::kCommandSafe}, kSafe},
      {{kStandby, Cause::kFault}, kSafe},          {{kStandby, Cause::kAssertion}, kSafe},
      {{kRun, Cause::kCommandStandby}, kStandby},  {{kRun, Cause::kCommandRun}, kRun},
      {{kRun, Cause::kCommandSafe}, kSafe},        {{kRun, Cause::kFault}, kSafe},
      {{kRun, Cause::kAssertion}, kSafe},          {{kSafe, Cause::kCommandStandby}, kStandby},
      {{kSafe, Cause::kCommandSafe}, kSafe},       {{kSafe, Cause::kAssertion}, kSafe},
      {{kBoot, Cause::kResumedStandby}, kStandby}, {{kBoot, Cause::kResumedSafe}, kSafe},
      {{kBoot, Cause::kStoredStateLost}, kSafe},
  };
  for (int mode = 0; mode <= 3; ++mode) {
    for (int cause = 0; cause <= static_cast<int>(hal::kLastCause); ++cause) {
      const std::pair<Mode, Cause> at{static_cast<Mode>(mode), static_cast<Cause>(cause)};
      Mode to = static_cast<Mode>(99);
      const auto found = meant.find(at);
      EXPECT_EQ(next_mode(at.first, at.second, to), found != meant.end()) << mode << ' ' << cause;
      EXPECT_EQ(to, found != meant.end() ? found->second : static_cast<Mode>(99)) << mode << ' ' << cause;
    }
  }
  EXPECT_EQ(kTransitions.size(), meant.size()) << "a duplicate or unintended row";
}

// Verifies TS-FDIR-015.
TEST(Modes, NumberThatIsNoModeAllowsNoCommand) {
  const CommandRule rule{FunctionCode::kNoop, 0, 0, 0xFF}, never{FunctionCode::kNoop, 0, 0, 0};
  for (int mode = 0; mode < 256; ++mode) {
    EXPECT_EQ(is_mode(static_cast<Mode>(mode)), mode <= 3) << mode;
    EXPECT_EQ(rule.allowed_in(static_cast<Mode>(mode)), mode <= 3) << mode;
    EXPECT_FALSE(never.allowed_in(static_cast<Mode>(mode))) << mode;
  }
}

// Verifies TS-MODE-050.
TEST(Modes, OnlyACommandEndsSafe) {
  for (const Transition& transition : kTransitions) {
    if (transition.from != Mode::kSafe || transition.to == Mode::kSafe) continue;
    EXPECT_EQ(transition.cause, Cause::kCommandStandby);
    EXPECT_EQ(transition.to, Mode::kStandby) << "never directly to RUN";
  }
}

}  // namespace
}  // namespace tumblesight::fsw
