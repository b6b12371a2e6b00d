// The float32 reference on the frames of a fixed-point model.
#include "sim/evaluation/float32_reference.hpp"

#include <gtest/gtest.h>

#include "sim/world/chaser_navigation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kFrames = 3;

class Float32ReferenceTest : public ::testing::Test {
 protected:
  Float32Reference reference_for(const std::vector<std::uint8_t>& model) {
    return {here.path("a.tsm"), model, gnc::test_header().target.data()};
  }

  const TemporaryFolder here;
  const std::vector<std::uint8_t> fixed_point = gnc::random_model_image<gnc::FixedPoint>(3);
  const std::vector<std::uint8_t> float32 = gnc::random_model_image<gnc::Float32>(4);
};

TEST_F(Float32ReferenceTest, ExistsOnlyForAFixedPointModelWithAReferenceFile) {
  EXPECT_FALSE(reference_for(fixed_point)) << "no file";
  here.put("a.float32.tsm", fixed_point);
  EXPECT_FALSE(reference_for(fixed_point)) << "no reference";
  here.put("a.float32.tsm", {float32.begin(), float32.end() - 1});
  EXPECT_FALSE(reference_for(fixed_point)) << "damaged";
  here.put("a.float32.tsm", float32);
  EXPECT_TRUE(reference_for(fixed_point));
  EXPECT_FALSE(reference_for(float32)) << "the model is float32 itself";
}

TEST_F(Float32ReferenceTest, ComparesTheFramesThatBothHave) {
  here.put("a.float32.tsm", float32);
  Float32Reference reference = reference_for(fixed_point);
  ASSERT_TRUE(reference);

  // Results to compare with: the reference's own attitudes, rotated by 2 degrees.
  HostEstimator estimator(float32);
  std::vector<FrameResult> results;
  for (std::uint32_t k = 0; k < 2 * kFrames; ++k) {
    gnc::RangeImage frame = gnc::random_frame(k);
    frame.sequence_number = k;
    frame.exposure_time_ns = k * kFramePeriod_ns;
    const gnc::ChaserAttitude chaser = chaser_attitude({}, frame.exposure_time_ns, true);
    reference.add(k / kFrames, k % kFrames, {}, frame, chaser);
    if (k % kFrames == 0) estimator.reset();
    const gnc::FrameOutcome outcome = estimator.step(frame, chaser);
    ASSERT_TRUE(outcome.used());
    FrameResult result;
    result.sequence = k / kFrames;
    result.frame = k % kFrames;
    result.valid = true;
    result.rcnn = gnc::to_double(outcome.estimate.q_lrf_trf) *
                  Eigen::AngleAxisd(2.0 * M_PI / 180.0, Eigen::Vector3d::UnitX());
    if (k != 1) results.push_back(result);  // one is missing
  }
  // Frames that were not delivered have a result in `results` only.
  for (std::size_t at : {std::size_t{0}, results.size() / 2, results.size()}) {
    FrameResult lost;
    lost.sequence = at == 0 ? 0 : at == results.size() ? 1 : results[at].sequence;
    lost.frame = at < results.size() ? results[at].frame : kFrames;
    results.insert(results.begin() + static_cast<std::ptrdiff_t>(at), lost);
  }
  const NumericsComparison comparison = reference.compare(results, kFrames);
  EXPECT_EQ(comparison.difference.count, 2 * kFrames - 1);
  EXPECT_NEAR(comparison.difference.mean_deg, 2.0, 1e-5);
  EXPECT_NEAR(comparison.largest_difference_deg, 2.0, 1e-5);
  EXPECT_EQ(comparison.float32.count, 2U);
}

}  // namespace
}  // namespace tumblesight::sim
