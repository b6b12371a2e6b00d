// Verifies TS-SIL-070. Everything that renders a frame of a sequence gets the same one.
#include "sim/world/frame_renderer.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "sim/world/math/random.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

class Rendering : public ::testing::Test {
 protected:
  std::unique_ptr<gnc::RangeImage> rendered(const FrameRenderer& renderer, std::uint32_t frame) const {
    auto image = std::make_unique<gnc::RangeImage>();
    renderer.render(sequence_, frame, *image);
    return image;
  }
  std::unique_ptr<gnc::RangeImage> exposed(std::uint32_t frame, std::uint64_t noise_seed) const {
    auto image = std::make_unique<gnc::RangeImage>();
    lidar_.expose(sequence_.frames[frame], sensor_settings(sequence_.condition), swath_m_, noise_seed,
                  *image);
    return image;
  }

  TriangleMesh mesh_ = make_near_shoemaker();
  double swath_m_ = swath_m(mesh_);
  FlashLidar lidar_{mesh_};
  Sequence sequence_ = make_sequence({Condition::kDegraded, 3}, 4, 2);
};

TEST_F(Rendering, UsesTheSensorOfTheConditionAndNoiseOfItsOwnInEveryFrame) {
  const FrameRenderer renderer(lidar_, swath_m_);
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    const auto image = rendered(renderer, frame);
    EXPECT_EQ(image->rays, 100);
    EXPECT_EQ(image->fov_urad, fov_urad(swath_m_, sequence_.frames[frame].range_m));
    EXPECT_EQ(image->ranges, exposed(frame, mix(sequence_.noise_seed, frame))->ranges) << frame;
  }
}

TEST_F(Rendering, FollowsAnotherRuleForTheNoiseSeed) {
  const FrameRenderer renderer(lidar_, swath_m_, noise_seed_per_sequence);
  EXPECT_EQ(rendered(renderer, 1)->ranges, exposed(1, sequence_.noise_seed)->ranges);
}

TEST_F(Rendering, StampsTheFrameAsTheFirstSequenceOfARunUnlessAStampIsGiven) {
  const FrameRenderer renderer(lidar_, swath_m_);
  const auto image = rendered(renderer, 2);
  EXPECT_EQ(image->sequence_number, 2U);
  EXPECT_EQ(image->exposure_time_ns, 2 * kFramePeriod_ns);
  const auto ranges = image->ranges;
  renderer.render(sequence_, 2, {17, 5'000}, *image);
  EXPECT_EQ(image->sequence_number, 17U);
  EXPECT_EQ(image->exposure_time_ns, 5'000);
  EXPECT_EQ(image->ranges, ranges);
}

// Verifies TS-SIL-200.
TEST_F(Rendering, ShowsTheSameImageUnderNewStampsWhileTheSensorIsFrozen) {
  sequence_.frames[2].frozen_for = 1;
  const FrameRenderer renderer(lidar_, swath_m_);
  const auto genuine = rendered(renderer, 1);
  const auto frozen = rendered(renderer, 2);
  EXPECT_EQ(frozen->ranges, genuine->ranges);
  EXPECT_EQ(frozen->fov_urad, genuine->fov_urad);
  EXPECT_EQ(frozen->sequence_number, 2U);
  EXPECT_EQ(frozen->exposure_time_ns, 2 * kFramePeriod_ns);
}

}  // namespace
}  // namespace tumblesight::sim
