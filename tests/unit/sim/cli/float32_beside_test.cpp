// The float32 reference that runs beside a fixed-point model in `tumblesight simulate`.
#include "sim/cli/float32_beside.hpp"

#include <gtest/gtest.h>

#include "tests/support/test_models.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kFrames = 3;

class Float32BesideTest : public ::testing::Test {
 protected:
  void put(const char* name, const std::vector<std::uint8_t>& image) {
    std::ofstream(here.path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  }
  Float32Beside beside(const std::vector<std::uint8_t>& model) {
    return {here.path("a.tsm"), model, gnc::test_header().target.data()};
  }

  Workplace here;
  const std::vector<std::uint8_t> fixed_point = gnc::random_model_image<gnc::FixedPoint>(3);
  const std::vector<std::uint8_t> float32 = gnc::random_model_image<gnc::Float32>(4);
};

TEST_F(Float32BesideTest, IsThereOnlyForAFixedPointModelWithItsReferenceBesideIt) {
  EXPECT_FALSE(beside(fixed_point)) << "no file";
  put("a.float32.tsm", fixed_point);
  EXPECT_FALSE(beside(fixed_point)) << "no reference";
  put("a.float32.tsm", {float32.begin(), float32.end() - 1});
  EXPECT_FALSE(beside(fixed_point)) << "damaged";
  put("a.float32.tsm", float32);
  EXPECT_TRUE(beside(fixed_point));
  EXPECT_FALSE(beside(float32)) << "float32 flies already";
}

TEST_F(Float32BesideTest, ComparesFrameByFrameWhatBothAnswered) {
  put("a.float32.tsm", float32);
  Float32Beside reference = beside(fixed_point);
  ASSERT_TRUE(reference);

  // What the flight program is said to have answered: the reference's own attitudes, turned by 2 degrees.
  HostEstimator estimator(float32);
  std::vector<FrameResult> results;
  for (std::uint32_t k = 0; k < 2 * kFrames; ++k) {
    StepRecord step;
    step.sequence = k / kFrames;
    step.frame_index = k % kFrames;
    const gnc::RangeImage frame = gnc::random_frame(k);
    reference.frame_sent(step, frame);
    if (step.frame_index == 0) estimator.reset();
    gnc::AttitudeEstimate estimate;
    ASSERT_EQ(estimator.step(frame, estimate), gnc::FrameStatus::kOk);
    FrameResult result;
    result.sequence = step.sequence;
    result.frame = step.frame_index;
    result.valid = true;
    result.rcnn =
        gnc::to_double(estimate.q_lrf_trf) * Eigen::AngleAxisd(2.0 * M_PI / 180.0, Eigen::Vector3d::UnitX());
    if (k != 1) results.push_back(result);  // one was not answered
  }
  const NumericsComparison comparison = reference.compare(results, kFrames);
  EXPECT_EQ(comparison.difference.count, 2 * kFrames - 1);
  EXPECT_NEAR(comparison.difference.mean_deg, 2.0, 1e-5);
  EXPECT_NEAR(comparison.largest_difference_deg, 2.0, 1e-5);
  EXPECT_EQ(comparison.float32.count, 2U);
}

}  // namespace
}  // namespace tumblesight::sim
