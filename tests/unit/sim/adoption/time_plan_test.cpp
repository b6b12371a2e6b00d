#include "sim/adoption/time_plan.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace tumblesight::sim {
namespace {

TEST(TimePlan, FillsTheTimeAndKeepsWhatComesAfterTheTraining) {
  for (const double minutes : {5.0, 15.0, 60.0, 600.0}) {
    const TimePlan plan = time_plan(60.0 * minutes, 5, 0.01, 0);
    EXPECT_NEAR(plan.cnn_s + plan.rcnn_s + plan.after_s, 60.0 * minutes, 1e-6);
    EXPECT_GE(plan.after_s, 5 * plan.sequences * 0.01) << minutes;
    EXPECT_GT(plan.cnn_s, plan.rcnn_s);
    EXPECT_GE(plan.sequences, 20U);
    EXPECT_LE(plan.sequences, 900U);
  }
  EXPECT_EQ(time_plan(3600.0, 5, 0.01, 0).sequences, 900U);
  EXPECT_EQ(time_plan(3600.0, 5, 0.01, 33).sequences, 33U);
}

TEST(TimePlan, TooLittleTimeIsRefusedWithTheLeast) {
  try {
    (void)time_plan(20.0, 5, 0.02, 0);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("--minutes"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim
