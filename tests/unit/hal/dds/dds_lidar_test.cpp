#include "hal/dds/dds_lidar.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace tumblesight::hal::dds {
namespace {

// Verifies TS-LID-052.
TEST(DdsLidar, CountsTheFramesThatItDrops) {
  constexpr std::uint32_t kKept = 2 * kMaxFramesPerStep;
  const auto lidar = std::make_unique<DdsLidar>();
  const auto sample = std::make_unique<LidarFrameSample>();
  sample->rays = 16;
  for (std::uint32_t number = 0; number < kKept + 3; ++number) {
    sample->sequence_number = number;
    lidar->put(*sample);
  }
  EXPECT_EQ(lidar->take_dropped(), 3U);
  EXPECT_EQ(lidar->take_dropped(), 0U);
  const auto frame = std::make_unique<gnc::RangeImage>();
  for (std::uint32_t number = 3; number < kKept + 3; ++number) {
    EXPECT_EQ(lidar->receive(*frame), LidarStatus::kFrame);
    EXPECT_EQ(frame->sequence_number, number);
  }
  EXPECT_EQ(lidar->receive(*frame), LidarStatus::kNoFrame);
}

}  // namespace
}  // namespace tumblesight::hal::dds
