// Verifies TS-IFC-080.
#include "hal/replay/recording.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hal/replay/replay_inputs.hpp"

namespace tumblesight::hal::replay {
namespace {

constexpr int kRays = 32;

gnc::RangeImage frame_number(std::uint32_t k) {
  gnc::RangeImage frame;
  frame.rays = kRays;
  frame.fov_urad = 140'000 + k;
  frame.sequence_number = k;
  frame.exposure_time_ns = std::int64_t{2'700'000'000} * k;
  // Empty rows, a full row, a row with a hole, and rows with one return at an end.
  for (int i = 0; i < kRays; ++i) frame.ranges[3 * kRays + i] = static_cast<std::uint16_t>(0xFF00 + i);
  frame.ranges[5 * kRays + 4] = 6400;
  frame.ranges[5 * kRays + 9] = static_cast<std::uint16_t>(6401 + k);
  frame.ranges[7 * kRays] = 1;
  frame.ranges[31 * kRays + 31] = 2;
  return frame;
}

gnc::ChaserAttitude attitude_number(std::uint32_t k) {
  const auto part = static_cast<std::int32_t>(k);
  return {std::int64_t{2'700'000'000} * k - 3, {1 << 30, -part, part, -(1 << 30)}, k != 1};
}

std::vector<std::uint8_t> recorded(std::uint32_t frames) {
  std::vector<std::uint8_t> bytes(kRecordingHeaderSize + frames * kRecordedFrameSize + kRecordingCrcSize);
  std::size_t size = write_recording_header(kRays, frames, bytes.data());
  for (std::uint32_t k = 0; k < frames; ++k)
    size += write_recorded_frame(frame_number(k), attitude_number(k), bytes.data() + size);
  size += write_recording_crc(bytes.data(), size, bytes.data() + size);
  bytes.resize(size);
  return bytes;
}

// Renews the CRC after a change.
void renew_crc(std::vector<std::uint8_t>& bytes) {
  write_recording_crc(bytes.data(), bytes.size() - kRecordingCrcSize,
                      bytes.data() + bytes.size() - kRecordingCrcSize);
}

TEST(RecordingTest, ReturnsTheFramesBitForBit) {
  const auto bytes = recorded(3);
  Recording recording;
  ASSERT_EQ(recording.open(bytes.data(), bytes.size()), RecordingStatus::kOk);
  EXPECT_EQ(recording.frames(), 3U);
  for (std::uint32_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(recording.has_next());
    EXPECT_FALSE(recording.was_read());
    EXPECT_EQ(recording.next_sequence_number(), k);
    const gnc::RangeImage expected = frame_number(k);
    EXPECT_EQ(recording.next_exposure_time_ns(), expected.exposure_time_ns);
    gnc::RangeImage frame;
    frame.ranges.fill(77);
    recording.read_next(frame);
    EXPECT_EQ(frame.sequence_number, expected.sequence_number);
    EXPECT_EQ(frame.exposure_time_ns, expected.exposure_time_ns);
    EXPECT_EQ(frame.fov_urad, expected.fov_urad);
    EXPECT_EQ(frame.rays, expected.rays);
    EXPECT_EQ(frame.ranges, expected.ranges);
    const gnc::ChaserAttitude chaser = ReplayNavigation(recording).attitude_at(0);
    EXPECT_EQ(chaser.time_ns, attitude_number(k).time_ns);
    EXPECT_EQ(chaser.q_inertial_lrf, attitude_number(k).q_inertial_lrf);
    EXPECT_EQ(chaser.valid, attitude_number(k).valid);
  }
  EXPECT_FALSE(recording.has_next());
  EXPECT_TRUE(recording.was_read());
}

TEST(RecordingTest, VersionOneHasNoAttitudesOfTheChaser) {
  const auto with = recorded(2);
  constexpr std::size_t kAttitudeSize = 25;
  Recording recording;
  ASSERT_EQ(recording.open(with.data(), with.size()), RecordingStatus::kOk);
  gnc::RangeImage frame;
  recording.read_next(frame);
  ASSERT_TRUE(recording.chaser_attitude().valid);
  const std::size_t frame_size = (with.size() - kRecordingHeaderSize - kRecordingCrcSize) / 2;
  std::vector<std::uint8_t> without = with;
  for (const std::size_t k : {std::size_t{1}, std::size_t{0}}) {
    const auto at = static_cast<std::ptrdiff_t>(kRecordingHeaderSize + k * frame_size + 16);
    without.erase(without.begin() + at, without.begin() + at + kAttitudeSize);
  }
  without[4] = 1;
  renew_crc(without);
  ASSERT_EQ(recording.open(without.data(), without.size()), RecordingStatus::kOk);
  for (std::uint32_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(recording.has_next());
    recording.read_next(frame);
    EXPECT_EQ(frame.ranges, frame_number(k).ranges);
    EXPECT_FALSE(ReplayNavigation(recording).attitude_at(frame.exposure_time_ns).valid);
  }
  EXPECT_FALSE(recording.has_next());
}

TEST(RecordingTest, RefusesInvalidFiles) {
  const auto good = recorded(1);
  const auto status_of = [](const std::vector<std::uint8_t>& bytes) {
    return Recording().open(bytes.data(), bytes.size());
  };
  EXPECT_EQ(status_of(std::vector<std::uint8_t>(good.begin(), good.begin() + 15)),
            RecordingStatus::kTooShort);
  auto bad = good;
  bad[0] = 'X';
  EXPECT_EQ(status_of(bad), RecordingStatus::kBadMagic);
  bad = good;
  bad[4] = 3;
  EXPECT_EQ(status_of(bad), RecordingStatus::kBadVersion);
  bad = good;
  bad[40] ^= 1;
  EXPECT_EQ(status_of(bad), RecordingStatus::kBadCrc);
  for (const int rays : {0, 129}) {
    bad = good;
    bad[6] = static_cast<std::uint8_t>(rays);
    renew_crc(bad);
    EXPECT_EQ(status_of(bad), RecordingStatus::kBadRays);
  }
}

TEST(RecordingTest, EndsBeforeAnIncompleteOrInvalidFrame) {
  auto bytes = recorded(2);
  bytes[8] = 3;  // one more than there are
  renew_crc(bytes);
  Recording recording;
  ASSERT_EQ(recording.open(bytes.data(), bytes.size()), RecordingStatus::kOk);
  gnc::RangeImage frame;
  recording.read_next(frame);
  recording.read_next(frame);
  EXPECT_FALSE(recording.has_next());
  EXPECT_FALSE(recording.was_read());

  bytes = recorded(1);
  bytes[kRecordingHeaderSize + 16 + 25 + 1] = 200;  // the first row's number of ranges
  renew_crc(bytes);
  ASSERT_EQ(recording.open(bytes.data(), bytes.size()), RecordingStatus::kOk);
  EXPECT_FALSE(recording.has_next());
  EXPECT_FALSE(recording.was_read());
}

TEST(ReplayLidarTest, DeliversAFrameAtItsExposureTime) {
  const auto bytes = recorded(2);
  Recording recording;
  ASSERT_EQ(recording.open(bytes.data(), bytes.size()), RecordingStatus::kOk);
  ReplayLidar lidar(recording);
  gnc::RangeImage frame;
  EXPECT_EQ(lidar.receive(frame), LidarStatus::kFrame);
  EXPECT_EQ(lidar.receive(frame), LidarStatus::kNoFrame);
  lidar.advance_to(2'700'000'000);
  EXPECT_EQ(lidar.receive(frame), LidarStatus::kFrame);
  EXPECT_EQ(frame.sequence_number, 1U);
  EXPECT_EQ(lidar.receive(frame), LidarStatus::kNoFrame);
}

}  // namespace
}  // namespace tumblesight::hal::replay
