// What viewers show of a step, or of the part of it that is known.
#include "sim/recording/foxglove_messages.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

namespace tumblesight::sim {
namespace {

using nlohmann::json;
constexpr std::int64_t kTime_ns = 5'000'000'000, kExposure_ns = 3'000'000'007;

hal::AttitudeReport report() {
  hal::AttitudeReport report;
  report.validity = hal::Validity::kValid;
  report.exposure_time_ns = kExposure_ns;
  report.q_lrf_trf = {1, 0, 0, 0};
  report.pose_doubts = hal::kPoseDoubtUnknown;
  return report;
}
FrameTruth truth() {
  FrameTruth truth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 30.0};
  truth.offset_swaths = {0.25, -0.5};
  return truth;
}
std::vector<std::string> messages(const ShownStep& step, View view) {
  return messages_of(step, ShownTime(), view);
}
json transforms(const ShownStep& step) {
  return json::parse(messages(step, View::kTransforms).at(0))["transforms"];
}

TEST(ShownTime, CountsFromTheFirstStepIfThatIsBefore0) {
  ShownTime plain, early;
  EXPECT_EQ(plain(-3), 0);
  plain.begin_with(4);
  EXPECT_EQ(plain(7), 7);
  early.begin_with(-4);
  early.begin_with(-9);
  EXPECT_EQ(early(-4), 0);
  EXPECT_EQ(early(7), 11);
}

TEST(MessagesOf, AFrameAloneHasItsPoints) {
  const auto frame = std::make_unique<gnc::RangeImage>();
  ShownStep step;
  step.frames = {frame.get(), frame.get()};
  EXPECT_EQ(messages(step, View::kPoints).size(), 2U);
  for (const View view : {View::kTransforms, View::kLog, View::kFigures})
    EXPECT_TRUE(messages(step, view).empty());
}

TEST(MessagesOf, ATruthWithoutAnAnswerHasItsTargetAndNoFigures) {
  const FrameTruth known = truth();
  ShownStep step;
  step.time_ns = kTime_ns;
  step.truth = &known;
  step.swath_m = 8.0;
  const json shown = transforms(step);
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0]["child_frame_id"], "target_true");
  EXPECT_EQ(shown[0]["translation"], (json{{"x", 2.0}, {"y", 30.0}, {"z", -4.0}}));
  EXPECT_EQ(shown[0]["timestamp"], (json{{"sec", 5}, {"nsec", 0}}));
  EXPECT_TRUE(messages(step, View::kFigures).empty());
}

// Also where the answer came later.
TEST(MessagesOf, TheTargetIsThereAtTheExposureOfTheAttitude) {
  const hal::AttitudeReport answer = report();
  const FrameTruth known = truth();
  ShownStep step;
  step.time_ns = kTime_ns;
  step.report = &answer;
  step.truth = &known;
  const json shown = transforms(step);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[1]["child_frame_id"], "target_network");
  for (const json& one : shown) EXPECT_EQ(one["timestamp"], (json{{"sec", 3}, {"nsec", 7}}));
  EXPECT_EQ(json::parse(messages(step, View::kFigures).at(0))["network_error_deg"], 0.0);
}

TEST(MessagesOf, EachEventIsOneText) {
  ShownStep step;
  step.events.resize(3);
  EXPECT_EQ(messages(step, View::kLog).size(), 3U);
}

}  // namespace
}  // namespace tumblesight::sim
