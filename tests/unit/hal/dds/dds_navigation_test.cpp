#include "hal/dds/dds_navigation.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tumblesight::hal::dds {
namespace {

NavigationSample sample_at(std::int64_t time_ns, bool valid = true) {
  NavigationSample sample{};
  sample.time_ns = time_ns;
  sample.q_inertial_lrf[0] = 1 << 29;
  sample.q_inertial_lrf[3] = -7;
  sample.valid = valid ? 1 : 0;
  return sample;
}

// Verifies TS-IFC-110.
TEST(DdsNavigation, GivesTheAttitudeNearestToTheExposure) {
  DdsNavigation navigation;
  EXPECT_FALSE(navigation.attitude_at(0).valid);
  for (const std::int64_t time_ns : {100, 300, 200}) navigation.put(sample_at(time_ns));
  EXPECT_EQ(navigation.attitude_at(200).time_ns, 200);
  EXPECT_EQ(navigation.attitude_at(201).time_ns, 200);
  EXPECT_EQ(navigation.attitude_at(290).time_ns, 300);
  EXPECT_EQ(navigation.attitude_at(std::numeric_limits<std::int64_t>::min()).time_ns, 100);
  EXPECT_EQ(navigation.attitude_at(std::numeric_limits<std::int64_t>::max()).time_ns, 300);
  const gnc::ChaserAttitude attitude = navigation.attitude_at(200);
  EXPECT_TRUE(attitude.valid);
  EXPECT_EQ(attitude.q_inertial_lrf, (gnc::QuaternionQ30{1 << 29, 0, 0, -7}));
}

// Verifies TS-IFC-110.
TEST(DdsNavigation, SkipsInvalidSamplesAndForgetsOldOnes) {
  DdsNavigation navigation;
  navigation.put(sample_at(100, false));
  EXPECT_FALSE(navigation.attitude_at(100).valid);
  for (std::int64_t time_ns = 1; time_ns <= 20; ++time_ns) navigation.put(sample_at(time_ns));
  EXPECT_EQ(navigation.attitude_at(1).time_ns, 5) << "the latest 16 are kept";
  EXPECT_EQ(navigation.attitude_at(20).time_ns, 20);
}

}  // namespace
}  // namespace tumblesight::hal::dds
