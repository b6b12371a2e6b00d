#include "hal/dds/idl/step_content.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace tumblesight::hal::dds {
namespace {

struct Samples {
  LidarFrameSample frame{};
  NavigationSample navigation{};
  CommandSample command{};

  Samples() {
    frame.run_id = navigation.run_id = command.run_id = 7;
    frame.k = navigation.k = command.k = 3;
    frame.sequence_number = 3;
    frame.exposure_time_ns = 10'800'000'000;
    frame.fov_urad = 350'000;
    frame.rays = 64;
    frame.ranges[5] = 6400;
    navigation.time_ns = frame.exposure_time_ns;
    navigation.q_inertial_lrf[0] = 1 << 30;
    navigation.valid = 1;
    command.size = 30;
    command.bytes[0] = 0x19;
  }
  StepContent content() const {
    StepContent result;
    result.add(frame);
    result.add(navigation);
    result.add(command);
    return result;
  }
};

// Verifies TS-SIL-090.
TEST(StepContent, AnyChangeOfASampleIsSeen) {
  const Samples sent;
  StepSample step{};
  sent.content().announce_in(step);
  EXPECT_EQ(step.frames, 1);
  EXPECT_EQ(step.navigations, 1);
  EXPECT_EQ(step.commands, 1);
  EXPECT_TRUE(sent.content().is_that_of(step));
  const std::function<void(Samples&)> changes[] = {
      [](Samples& s) { ++s.frame.run_id; },
      [](Samples& s) { ++s.frame.k; },
      [](Samples& s) { ++s.frame.sequence_number; },
      [](Samples& s) { ++s.frame.exposure_time_ns; },
      [](Samples& s) { s.frame.exposure_time_ns ^= std::int64_t{1} << 40; },
      [](Samples& s) { ++s.frame.fov_urad; },
      [](Samples& s) { ++s.frame.rays; },
      [](Samples& s) { s.frame.ranges[16'383] = 1; },
      [](Samples& s) { ++s.command.run_id; },
      [](Samples& s) { ++s.command.k; },
      [](Samples& s) { ++s.command.size; },
      [](Samples& s) { s.command.bytes[1059] = 1; },
      [](Samples& s) { ++s.navigation.run_id; },
      [](Samples& s) { ++s.navigation.k; },
      [](Samples& s) { ++s.navigation.time_ns; },
      [](Samples& s) { ++s.navigation.q_inertial_lrf[3]; },
      [](Samples& s) { s.navigation.valid = 0; }};
  for (const auto& change : changes) {
    const auto arrived = std::make_unique<Samples>(sent);
    change(*arrived);
    EXPECT_TRUE(arrived->content().has_all_of(step));
    EXPECT_FALSE(arrived->content().is_that_of(step)) << "change " << &change - changes;
  }
}

TEST(StepContent, IsCompleteInAnyOrderOfTheTopics) {
  const Samples sent;
  StepSample step{};
  sent.content().announce_in(step);
  StepContent content;
  content.add(sent.command);
  EXPECT_FALSE(content.has_all_of(step));
  content.add(sent.frame);
  EXPECT_FALSE(content.has_all_of(step));
  content.add(sent.navigation);
  EXPECT_TRUE(content.has_all_of(step));
  EXPECT_TRUE(content.is_that_of(step));
  content.add(sent.frame);
  EXPECT_FALSE(content.is_that_of(step)) << "a frame more than announced";
}

}  // namespace
}  // namespace tumblesight::hal::dds
