// The registered pose in the attitude report. The attitudes of the random network are those of no target, so
// that no pose here is verified; tests/sil/shipped_network_test.cpp has those that are.
#include <algorithm>
#include <array>

#include "gnc/rcnn/model_image.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

// The test's model with a box as surface, about as large as what its frames show.
std::vector<std::uint8_t> image_with_surface() {
  constexpr int kHalf = 16'000;  // of 32767: 1.6 m
  constexpr std::array<std::array<int, 4>, 6> kSides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<int> numbers{8, 24, 0, 0};  // corners, triangles, edges, error
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) numbers.push_back((corner >> axis & 1) != 0 ? kHalf : -kHalf);
  for (const auto& [a, b, c, d] : kSides)
    for (const int corner : {a, b, c, a, c, b, a, c, d, a, d, c}) numbers.push_back(corner);
  std::vector<std::uint8_t> image = test_model_image();
  std::uint8_t* at =
      image.data() + (gnc::kModelImageSize<gnc::FixedPoint> - gnc::kMeshBytes<gnc::FixedPoint>);
  for (const int number : numbers) {
    *at++ = static_cast<std::uint8_t>(number & 0xFF);
    *at++ = static_cast<std::uint8_t>((number >> 8) & 0xFF);
  }
  return gnc::with_changed_weights(image, {});  // with correct CRCs
}

class PoseReport : public AppFixture {
 protected:
  void init_with_surface() {
    store.fill(image_with_surface());
    init(store);
  }
  const gnc::PoseEstimate& pose() { return AppMemory::estimate(*app).pose; }
};

TEST_F(PoseReport, IsThatOfTheEstimate) {
  init_with_surface();
  for (int k = 0; k < 3; ++k) step_good();
  const hal::AttitudeReport& report = out->attitude;
  ASSERT_TRUE(pose().is_known());
  EXPECT_EQ(report.pose_doubts, pose().doubts);
  EXPECT_EQ(report.pose_frames, pose().poses);
  EXPECT_EQ(report.pose_q_lrf_trf, pose().state.q_lrf_trf);
  EXPECT_EQ(report.pose_origin_lrf_um, pose().state.origin_lrf_um);
  EXPECT_EQ(report.pose_rate_lrf_urad_s, pose().state.rate_lrf_urad_s);
  EXPECT_EQ(report.pose_velocity_lrf_um_s, pose().state.velocity_lrf_um_s);
  EXPECT_EQ(report.pose_sigma, pose().covariance.sigma);
  EXPECT_EQ(report.pose_correlation_q15, pose().covariance.correlation_q15);
  EXPECT_EQ(report.pose_mean_square_q8, static_cast<std::uint32_t>(pose().evidence.mean_square_q8()));
  EXPECT_EQ(report.pose_unexplained_ppm, pose().evidence.unexplained_ppm());
  EXPECT_EQ(report.pose_missing_ppm, pose().evidence.missing_ppm());
  EXPECT_EQ(report.pose_advantage_q8, pose().conservative_llr_q8);
  // The cycle is at the time of the exposure.
  EXPECT_EQ(report.pose_origin_lrf_now_um, report.pose_origin_lrf_um);
  EXPECT_EQ(report.pose_velocity_lrf_now_um_s, report.pose_velocity_lrf_um_s);
  EXPECT_EQ(out->telemetry.poses_verified, 0U);
}

TEST_F(PoseReport, IsUnknownWithoutASurface) {
  init_with_model();
  step_good();
  ASSERT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.pose_doubts, hal::kPoseDoubtUnknown);
  EXPECT_EQ(out->attitude.pose_q_lrf_trf, gnc::kIdentityQ30);
  EXPECT_EQ(out->attitude.pose_sigma, hal::AttitudeReport().pose_sigma);
  EXPECT_EQ(events(EventId::kPoseDoubtful), 0);
}

TEST_F(PoseReport, AVerdictThatIsLostIsReportedOnce) {
  init_with_surface();
  step_good();
  AppMemory::state(*app).pose_is_verified = true;
  AppMemory::commit(*app);
  step_good();
  ASSERT_NE(out->attitude.pose_doubts, 0);
  EXPECT_EQ(events(EventId::kPoseDoubtful), 1);
  EXPECT_EQ(argument(EventId::kPoseDoubtful, 0), static_cast<std::int32_t>(sequence_number));
  EXPECT_EQ(argument(EventId::kPoseDoubtful, 1), out->attitude.pose_doubts);
  step_good();
  EXPECT_EQ(events(EventId::kPoseDoubtful), 0);
}

}  // namespace
}  // namespace tumblesight::fsw
