// The player of recordings for cFS, in a cFE of the tests: what it sends is what was recorded.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "hal/replay/recording.hpp"
#include "tests/support/stubs/cfe/cfe_stub.hpp"

extern "C" {
#include "tumblesight_app_msg.h"
#include "tumblesight_app_msgids.h"
#include "tumblesight_play_platform_cfg.h"
void TUMBLESIGHT_Player(void);
}

namespace tumblesight::cfe {
namespace {

constexpr double kPeriod_s = TUMBLESIGHT_PLAY_PERIOD_MS / 1000.0;
constexpr int kStarted = 1, kNoRecording = 2, kNotSent = 3;

Bytes recorded_file() {
  std::ifstream file(TUMBLESIGHT_SOURCE_DIR "/tests/audit/near_shoemaker.tslr", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class CfsPlayer : public ::testing::Test {
 protected:
  CfsPlayer() {
    restart_cfe();
    the.met_ns = 1'234'000'000;
    the.files[TUMBLESIGHT_PLAY_FILE] = recorded_file();
    the.most_bytes_per_read = 1 << 16;
  }
  void play(int periods) {
    the.periods = periods;
    TUMBLESIGHT_Player();
  }

  Cfe& the = the_cfe();
};

TEST_F(CfsPlayer, SendsTheRecordedFramesAndThenTheWakeUps) {
  const Bytes file = the.files[TUMBLESIGHT_PLAY_FILE];
  hal::replay::Recording recording;
  ASSERT_EQ(recording.open(file.data(), file.size()), hal::replay::RecordingStatus::kOk);
  const auto frames = static_cast<int>(recording.frames());
  play(frames + 1);
  EXPECT_EQ(the.count_events(kStarted), 1);
  gnc::RangeImage image;
  std::size_t at = 0;
  for (int cycle = 1; cycle <= frames; ++cycle) {
    recording.read_next(image);
    const std::size_t rays = std::size_t{image.rays} * image.rays;
    for (std::size_t offset = 0; offset < rays; offset += TUMBLESIGHT_APP_SEGMENT_RAYS, ++at) {
      TUMBLESIGHT_APP_FrameSegment_t segment;
      ASSERT_EQ(the.sent[at].bytes.size(), sizeof segment);
      ASSERT_EQ(the.sent[at].message_id(), static_cast<std::uint32_t>(TUMBLESIGHT_APP_FRAME_MID));
      std::memcpy(static_cast<void*>(&segment), the.sent[at].bytes.data(), sizeof segment);
      const TUMBLESIGHT_APP_FrameSegment_Payload_t& payload = segment.Payload;
      EXPECT_EQ(payload.SequenceNumber, static_cast<std::uint32_t>(cycle));
      EXPECT_EQ(payload.Rays, image.rays);
      EXPECT_EQ(payload.Fov_urad, image.fov_urad);
      EXPECT_EQ(payload.Offset, offset);
      EXPECT_NEAR(payload.Exposure.Seconds + std::ldexp(payload.Exposure.Subseconds, -32), cycle * kPeriod_s,
                  0.0011);
      EXPECT_EQ(payload.Chaser.IsKnown != 0, recording.chaser_attitude().valid);
      ASSERT_EQ(payload.Count, std::min<std::size_t>(TUMBLESIGHT_APP_SEGMENT_RAYS, rays - offset));
      EXPECT_EQ(std::memcmp(payload.Ranges, image.ranges.data() + offset, payload.Count * 2U), 0);
    }
    EXPECT_EQ(the.sent[at++].message_id(), static_cast<std::uint32_t>(TUMBLESIGHT_APP_WAKEUP_MID));
  }
  // Then the first frame again, under the next number.
  TUMBLESIGHT_APP_FrameSegment_t segment;
  std::memcpy(static_cast<void*>(&segment), the.sent[at].bytes.data(), sizeof segment);
  EXPECT_EQ(segment.Payload.SequenceNumber, static_cast<std::uint32_t>(frames) + 1U);
}

// Version 2, with the attitude of the chaser.
TEST_F(CfsPlayer, SendsTheChasersAttitude) {
  gnc::RangeImage image;
  image.rays = 4;
  image.ranges[5] = 77;
  gnc::ChaserAttitude chaser;
  chaser.valid = true;
  chaser.q_inertial_lrf = {-1, 2, -3, 1 << 30};
  Bytes file(hal::replay::kRecordingHeaderSize + hal::replay::kRecordedFrameSize);
  std::size_t size = hal::replay::write_recording_header(image.rays, 1, file.data());
  size += hal::replay::write_recorded_frame(image, chaser, file.data() + size);
  size += hal::replay::write_recording_crc(file.data(), size, file.data() + size);
  file.resize(size);
  the.files[TUMBLESIGHT_PLAY_FILE] = file;
  play(1);
  ASSERT_EQ(the.sent.size(), 2U);
  TUMBLESIGHT_APP_FrameSegment_t segment;
  std::memcpy(static_cast<void*>(&segment), the.sent[0].bytes.data(), sizeof segment);
  EXPECT_EQ(segment.Payload.Chaser.IsKnown, 1U);
  EXPECT_EQ(segment.Payload.Chaser.Q_Inertial_Lrf[0], -1);
  EXPECT_EQ(segment.Payload.Chaser.Q_Inertial_Lrf[3], 1 << 30);
  EXPECT_EQ(segment.Payload.Chaser.Time.Seconds, segment.Payload.Exposure.Seconds);
  EXPECT_EQ(segment.Payload.Ranges[5], 77);
  EXPECT_EQ(segment.Payload.Count, 16);
}

TEST_F(CfsPlayer, KeepsItsPeriod) {
  play(4);
  std::int64_t time_ms = 1234;
  for (int k = 1; k <= 4; ++k) {
    time_ms += the.delays_ms[static_cast<std::size_t>(k - 1)];
    EXPECT_NEAR(static_cast<double>(time_ms), k * TUMBLESIGHT_PLAY_PERIOD_MS, 1.0) << "errors do not add up";
  }
}

TEST_F(CfsPlayer, LeavesOutPeriodsThatItMissed) {
  the.late_ns = {3'500'000'000, 9'000'000'000, -1'000'000};
  play(5);
  // 2.7 s; at once, since it is 6.2 s; 8.1 s; 18.9 s, since it is 17.1 s; 21.6 s.
  EXPECT_EQ(the.delays_ms, (std::vector<std::uint32_t>{1467, 1900, 1799, 2702}));
}

TEST_F(CfsPlayer, GoesOnWhenTheClockIsSetBack) {
  the.met_ns = 1'000'000'000'000;
  the.late_ns = {-999'000'000'000};
  play(3);
  EXPECT_LE(the.delays_ms[1], static_cast<std::uint32_t>(TUMBLESIGHT_PLAY_PERIOD_MS));
}

TEST_F(CfsPlayer, WithoutARecordingItEndsAndNamesTheFile) {
  Bytes other = recorded_file(), old = recorded_file(), wide = recorded_file();
  other[0] = 'X';
  old[4] = 3;
  wide[6] = 129;
  for (const Bytes& content : {Bytes{}, Bytes(15), other, old, wide}) {
    restart_cfe();
    the.files[TUMBLESIGHT_PLAY_FILE] = content;
    play(2);
    EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR)) << content.size();
    EXPECT_NE(the.text_of(kNoRecording).find(TUMBLESIGHT_PLAY_FILE), std::string::npos);
    EXPECT_EQ(the.files_open, 0);
  }
  restart_cfe();
  play(2);
  EXPECT_EQ(the.count_events(kNoRecording), 1) << "there is no file";
  restart_cfe();
  the.files[TUMBLESIGHT_PLAY_FILE] = recorded_file();
  the.failing["OS_read"] = OS_ERROR;
  play(2);
  EXPECT_EQ(the.count_events(kNoRecording), 1);
  EXPECT_EQ(the.files_open, 0);
  restart_cfe();
  the.failing["CFE_EVS_Register"] = CFE_EVS_UNKNOWN_FILTER;
  play(2);
  EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR));
}

// Cut at every place, the recording is played as far as whole frames reach.
TEST_F(CfsPlayer, DamagedRecordingsSendNoPartOfAFrame) {
  const Bytes whole = recorded_file();
  for (std::size_t size = 0; size < whole.size(); size += 997) {
    restart_cfe();
    the.most_bytes_per_read = 1 << 20;
    the.files[TUMBLESIGHT_PLAY_FILE] =
        Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    play(3);
    int segments = 0;
    for (const SentMessage& sent : the.sent)
      segments += sent.message_id() == static_cast<std::uint32_t>(TUMBLESIGHT_APP_FRAME_MID) ? 1 : 0;
    EXPECT_EQ(segments % 5, 0) << size << ": a frame of 100 x 100 rays has five";
  }
  // A row that is longer than the frame, and one that starts beyond it (the frame's header has 16 bytes).
  for (const std::uint8_t damage : {std::uint8_t{200}, std::uint8_t{255}}) {
    restart_cfe();
    the.most_bytes_per_read = 1 << 20;
    Bytes damaged = whole;
    damaged[12 + 16] = damage;
    damaged[12 + 17] = 1;
    the.files[TUMBLESIGHT_PLAY_FILE] = damaged;
    play(1);
    EXPECT_EQ(the.sent.size(), 1U) << "the wake-up alone";
  }
}

TEST_F(CfsPlayer, MessagesThatAreNotSentAreReported) {
  the.failing["CFE_SB_TransmitMsg"] = CFE_SB_BUF_ALOC_ERR;
  play(1);
  EXPECT_GT(the.count_events(kNotSent), 1);
}

}  // namespace
}  // namespace tumblesight::cfe
