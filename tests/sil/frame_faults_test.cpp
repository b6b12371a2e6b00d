// What the flight program gets of a sensor with a fault.
// Verifies TS-SIL-198.
#include "sim/sil/frame_faults.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

class Sensor : public testing::Test {
 protected:
  // Delivers frame k, whose first range is 100 + k.
  std::vector<const gnc::RangeImage*> step(std::uint32_t k) {
    frame_ = {};
    frame_.rays = 16;
    frame_.sequence_number = k;
    frame_.exposure_time_ns = 1000 * k;
    frame_.ranges[0] = static_cast<std::uint16_t>(100 + k);
    StepInput input;
    input.frames = {&frame_};
    truth_ = {Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 1.0};
    faults_.apply(input, truth_);
    return input.frames;
  }
  gnc::RangeImage frame_{};
  FrameTruth truth_{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 1.0};
  FrameFaults faults_;
};

TEST_F(Sensor, WithoutAFaultDeliversItsFrames) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    const auto frames = step(k);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0]->ranges[0], 100 + k);
    EXPECT_TRUE(truth_.is_genuine());
  }
}

TEST_F(Sensor, ThatDropsFramesDeliversNoneForSoManySteps) {
  step(0);
  faults_.begin(FrameFaults::Kind::kDrop, 2);
  for (std::uint32_t k = 1; k < 3; ++k) {
    EXPECT_TRUE(step(k).empty());
    EXPECT_TRUE(truth_.lost);
  }
  EXPECT_EQ(step(3).size(), 1U);
  EXPECT_TRUE(truth_.is_genuine());
}

TEST_F(Sensor, ThatIsFrozenRepeatsItsLastImageUnderNewNumbers) {
  step(0);
  step(1);
  faults_.begin(FrameFaults::Kind::kFreeze, 2);
  for (std::uint32_t k = 2; k < 4; ++k) {
    const auto frames = step(k);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0]->ranges[0], 101);
    EXPECT_EQ(frames[0]->sequence_number, k);
    EXPECT_EQ(frames[0]->exposure_time_ns, 1000 * k);
    EXPECT_EQ(truth_.frozen_for, k - 1);
  }
  EXPECT_EQ(step(4)[0]->ranges[0], 104);
}

TEST_F(Sensor, ThatIsFrozenFromTheFirstFrameOnDeliversThatOne) {
  faults_.begin(FrameFaults::Kind::kFreeze, 3);
  EXPECT_EQ(step(0)[0]->ranges[0], 100);
  EXPECT_TRUE(truth_.is_genuine());
  EXPECT_EQ(step(1)[0]->ranges[0], 100);
  EXPECT_EQ(truth_.frozen_for, 1U);
}

TEST_F(Sensor, ThatFreezesAgainWhileItIsFrozenGoesOnWithTheSameImage) {
  step(0);
  faults_.begin(FrameFaults::Kind::kFreeze, 3);
  step(1);
  faults_.begin(FrameFaults::Kind::kFreeze, 3);
  EXPECT_EQ(step(2)[0]->ranges[0], 100);
  EXPECT_EQ(truth_.frozen_for, 2U);
}

TEST_F(Sensor, ThatIsLateDeliversEachFrameAStepLaterUnderItsOwnNumber) {
  step(0);
  faults_.begin(FrameFaults::Kind::kDelay, 2);
  EXPECT_TRUE(step(1).empty());
  auto frames = step(2);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0]->sequence_number, 1U);
  EXPECT_EQ(frames[0]->exposure_time_ns, 1000);
  frames = step(3);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]->ranges[0], 102);
  EXPECT_EQ(frames[1]->ranges[0], 103);
  EXPECT_EQ(step(4).size(), 1U);
}

TEST(FrameFaults, AreKnownByTheirNames) {
  FrameFaults::Kind kind{};
  EXPECT_TRUE(read_fault("freeze", kind));
  EXPECT_EQ(kind, FrameFaults::Kind::kFreeze);
  EXPECT_TRUE(read_fault("drop", kind) && read_fault("delay", kind));
  EXPECT_FALSE(read_fault("melt", kind));
}

}  // namespace
}  // namespace tumblesight::sim
