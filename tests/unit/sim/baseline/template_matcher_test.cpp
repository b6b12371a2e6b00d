// The baseline finds the attitude of a known target from one frame, wherever the target is in the frame, and
// reports if it cannot.
#include "sim/baseline/template_matcher.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <memory>
#include <stdexcept>

#include "sim/world/math/random.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "tests/unit/sim/baseline/jointed_arm.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kDegree_rad = 0.017453292519943295;
constexpr TemplateMatcherSettings kSmall{300, 24, 8, 8, AlignmentPairs::kRangesAndSilhouette};

class TemplateMatcherTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TriangleMesh mesh = jointed_arm();
    lidar_ = std::make_unique<FlashLidar>(mesh);
    matcher_ = std::make_unique<TemplateMatcher>(mesh, swath_m(mesh), kSmall);
  }
  static void TearDownTestSuite() {
    matcher_.reset();
    lidar_.reset();
  }

  static std::unique_ptr<gnc::RangeImage> expose(const FrameTruth& truth, bool noise,
                                                 std::uint64_t seed = 1) {
    auto frame = std::make_unique<gnc::RangeImage>();
    SensorSettings settings;
    settings.noise = noise;
    lidar_->expose(truth, settings, swath_m(jointed_arm()), seed, *frame);
    return frame;
  }
  static double error_deg(const FrameTruth& truth, const gnc::RangeImage& frame) {
    const TemplateMatcher::Result result = matcher_->match(frame);
    EXPECT_TRUE(result.valid);
    return truth.q_lrf_trf.angularDistance(result.q_lrf_trf) / kDegree_rad;
  }

  static std::unique_ptr<FlashLidar> lidar_;
  static std::unique_ptr<TemplateMatcher> matcher_;
};

std::unique_ptr<FlashLidar> TemplateMatcherTest::lidar_;
std::unique_ptr<TemplateMatcher> TemplateMatcherTest::matcher_;

FrameTruth truth_at(const Eigen::Quaterniond& q, double range_m) {
  FrameTruth truth{q.normalized(), Eigen::Vector3d::Zero(), range_m};
  return truth;
}

TEST_F(TemplateMatcherTest, FindsANoiseFreeAttitudeWithinADegree) {
  const FrameTruth truth = truth_at({0.3, -0.5, 0.7, 0.4}, 40.0);
  const auto frame = expose(truth, false);
  EXPECT_LT(error_deg(truth, *frame), 1.0);
  EXPECT_LT(matcher_->match(*frame).residual_m, 0.5);  // at most a fifth of the limit of 3 sigma
}

TEST_F(TemplateMatcherTest, FindsMostNoisyAttitudesAtAllRanges) {
  constexpr int kFrames = 15;
  int found = 0;
  for (int i = 0; i < kFrames; ++i) {
    const FrameTruth truth = make_sequence({}, 21, i).frames[0];
    found += error_deg(truth, *expose(truth, true, mix(3, i))) < 3.0 ? 1 : 0;
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST_F(TemplateMatcherTest, FindsTheSameAttitudeOffTheBoresight) {
  FrameTruth truth = truth_at({0.6, 0.2, -0.3, 0.7}, 30.0);
  EXPECT_LT(error_deg(truth, *expose(truth, true)), 2.0);
  truth.offset_swaths = Eigen::Vector2d(0.12, -0.1);
  EXPECT_LT(error_deg(truth, *expose(truth, true)), 2.0);
}

TEST_F(TemplateMatcherTest, IgnoresPartsOfTheChaserInView) {
  const FrameTruth truth = truth_at({0.6, 0.2, -0.3, 0.7}, 30.0);
  const auto frame = expose(truth, true);
  int hidden = 0;
  for (int row = 0; row < frame->rays; ++row) {
    for (int column = 56; column < 68; ++column) {
      std::uint16_t& range = frame->ranges[row * frame->rays + column];
      hidden += range > 0 ? 1 : 0;
      range = 3 * 128;
    }
  }
  ASSERT_GT(hidden, 100);
  EXPECT_LT(error_deg(truth, *frame), 3.0);
}

TEST_F(TemplateMatcherTest, RefusesFramesThatShowNoTarget) {
  auto frame = expose(truth_at(Eigen::Quaterniond::Identity(), 50.0), true);
  frame->fov_urad = 0;
  EXPECT_FALSE(matcher_->match(*frame).valid);
  frame = expose(truth_at(Eigen::Quaterniond::Identity(), 50.0), true);
  frame->rays = 129;
  EXPECT_FALSE(matcher_->match(*frame).valid);
  frame->rays = 128;
  frame->ranges.fill(3 * 128);
  std::fill_n(frame->ranges.begin(), gnc::kMinReturns - 1, std::uint16_t{50 * 128});
  EXPECT_FALSE(matcher_->match(*frame).valid);
}

TEST_F(TemplateMatcherTest, GivesTheSameBitsAgainAndFromSeveralThreads) {
  const auto frame = expose(make_sequence({}, 5, 1).frames[0], true);
  const TemplateMatcher::Result once = matcher_->match(*frame);
  const auto match = [&] { return matcher_->match(*frame); };
  auto first = std::async(std::launch::async, match), second = std::async(std::launch::async, match);
  for (auto* other : {&first, &second}) {
    const TemplateMatcher::Result result = other->get();
    EXPECT_EQ(result.q_lrf_trf.coeffs(), once.q_lrf_trf.coeffs());
    EXPECT_EQ(result.residual_m, once.residual_m);
  }
}

TEST(TemplateMatcherSettings, OutsideTheirLimitsAreNamed) {
  TemplateMatcherSettings settings;
  settings.rolls = 30;
  try {
    TemplateMatcher(jointed_arm(), 6.0, settings);
    FAIL() << "accepted 30 rolls";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "template matcher: rolls is 30, but must be a positive multiple of 4");
  }
}

}  // namespace
}  // namespace tumblesight::sim
