#include "sim/adoption/outlook.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tumblesight::sim {
namespace {

std::vector<TrainingPoint> course(double exponent, int count) {
  std::vector<TrainingPoint> points;
  for (int i = 1; i <= count; ++i) {
    TrainingPoint point;
    point.stage = "cnn";
    point.samples = 32'000 * i;
    point.mean_deg = 10.0 * std::pow(i, -exponent);
    points.push_back(point);
  }
  return points;
}

TEST(Outlook, FindsTheExponentOfAPowerLaw) {
  for (const double exponent : {0.2, 0.5, 0.9}) {
    const auto outlook = outlook_of(course(exponent, 20));
    ASSERT_TRUE(outlook);
    EXPECT_NEAR(outlook->exponent, exponent, 1e-9);
    EXPECT_NEAR(outlook->error_factor(2.0), std::pow(2.0, -exponent), 1e-9);
  }
}

TEST(Outlook, PromisesNothingOfACourseThatRises) {
  EXPECT_EQ(outlook_of(course(-0.3, 20))->error_factor(4.0), 1.0);
}

TEST(Outlook, NeedsFourPointsOfTheCnn) {
  EXPECT_FALSE(outlook_of(course(0.5, 4)));
  std::vector<TrainingPoint> recurrent = course(0.5, 20);
  for (TrainingPoint& point : recurrent) point.stage = "rcnn";
  EXPECT_FALSE(outlook_of(recurrent));
}

}  // namespace
}  // namespace tumblesight::sim
