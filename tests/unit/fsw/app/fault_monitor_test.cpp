// Verifies TS-FDIR-050, TS-FDIR-060.
#include "fsw/app/fault_monitor.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tumblesight::fsw {
namespace {

using Change = FaultMonitor::Change;

const config::FaultRule& rule_of(Fault fault) {
  return config::kFaultRules[static_cast<std::size_t>(fault)];
}

// The change of each cycle: '.' none, 'P' persists, 'o' over. `cycles`: 'x' with the fault, '-' without.
std::string changes(FaultMonitor& monitor, Fault fault, const std::string& cycles) {
  std::string changes;
  for (const char cycle : cycles) {
    const Change change = monitor.observe(rule_of(fault), cycle == 'x');
    changes += change == Change::kNone ? '.' : change == Change::kPersists ? 'P' : 'o';
  }
  return changes;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(FaultMonitor, EveryFaultPersistsByItsRuleAndEndsAfterItsGoodCycles) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    FaultMonitor monitor;
    EXPECT_EQ(changes(monitor, rule.fault, std::string(rule.cycles - 1U, 'x')),
              std::string(rule.cycles - 1U, '.'));
    EXPECT_EQ(monitor.persisting(), 0U);
    EXPECT_EQ(changes(monitor, rule.fault, "x"), "P");
    EXPECT_EQ(monitor.persisting(), bit_of(rule.fault));
    EXPECT_EQ(changes(monitor, rule.fault, std::string(rule.good_cycles - 1U, '-')),
              std::string(rule.good_cycles - 1U, '.'));
    EXPECT_EQ(monitor.persisting(), bit_of(rule.fault));
    EXPECT_EQ(changes(monitor, rule.fault, "-"), "o");
    EXPECT_EQ(monitor.persisting(), 0U);
    EXPECT_EQ(changes(monitor, rule.fault, "-"), ".");
  }
}

// The fault in the first cycle of the window still counts in the last one, and no longer in the next.
TEST(FaultMonitor, EveryRuleLooksBackOverItsWindow) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    if (rule.cycles == 1) continue;
    const auto between = static_cast<std::size_t>(rule.window_cycles - rule.cycles);
    const std::string rest(rule.cycles - 1U, 'x'), quiet(rule.cycles - 1U, '.');
    FaultMonitor within, beyond;
    EXPECT_EQ(changes(within, rule.fault, 'x' + std::string(between, '-') + rest).back(), 'P');
    EXPECT_EQ(changes(beyond, rule.fault, 'x' + std::string(between + 1, '-') + rest).substr(between + 2),
              quiet);
    EXPECT_EQ(changes(beyond, rule.fault, "x"), "P");
  }
}

TEST(FaultMonitor, RespondsAgainAfterTheSameNumberOfCycles) {
  FaultMonitor monitor;
  EXPECT_EQ(changes(monitor, Fault::kAttitudeJump, "xxxxxxxxx"), "..P..P..P");
}

TEST(FaultMonitor, IntermittentFaultsPersistAsLongAsTheyRecur) {
  FaultMonitor every_second, three_of_four, every_third;
  EXPECT_EQ(changes(every_second, Fault::kOutage, repeated("x-", 8)), "......P.......P.");
  EXPECT_NE(every_second.persisting(), 0U);
  EXPECT_EQ(changes(every_second, Fault::kOutage, "--"), "..");
  EXPECT_EQ(changes(every_second, Fault::kOutage, "--"), "o.") << "four good cycles, with the one before";
  EXPECT_EQ(changes(three_of_four, Fault::kOutage, repeated("xxx-", 2)), "....P...");
  EXPECT_EQ(changes(every_third, Fault::kOutage, repeated("x--", 20)), std::string(60, '.'));
}

TEST(FaultMonitor, TrackThatRestartsAgainAndAgainIsAFault) {
  FaultMonitor monitor;
  EXPECT_EQ(changes(monitor, Fault::kTrackRestarts, "x-----x-----x"), "............P");
  EXPECT_EQ(changes(monitor, Fault::kTrackRestarts, std::string(15, '-') + "x"), std::string(16, '.'));
  EXPECT_EQ(changes(monitor, Fault::kTrackRestarts, std::string(16, '-')), std::string(15, '.') + "o");
}

TEST(FaultMonitor, HeldFaultIsNeitherOverNorRespondedToAgain) {
  FaultMonitor monitor;
  monitor.hold(Fault::kModelCorrupted);
  EXPECT_EQ(monitor.persisting(), 0U) << "only what has persisted is held";
  EXPECT_EQ(changes(monitor, Fault::kOutage, "xxxx---"), "...P...");
  monitor.hold(Fault::kOutage);
  EXPECT_EQ(changes(monitor, Fault::kOutage, "---"), "...");
  EXPECT_NE(monitor.persisting(), 0U);
  EXPECT_EQ(changes(monitor, Fault::kOutage, "-"), "o");
}

TEST(FaultMonitor, FaultsAreCountedSeparately) {
  FaultMonitor monitor;
  EXPECT_EQ(changes(monitor, Fault::kAttitudeJump, "xx"), "..");
  EXPECT_EQ(changes(monitor, Fault::kSlip, "x"), ".");
  EXPECT_EQ(changes(monitor, Fault::kAttitudeJump, "x"), "P");
}

TEST(FaultMonitor, DisabledResponsesAreStillReported) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    FaultMonitor monitor;
    const auto number = static_cast<std::uint8_t>(rule.fault);
    EXPECT_EQ(monitor.enable(number, false), rule.can_be_disabled);
    const bool quiet = rule.can_be_disabled && rule.response > Response::kFlag;
    EXPECT_EQ(monitor.response_to(rule), quiet ? Response::kFlag : rule.response);
    EXPECT_TRUE(monitor.enable(number, true));
    EXPECT_EQ(monitor.response_to(rule), rule.response);
    EXPECT_EQ(monitor.disabled(), 0U);
  }
}

TEST(FaultMonitor, UnknownFaultsAreRefused) {
  FaultMonitor monitor;
  EXPECT_FALSE(monitor.enable(kFaults, true));
  EXPECT_FALSE(monitor.enable(255, false));
}

}  // namespace
}  // namespace tumblesight::fsw
