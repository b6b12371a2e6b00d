// Verifies TS-FDIR-050, TS-FDIR-060.
#include "fsw/app/fault_monitor.hpp"

#include <gtest/gtest.h>

namespace tumblesight::fsw {
namespace {

using Change = FaultMonitor::Change;

TEST(FaultMonitor, EveryFaultPersistsAfterTheCyclesOfItsRuleAndEndsWhenItIsGone) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    FaultMonitor monitor;
    for (int cycle = 1; cycle < rule.persistence_cycles; ++cycle)
      ASSERT_EQ(monitor.observe(rule.fault, true), Change::kNone);
    EXPECT_EQ(monitor.persisting(), 0U);
    EXPECT_EQ(monitor.observe(rule.fault, true), Change::kPersists);
    EXPECT_EQ(monitor.persisting(), bit_of(rule.fault));
    EXPECT_EQ(monitor.observe(rule.fault, false), Change::kOver);
    EXPECT_EQ(monitor.persisting(), 0U);
    EXPECT_EQ(monitor.observe(rule.fault, false), Change::kNone);
  }
}

TEST(FaultMonitor, RespondsAgainAfterTheSameNumberOfCycles) {
  FaultMonitor monitor;
  int responses = 0;
  for (int cycle = 0; cycle < 9; ++cycle)
    responses += monitor.observe(Fault::kAttitudeJump, true) == Change::kPersists;
  EXPECT_EQ(responses, 3);
}

TEST(FaultMonitor, AGoodCycleRestartsTheCount) {
  FaultMonitor monitor;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(monitor.observe(Fault::kAttitudeJump, true), Change::kNone);
    EXPECT_EQ(monitor.observe(Fault::kAttitudeJump, true), Change::kNone);
    EXPECT_EQ(monitor.observe(Fault::kAttitudeJump, false), Change::kNone);
  }
}

TEST(FaultMonitor, FaultsAreCountedSeparately) {
  FaultMonitor monitor;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(monitor.observe(Fault::kAttitudeJump, true), Change::kNone);
  EXPECT_EQ(monitor.observe(Fault::kSlip, true), Change::kNone);
  EXPECT_EQ(monitor.observe(Fault::kAttitudeJump, true), Change::kPersists);
}

TEST(FaultMonitor, DisabledResponsesAreStillReported) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    FaultMonitor monitor;
    const auto number = static_cast<std::uint8_t>(rule.fault);
    EXPECT_EQ(monitor.enable(number, false), rule.can_be_disabled);
    const bool quiet = rule.can_be_disabled && rule.response > Response::kFlag;
    EXPECT_EQ(monitor.response_to(rule.fault), quiet ? Response::kFlag : rule.response);
    EXPECT_TRUE(monitor.enable(number, true));
    EXPECT_EQ(monitor.response_to(rule.fault), rule.response);
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
