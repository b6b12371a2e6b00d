// The cFS app in a cFE of the tests: what it takes and sends, and what it does when a call of cFE fails.
// Verifies TS-IFC-130.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fsw/app/parameter_table.hpp"
#include "gnc/lidar/range_image.hpp"
#include "hal/messages/event_id.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"
#include "tests/support/golden_replay.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/read_packet.hpp"
#include "tests/support/stubs/cfe/cfe_stub.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

extern "C" {
#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"
#include "tumblesight_app_msgids.h"
#include "tumblesight_app_perfids.h"
#include "tumblesight_app_platform.h"
extern struct tumblesight_parameters TUMBLESIGHT_Parameters;
}

namespace tumblesight::fsw {
namespace {

using cfe::Bytes;
using cfe::make_message;
using cfe::message_of;

Bytes read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class CfsApp : public ::testing::Test {
 protected:
  CfsApp() {
    cfe::restart_cfe();
    the.met_ns = kStart_ns;
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    const auto* const table = reinterpret_cast<const std::uint8_t*>(&TUMBLESIGHT_Parameters);
    the.table_file.assign(table, table + sizeof TUMBLESIGHT_Parameters);
  }
  static void run() { TUMBLESIGHT_Main(); }
  void restart_processor(int type, std::uint32_t subtype) {
    the.reset_type = type;
    the.reset_subtype = subtype;
    the.stored_names.clear();
    the.events.clear();
    the.sent.clear();
  }
  void wake_up(const std::function<void()>& before = {}) {
    the.deliver(make_message(TUMBLESIGHT_APP_WAKEUP_MID, 8), [this, before] {
      the.met_ns += TUMBLESIGHT_PERIOD_NS;
      if (before) before();
    });
  }
  void command(const Bytes& packet) { the.deliver(packet); }
  void set_mode(hal::Mode mode) {
    command(
        packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kSetMode), {static_cast<std::uint8_t>(mode)}));
  }
  void request_hk() { the.deliver(make_message(TUMBLESIGHT_APP_SEND_HK_MID, 8)); }

  static TUMBLESIGHT_APP_FrameSegment_t segment_of(const gnc::RangeImage& image, std::size_t offset,
                                                   const gnc::ChaserAttitude& chaser = {}) {
    TUMBLESIGHT_APP_FrameSegment_t segment{};
    TUMBLESIGHT_APP_FrameSegment_Payload_t& payload = segment.Payload;
    const std::size_t rays = std::size_t{image.rays} * image.rays;
    payload.Exposure = cfe::to_cfe_time(image.exposure_time_ns);
    payload.SequenceNumber = image.sequence_number;
    payload.Fov_urad = image.fov_urad;
    payload.Rays = image.rays;
    payload.Offset = static_cast<std::uint16_t>(offset);
    payload.Count =
        static_cast<std::uint16_t>(std::min<std::size_t>(TUMBLESIGHT_APP_SEGMENT_RAYS, rays - offset));
    payload.Chaser.IsKnown = chaser.valid ? 1 : 0;
    payload.Chaser.Time = cfe::to_cfe_time(chaser.time_ns);
    std::copy(chaser.q_inertial_lrf.begin(), chaser.q_inertial_lrf.end(), payload.Chaser.Q_Inertial_Lrf);
    std::copy_n(image.ranges.begin() + static_cast<std::ptrdiff_t>(offset), payload.Count, payload.Ranges);
    return segment;
  }
  static std::vector<TUMBLESIGHT_APP_FrameSegment_t> segments_of(const gnc::RangeImage& image,
                                                                 const gnc::ChaserAttitude& chaser = {}) {
    std::vector<TUMBLESIGHT_APP_FrameSegment_t> segments;
    const std::size_t rays = std::size_t{image.rays} * image.rays;
    for (std::size_t offset = 0; offset < rays; offset += TUMBLESIGHT_APP_SEGMENT_RAYS)
      segments.push_back(segment_of(image, offset, chaser));
    return segments;
  }
  void send(const TUMBLESIGHT_APP_FrameSegment_t& segment) {
    const std::size_t unused = (TUMBLESIGHT_APP_SEGMENT_RAYS - segment.Payload.Count) * 2U;
    the.deliver(message_of(TUMBLESIGHT_APP_FRAME_MID, segment, sizeof segment - unused));
  }
  void send(const gnc::RangeImage& image) {
    for (const auto& segment : segments_of(image)) send(segment);
  }
  // The frame of the cycle that is `cycles` after the script's first one.
  static gnc::RangeImage frame(std::uint32_t number, int cycles = 1) {
    gnc::RangeImage image = good_frame(number, kStart_ns + cycles * TUMBLESIGHT_PERIOD_NS, number);
    const auto small = image.ranges;
    image.rays = kRays;
    image.ranges.fill(0);
    for (std::size_t row = 0; row < kRays; ++row)
      for (std::size_t column = 0; column < kRays; ++column)
        image.ranges[row * kRays + column] = small[row / 3 * 32 + column / 3];
    return image;
  }
  static constexpr std::uint16_t kRays = 96;  // five segments, the last one half full

  std::vector<Bytes> packets(std::uint32_t message_id) const {
    std::vector<Bytes> found;
    for (const cfe::SentMessage& sent : the.sent)
      if (sent.message_id() == message_id) found.push_back(sent.bytes);
    return found;
  }
  hal::Telemetry telemetry() const {
    const Bytes packet = packets(TUMBLESIGHT_APP_TLM_MID).back();
    return test::read_packet<hal::Telemetry>(packet.data(), packet.size());
  }
  hal::AttitudeReport attitude() const {
    const Bytes packet = packets(TUMBLESIGHT_APP_ATTITUDE_MID).back();
    return test::read_packet<hal::AttitudeReport>(packet.data(), packet.size());
  }
  static const TUMBLESIGHT_APP_HkTlm_Payload_t& counters() { return TUMBLESIGHT_APP_COUNTERS; }

  cfe::Cfe& the = cfe::the_cfe();
};

// --- start-up ---

TEST_F(CfsApp, StartsAndSaysSo) {
  wake_up();
  run();
  EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_RUN));
  EXPECT_EQ(the.text_of(TUMBLESIGHT_APP_INIT_INF_EID), std::string("TUMBLESIGHT: started, version ") +
                                                           tumblesight_version() +
                                                           ", cause of the reset: power-on");
  EXPECT_EQ(the.count_events(static_cast<int>(hal::EventId::kModelActivated)), 1);
  EXPECT_EQ(telemetry().mode, hal::Mode::kRun);
  EXPECT_EQ(the.files_open, 0);
  EXPECT_EQ(the.addresses_held, 0);
  EXPECT_EQ(the.buffers_in_use, 0);
  for (const cfe::SentEvent& event : the.events) EXPECT_LT(event.text.size(), 122U) << event.text;
}

TEST_F(CfsApp, WithoutEventServicesItEnds) {
  wake_up();
  the.failing["CFE_EVS_Register"] = CFE_EVS_UNKNOWN_FILTER;
  run();
  EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR));
  ASSERT_EQ(the.system_log.size(), 1U);
  EXPECT_NE(the.system_log[0].find("no event services"), std::string::npos);
}

TEST_F(CfsApp, WithoutAPipeOrASubscriptionItEnds) {
  for (const char* call :
       {"CFE_SB_CreatePipe", "CFE_SB_SubscribeEx:0x19F0", "CFE_SB_SubscribeEx:0x19F1",
        "CFE_SB_SubscribeEx:0x19F2", "CFE_SB_SubscribeEx:0x09F8", "CFE_SB_SubscribeEx:0x09F9"}) {
    cfe::restart_cfe();
    wake_up();
    the.failing[call] = CFE_SB_MAX_MSGS_MET;
    run();
    EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR)) << call;
    EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_PIPE_ERR_EID), 1) << call;
    EXPECT_EQ(the.sent.size(), 0U);
  }
}

TEST_F(CfsApp, PipeHoldsWhatItsSubscriptionsAllow) {
  run();
  int sum = 0;
  for (const auto& [id, limit] : the.message_limits) sum += limit;
  EXPECT_GE(the.message_limits[TUMBLESIGHT_APP_CMD_MID], TUMBLESIGHT_COMMAND_PLACES)
      << "more than an upload of eight segments per cycle";
  EXPECT_EQ(the.message_limits.size(), 5U);
  EXPECT_LE(sum, the.pipe_depth);
  EXPECT_GE(the.message_limits[TUMBLESIGHT_APP_FRAME_MID], 16) << "two frames of 128 x 128 rays";
  EXPECT_EQ(the.message_limits[TUMBLESIGHT_APP_WAKEUP_MID], 1) << "late cycles are not caught up";
}

TEST_F(CfsApp, PipeThatCannotBeReadEndsIt) {
  wake_up();
  the.failing["CFE_SB_ReceiveBuffer"] = CFE_SB_PIPE_RD_ERR;
  run();
  EXPECT_EQ(the.exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR));
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_RECEIVE_ERR_EID), 1);
}

TEST_F(CfsApp, WithoutAModelFileItIsSafeAndNamesTheFile) {
  the.files.clear();
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kSafe);
  EXPECT_NE(the.text_of(TUMBLESIGHT_APP_MODEL_FILE_ERR_EID).find(TUMBLESIGHT_APP_MODEL_FILE_0),
            std::string::npos);
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_NO_MODEL_ERR_EID), 1);
}

TEST_F(CfsApp, ModelFilesThatAreNoneAreRefused) {
  for (const Bytes& content : {Bytes{}, Bytes(100), Bytes(TUMBLESIGHT_APP_MODEL_BYTES + 10)}) {
    cfe::restart_cfe();
    the.most_bytes_per_read = 1 << 20;
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = content;
    wake_up();
    run();
    EXPECT_EQ(telemetry().mode, hal::Mode::kSafe) << content.size();
    EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_MODEL_FILE_ERR_EID), content.empty() ? 1 : 0);
    EXPECT_EQ(the.files_open, 0);
  }
  cfe::restart_cfe();
  the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
  the.failing["OS_read"] = OS_ERROR;
  wake_up();
  run();
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_MODEL_FILE_ERR_EID), 1);
  EXPECT_EQ(the.files_open, 0);
}

// An image for the empty bank: begun, loaded, and its size and CRC are right.
TEST_F(CfsApp, SecondBankTakesAnImageFromTheGround) {
  set_mode(hal::Mode::kStandby);
  wake_up();
  command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelBegin), {0}));
  std::vector<std::uint8_t> load{0, 0, 0, 0};
  load.insert(load.end(), test_model_image().begin(), test_model_image().begin() + 1024);
  command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelLoad), load));
  wake_up();
  run();
  EXPECT_EQ(telemetry().commands_accepted, 3U);
  EXPECT_EQ(telemetry().bank_status[1], hal::BankStatus::kLoading);
}

// OSAL cuts longer names of entry points, apps and files off, and then does not find them.
TEST_F(CfsApp, NamesFitIntoCfe) {
  constexpr std::size_t kMostCharacters = 19;
  std::ifstream document(TUMBLESIGHT_SOURCE_DIR "/docs/cfs.md");
  int lines = 0;
  for (std::string line; std::getline(document, line);) {
    if (line.find("CFE_APP, ") == std::string::npos) continue;
    ++lines;
    std::istringstream fields(line.substr(line.find("CFE_APP, ")));
    std::vector<std::string> names;
    for (std::string field; std::getline(fields, field, ',');)
      names.push_back(field.substr(field.find_first_not_of(' ')));
    ASSERT_EQ(names.size(), 8U) << line;
    for (int i = 1; i <= 3; ++i)
      EXPECT_LE(names[static_cast<std::size_t>(i)].size(), kMostCharacters) << line;
    const std::string folder = TUMBLESIGHT_SOURCE_DIR "/fsw/programs/cfs/" + names[1];
    const Bytes app =
        read_file(folder + "/fsw/src/" + (names[1] == "tumblesight" ? "tumblesight_app.c" : names[1] + ".c"));
    EXPECT_NE(std::string(app.begin(), app.end()).find("void " + names[2] + "(void)"), std::string::npos)
        << line;
  }
  EXPECT_EQ(lines, 2);
  const Bytes table =
      read_file(TUMBLESIGHT_SOURCE_DIR "/fsw/programs/cfs/tumblesight/fsw/tables/tumblesight_tbl.c");
  EXPECT_NE(std::string(table.begin(), table.end()).find("TUMBLESIGHT.Parameters"), std::string::npos);
}

// --- frames ---

TEST_F(CfsApp, AFrameInSegmentsGivesAnAttitude) {
  send(frame(7));
  wake_up();
  run();
  EXPECT_EQ(attitude().sequence_number, 7U);
  EXPECT_EQ(attitude().exposure_time_ns, kStart_ns + TUMBLESIGHT_PERIOD_NS);
  EXPECT_EQ(telemetry().frames_used, 1U);
  EXPECT_EQ(counters().SegmentsTaken, segments_of(frame(7)).size());
  EXPECT_EQ(counters().FramesAssembled, 1U);
}

TEST_F(CfsApp, MeasuresItsCyclesWithTheClockOfThePsp) {
  wake_up();
  wake_up();
  run();
  EXPECT_GT(telemetry().cycle_us, 0U) << "of the first one";
}

TEST_F(CfsApp, SegmentsComeInAnyOrderMixedAndTwice) {
  const gnc::RangeImage first = frame(1), second = frame(2, 2);
  auto a = segments_of(first), b = segments_of(second);
  for (std::size_t i = a.size(); i > 0; --i) {
    send(a[i - 1]);
    send(b[(i + 2) % b.size()]);
    send(a[i - 1]);  // again, the last time when the frame is complete
  }
  wake_up([this] { the.met_ns += TUMBLESIGHT_PERIOD_NS; });
  run();
  EXPECT_EQ(attitude().sequence_number, 2U);
  EXPECT_EQ(telemetry().frames_superseded, 1U);
  EXPECT_EQ(counters().FramesAssembled, 2U);
  EXPECT_EQ(counters().SegmentsRepeated, a.size());
  EXPECT_EQ(counters().FramesIncomplete, 0U);
}

// They begin no new frame, so that no frame is missed or reported in their place.
TEST_F(CfsApp, RepeatedSegmentsOfACompleteFrameAreNoFrame) {
  constexpr int kFrames = 6;
  for (int i = 1; i <= kFrames; ++i) {
    const unsigned number =
        i < 4 ? static_cast<unsigned>(i) : static_cast<unsigned>(i) + 1U;  // number 4 is missing
    const gnc::RangeImage image = frame(number, i);
    send(image);
    send(segment_of(image, 2048));
    send(segment_of(image, 0));
    wake_up();
    send(segment_of(image, 4096));
  }
  run();
  EXPECT_EQ(telemetry().frames_used, static_cast<std::uint32_t>(kFrames));
  EXPECT_EQ(telemetry().frames_overflowed, 0U);
  EXPECT_EQ(telemetry().sequence_gaps, 1U) << "the one that there is";
  EXPECT_EQ(counters().FramesIncomplete, 0U);
  EXPECT_EQ(counters().SegmentsRepeated, 3U * kFrames);
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_FRAME_ERR_EID), 0);
}

TEST_F(CfsApp, PartsOfFramesDoNotTakeThePlaceOfAWholeOne) {
  send(frame(1));
  for (unsigned number = 2; number < 9; ++number) send(segments_of(frame(number))[0]);
  wake_up();
  run();
  EXPECT_EQ(attitude().sequence_number, 1U);
  EXPECT_EQ(telemetry().frames_used, 1U);
  EXPECT_EQ(counters().FramesIncomplete, 7U - (TUMBLESIGHT_APP_FRAME_BUFFERS - 1U));
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_FRAME_ERR_EID), static_cast<int>(counters().FramesIncomplete));
  EXPECT_EQ(the.text_of(TUMBLESIGHT_APP_FRAME_ERR_EID),
            "TUMBLESIGHT: frame 6 dropped without its segments 0x1e: no buffer is free");
}

TEST_F(CfsApp, AFrameThatIsSentTwiceIsADuplicate) {
  send(frame(1));
  wake_up();
  send(frame(1));
  wake_up();
  run();
  EXPECT_EQ(telemetry().frames_duplicate, 1U);
}

TEST_F(CfsApp, AFrameMayArriveAcrossTwoCyclesButNotThree) {
  const auto segments = segments_of(frame(1));
  for (std::size_t i = 0; i < segments.size(); ++i) {
    send(segments[i]);
    if (i == 0) wake_up();
  }
  wake_up();
  run();
  EXPECT_EQ(telemetry().frames_used, 1U) << "its age is one period";

  cfe::restart_cfe();
  the.met_ns = kStart_ns;
  the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
  send(segments[0]);
  for (int i = 0; i < 2; ++i) wake_up();
  for (std::size_t i = 1; i < segments.size(); ++i) send(segments[i]);
  wake_up();
  run();
  EXPECT_EQ(telemetry().frames_used, 0U);
  EXPECT_EQ(counters().FramesIncomplete, 1U);
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_FRAME_ERR_EID), 1);
  EXPECT_NE(the.text_of(TUMBLESIGHT_APP_FRAME_ERR_EID).find("frame 1 dropped"), std::string::npos);
  EXPECT_EQ(telemetry().frames_overflowed, 1U) << "the flight application knows of it";
}

TEST_F(CfsApp, WithoutAFreeBufferTheOldestFrameGoes) {
  constexpr int kBuffers = TUMBLESIGHT_APP_FRAME_BUFFERS;
  for (int i = 0; i < kBuffers; ++i) send(segments_of(frame(100U + static_cast<unsigned>(i)))[0]);
  // Each takes the place of a frame that is not complete, and the last one that of the first.
  for (int i = 0; i <= kBuffers; ++i) {
    gnc::RangeImage image = frame(200U + static_cast<unsigned>(i));
    image.exposure_time_ns -= (kBuffers - i) * 100'000'000;
    send(image);
  }
  wake_up();
  run();
  EXPECT_EQ(counters().FramesIncomplete, static_cast<std::uint32_t>(kBuffers));
  EXPECT_EQ(counters().FramesSuperseded, 1U);
  EXPECT_EQ(attitude().sequence_number, 200U + kBuffers);
  EXPECT_EQ(telemetry().frames_overflowed, static_cast<std::uint32_t>(kBuffers) + 1U);
}

TEST_F(CfsApp, SegmentsWithImpossibleFieldsAreRefusedAndNamed) {
  const gnc::RangeImage image = frame(1);
  const TUMBLESIGHT_APP_FrameSegment_t good = segment_of(image, 0);
  using Payload = TUMBLESIGHT_APP_FrameSegment_Payload_t;
  const std::vector<void (*)(Payload&)> damages{
      [](Payload& p) { p.Rays = 0; },
      [](Payload& p) { p.Rays = 129; },
      [](Payload& p) { p.Rays = 65535; },
      [](Payload& p) { p.Offset = 1; },
      [](Payload& p) {
        p.Offset = static_cast<std::uint16_t>(p.Rays * p.Rays + 2048 - p.Rays * p.Rays % 2048);
      },
      [](Payload& p) { p.Offset = 63488; },
      [](Payload& p) { p.Count = static_cast<std::uint16_t>(p.Count - 1); },
      [](Payload& p) { p.Count = 0; },
  };
  for (const auto damage : damages) {
    TUMBLESIGHT_APP_FrameSegment_t segment = good;
    damage(segment.Payload);
    the.deliver(message_of(TUMBLESIGHT_APP_FRAME_MID, segment));
  }
  wake_up();
  run();
  EXPECT_EQ(counters().SegmentsRefused, damages.size());
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_SEGMENT_ERR_EID), static_cast<int>(damages.size()));
  EXPECT_NE(the.text_of(TUMBLESIGHT_APP_SEGMENT_ERR_EID).find("frame 1, "), std::string::npos);
  EXPECT_EQ(counters().SegmentsTaken, 0U);
  EXPECT_EQ(telemetry().frames_missing, 1U);
}

// A segment that says something else than the first one of its frame.
TEST_F(CfsApp, SegmentsOfAFrameMustAgree) {
  gnc::RangeImage image = frame(1);
  const auto segments = segments_of(image);
  ASSERT_GE(segments.size(), 2U);
  using Payload = TUMBLESIGHT_APP_FrameSegment_Payload_t;
  const std::vector<void (*)(Payload&)> damages{
      [](Payload& p) { p.Fov_urad += 1; },
      [](Payload& p) { p.Rays = 64; },
      [](Payload& p) { p.Chaser.IsKnown = 1; },
      [](Payload& p) { p.Chaser.Time.Seconds += 1; },
      [](Payload& p) { p.Chaser.Time.Subseconds += 1; },
      [](Payload& p) { p.Chaser.Q_Inertial_Lrf[3] += 1; },
  };
  send(segments[0]);
  for (const auto damage : damages) {
    TUMBLESIGHT_APP_FrameSegment_t segment = segments[1];
    damage(segment.Payload);
    if (segment.Payload.Rays == 64)
      segment.Payload.Count = static_cast<std::uint16_t>(
          std::min(TUMBLESIGHT_APP_SEGMENT_RAYS, 64 * 64 - static_cast<int>(segment.Payload.Offset)));
    the.deliver(message_of(TUMBLESIGHT_APP_FRAME_MID, segment));
  }
  for (std::size_t i = 1; i < segments.size(); ++i) send(segments[i]);
  wake_up();
  run();
  EXPECT_EQ(counters().SegmentsRefused, damages.size());
  EXPECT_EQ(telemetry().frames_used, 1U);
}

TEST_F(CfsApp, MessagesOfAWrongLengthAreRefused) {
  TUMBLESIGHT_APP_FrameSegment_t segment = segment_of(frame(1), 0);
  const std::size_t head = offsetof(TUMBLESIGHT_APP_FrameSegment_t, Payload.Ranges);
  the.deliver(make_message(TUMBLESIGHT_APP_FRAME_MID, head - 1));
  the.deliver(message_of(TUMBLESIGHT_APP_FRAME_MID, segment, head + segment.Payload.Count * 2U - 1U));
  Bytes longer = message_of(TUMBLESIGHT_APP_FRAME_MID, segment);
  longer = make_message(TUMBLESIGHT_APP_FRAME_MID, longer.size() + 1);
  the.deliver(longer);
  the.deliver(make_message(TUMBLESIGHT_APP_NAV_MID, sizeof(TUMBLESIGHT_APP_Navigation_t) - 1));
  the.deliver(make_message(TUMBLESIGHT_APP_WAKEUP_MID, 12));
  the.deliver(make_message(TUMBLESIGHT_APP_SEND_HK_MID, 7));
  the.deliver(make_message(0x0801, 12));
  run();
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_LENGTH_ERR_EID), 6);
  EXPECT_EQ(the.sent.size(), 0U);
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_MID_ERR_EID), 1);
  EXPECT_EQ(counters().MessagesRefused, 7U);
}

TEST_F(CfsApp, NavigationIsTheChasersAttitudeOfTheCycle) {
  TUMBLESIGHT_APP_Navigation_t navigation{};
  navigation.Attitude.IsKnown = 1;
  navigation.Attitude.Q_Inertial_Lrf[0] = 1 << 30;
  for (int cycle = 1; cycle <= 2; ++cycle) {
    gnc::RangeImage image = frame(static_cast<unsigned>(cycle), cycle);
    gnc::ChaserAttitude chaser;
    chaser.valid = true;
    chaser.time_ns = image.exposure_time_ns;
    for (const auto& segment : segments_of(image, chaser)) send(segment);
    navigation.Attitude.Time = cfe::to_cfe_time(kStart_ns + cycle * TUMBLESIGHT_PERIOD_NS);
    the.deliver(message_of(TUMBLESIGHT_APP_NAV_MID, navigation));
    wake_up();
  }
  run();
  EXPECT_EQ(telemetry().frames_used, 2U);
  EXPECT_EQ(telemetry().frames_without_chaser, 0U);
  EXPECT_TRUE(TUMBLESIGHT_APP_Data.Chaser.is_known);
}

// --- commands ---

TEST_F(CfsApp, CommandsAreCarriedOutInTheNextCycle) {
  set_mode(hal::Mode::kStandby);
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kStandby);
  EXPECT_EQ(the.text_of(static_cast<int>(hal::EventId::kCommandAccepted)),
            "TUMBLESIGHT: telecommand accepted [3, 2, 1]");
  EXPECT_EQ(counters().CommandsTaken, 1U);
}

TEST_F(CfsApp, CommandsWithoutAPlaceAreDroppedAndCounted) {
  for (int i = 0; i < 20; ++i) command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop)));
  wake_up([this] { EXPECT_EQ(counters().CommandsTaken, 15U); });
  wake_up([this] { EXPECT_EQ(telemetry().commands_accepted, 8U) << "in one cycle"; });
  run();
  EXPECT_EQ(telemetry().commands_accepted, 15U);
  EXPECT_EQ(counters().CommandsDropped, 5U);
  EXPECT_EQ(telemetry().commands_refused_by[static_cast<std::size_t>(hal::CommandRefusal::kNoRoom)], 5U);
}

// Whatever waits before it: segments of a model, NOOP, dumps, a command that is unknown, one that is damaged.
TEST_F(CfsApp, NothingKeepsSetModeSafeOut) {
  const std::vector<std::uint8_t> segment(4 + 1024);
  Bytes damaged = packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop));
  damaged[7] ^= 1;
  for (const Bytes& flood :
       {packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelLoad), segment),
        packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop)),
        packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kMemoryDump), {0, 0, 0, 0, 0, 0, 16}),
        packet_of(99), damaged}) {
    for (const int waiting : {8, 40}) {
      cfe::restart_cfe();
      the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
      for (int i = 0; i < waiting; ++i) command(flood);
      set_mode(hal::Mode::kSafe);
      wake_up();
      wake_up();
      run();
      EXPECT_EQ(telemetry().mode, hal::Mode::kSafe) << int{flood[6]} << ' ' << waiting;
    }
  }
}

// As many as may wait in the pipe arrive while each cycle runs.
TEST_F(CfsApp, SetModeSafeGetsThroughWhileAModelIsLoaded) {
  const std::vector<std::uint8_t> segment(4 + 1024);
  command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelBegin), {0}));
  constexpr int kCycles = 10;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (int i = 1; i < TUMBLESIGHT_APP_CMD_LIMIT; ++i)
      command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelLoad), segment));
    set_mode(cycle % 2 == 0 ? hal::Mode::kSafe : hal::Mode::kStandby);
    wake_up();
  }
  wake_up();
  run();
  const auto modes = packets(TUMBLESIGHT_APP_TLM_MID);
  int in_safe = 0;
  for (const Bytes& packet : modes)
    in_safe += test::read_packet<hal::Telemetry>(packet.data(), packet.size()).mode == hal::Mode::kSafe;
  EXPECT_EQ(in_safe, kCycles / 2) << "each of them in the same cycle or the next one";
}

TEST_F(CfsApp, RefusedCommandsAreEventsOfTheirOwn) {
  Bytes wrong = packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop));
  wrong[7] ^= 1;
  command(wrong);
  command(make_message(TUMBLESIGHT_APP_CMD_MID, 7));
  command(make_message(TUMBLESIGHT_APP_CMD_MID, 3000));
  wake_up();
  run();
  EXPECT_EQ(telemetry().commands_refused, 3U);
  const std::string text = the.text_of(static_cast<int>(hal::EventId::kCommandWrongChecksum));
  EXPECT_EQ(text, "TUMBLESIGHT: telecommand with a wrong checksum [1, 8, 0]");
}

// Also when so many commands were accepted that its event is suppressed.
TEST_F(CfsApp, ResetCountersResetsThoseOfTheAppToo) {
  wake_up();
  for (int i = 0; i < 8; ++i) command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop)));
  wake_up([] { EXPECT_EQ(counters().Cycles, 1U); });
  command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kResetCounters)));
  wake_up([] { EXPECT_EQ(counters().CommandsTaken, 9U); });
  run();
  EXPECT_EQ(counters().Cycles, 0U);
  EXPECT_EQ(counters().CommandsTaken, 0U);
}

TEST_F(CfsApp, SeveritiesAreTypesOfEvents) {
  the.files.clear();
  wake_up();
  command(make_message(TUMBLESIGHT_APP_CMD_MID, 7));
  wake_up();
  run();
  const auto type_of = [this](hal::EventId id) {
    const auto found = std::find_if(the.events.begin(), the.events.end(),
                                    [id](const cfe::SentEvent& e) { return e.id == static_cast<int>(id); });
    return found == the.events.end() ? -1 : found->type;
  };
  EXPECT_EQ(type_of(hal::EventId::kModelRefused), CFE_EVS_EventType_CRITICAL);
  EXPECT_EQ(type_of(hal::EventId::kCommandMalformed), CFE_EVS_EventType_ERROR);
}

// --- what is sent ---

TEST_F(CfsApp, PacketsGoToTheBusUnchanged) {
  command(packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kMemoryDump), {0, 0, 0, 0, 0, 0, 16}));
  wake_up();
  request_hk();
  run();
  for (const std::uint32_t id : {TUMBLESIGHT_APP_ATTITUDE_MID, TUMBLESIGHT_APP_TLM_MID,
                                 TUMBLESIGHT_APP_EVENT_MID, TUMBLESIGHT_APP_DUMP_MID})
    EXPECT_GE(packets(id).size(), 1U) << id;
  for (const cfe::SentMessage& sent : the.sent)
    EXPECT_EQ(sent.is_origination, sent.message_id() == TUMBLESIGHT_APP_HK_TLM_MID)
        << "the bus must not change sequence counts and checksums";
  ASSERT_EQ(packets(TUMBLESIGHT_APP_HK_TLM_MID).size(), 1U);
  TUMBLESIGHT_APP_HkTlm_t hk;
  ASSERT_EQ(packets(TUMBLESIGHT_APP_HK_TLM_MID)[0].size(), sizeof hk);
  std::memcpy(static_cast<void*>(&hk), packets(TUMBLESIGHT_APP_HK_TLM_MID)[0].data(), sizeof hk);
  EXPECT_EQ(hk.Payload.Cycles, 1U);
  EXPECT_EQ(hk.Payload.PacketsSent, the.sent.size() - 1);
}

TEST_F(CfsApp, PacketsThatTheBusDoesNotTakeAreCounted) {
  wake_up();
  wake_up([this] { the.has_buffers = false; });
  wake_up([this] {
    the.has_buffers = true;
    the.failing["CFE_SB_TransmitBuffer"] = CFE_SB_BUFFER_INVALID;
    the.failing["CFE_SB_TransmitMsg"] = CFE_SB_BUF_ALOC_ERR;
  });
  request_hk();
  run();
  EXPECT_EQ(the.buffers_in_use, 0) << "a buffer that was not sent is released";
  EXPECT_GE(counters().PacketsLost, 5U) << "attitude and telemetry twice, housekeeping once";
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_BUFFER_ERR_EID), static_cast<int>(counters().PacketsLost));
}

TEST_F(CfsApp, EveryEventThatOthersCanCauseIsFiltered) {
  run();
  std::vector<int> ids;
  for (const CFE_EVS_BinFilter_t& filter : the.filters) {
    ids.push_back(filter.EventID);
    EXPECT_EQ(filter.Mask, CFE_EVS_FIRST_16_STOP);
  }
  EXPECT_EQ(ids, (std::vector<int>{TUMBLESIGHT_APP_MID_ERR_EID, TUMBLESIGHT_APP_LENGTH_ERR_EID,
                                   TUMBLESIGHT_APP_SEGMENT_ERR_EID, TUMBLESIGHT_APP_FRAME_ERR_EID,
                                   TUMBLESIGHT_APP_BUFFER_ERR_EID}));
}

TEST_F(CfsApp, PerformanceMarkersArePaired) {
  wake_up();
  run();
  std::map<std::uint32_t, int> open;
  bool had_step = false;
  for (const std::uint32_t entry : the.perf_log) {
    const std::uint32_t marker = entry & 0x7FFFFFFFU;
    open[marker] += entry == marker ? 1 : -1;
    EXPECT_TRUE(open[marker] == 0 || open[marker] == 1);
    had_step = had_step || marker == TUMBLESIGHT_APP_STEP_PERF_ID;
  }
  for (const auto& [marker, count] : open) EXPECT_EQ(count, 0) << marker;
  EXPECT_TRUE(had_step);
}

// --- time ---

TEST_F(CfsApp, TimesAreExactToTheNanosecond) {
  for (const std::int64_t time_ns :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{999'999'999}, kStart_ns + 1,
        std::int64_t{4'294'967'295'999'999'999}, std::int64_t{2'700'000'123}})
    EXPECT_EQ(TUMBLESIGHT_APP_ToNanoseconds(cfe::to_cfe_time(time_ns)), time_ns);
  EXPECT_EQ(TUMBLESIGHT_APP_ToNanoseconds({7, 0xFFFFFFFFU}), 8'000'000'000);
}

TEST_F(CfsApp, MissedPeriodsAreSlips) {
  wake_up();
  wake_up([this] { the.met_ns += 2 * TUMBLESIGHT_PERIOD_NS + 100'000'000; });
  wake_up([this] { the.met_ns -= 200'000'000; });
  wake_up([this] { the.met_ns -= 3 * TUMBLESIGHT_PERIOD_NS; });  // the clock was set
  run();
  EXPECT_EQ(telemetry().cycle_slips, 2U);
  EXPECT_EQ(the.count_events(static_cast<int>(hal::EventId::kCycleTimeNotAdvancing)), 1);
}

// --- the critical data store and resets ---

TEST_F(CfsApp, StateSurvivesAReset) {
  set_mode(hal::Mode::kStandby);
  wake_up();
  run();
  EXPECT_EQ(the.calls["size of State0"], TUMBLESIGHT_STORED_BYTES);
  restart_processor(CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_RESET_COMMAND);
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kStandby);
  EXPECT_EQ(the.text_of(static_cast<int>(hal::EventId::kStateResumed)),
            "TUMBLESIGHT: state of before the reset resumed [3, 1, 0]");
  EXPECT_EQ(counters().StoreErrors, 0U);
}

// A reset between the registration and the first cycle leaves blocks that nothing was written to.
TEST_F(CfsApp, ResetBeforeTheFirstCycleLosesNothing) {
  run();
  restart_processor(CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_HW_SPECIAL_COMMAND);
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kStandby) << "not SAFE";
  EXPECT_EQ(telemetry().states_lost, 0U);
}

TEST_F(CfsApp, CausesOfResetsDecideTheMode) {
  const struct {
    int type;
    std::uint32_t subtype;
    bool is_operational;
    hal::Mode mode;
    int cause;
  } kCases[] = {
      {CFE_PSP_RST_TYPE_POWERON, CFE_PSP_RST_SUBTYPE_POWER_CYCLE, false, hal::Mode::kRun,
       TUMBLESIGHT_RESET_POWER_ON},
      {CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_RESET_COMMAND, false, hal::Mode::kStandby,
       TUMBLESIGHT_RESET_OTHER},
      {CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_HW_WATCHDOG, false, hal::Mode::kStandby,
       TUMBLESIGHT_RESET_WATCHDOG},
      {CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_POWER_CYCLE, false, hal::Mode::kStandby,
       TUMBLESIGHT_RESET_OTHER},
      // The app alone was started again: cFE still gives the cause of the processor's start.
      {CFE_PSP_RST_TYPE_POWERON, CFE_PSP_RST_SUBTYPE_POWER_CYCLE, true, hal::Mode::kStandby,
       TUMBLESIGHT_RESET_OTHER},
      {CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_RESET_COMMAND, true, hal::Mode::kStandby,
       TUMBLESIGHT_RESET_OTHER},
  };
  for (const auto& one : kCases) {
    cfe::restart_cfe();
    the.met_ns = kStart_ns;
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    wake_up();
    run();
    EXPECT_EQ(telemetry().mode, hal::Mode::kRun);
    restart_processor(one.type, one.subtype);
    the.is_operational = one.is_operational;
    wake_up();
    run();
    EXPECT_EQ(telemetry().mode, one.mode) << one.subtype;
    EXPECT_NE(the.text_of(static_cast<int>(hal::EventId::kStateResumed))
                  .find("[" + std::to_string(one.cause) + ","),
              std::string::npos);
  }
}

// An app that the ground starts later has no state that it could have lost. Without a store that is not
// known.
TEST_F(CfsApp, FirstStartInARunningSystemIsAFirstStart) {
  the.is_operational = true;
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kRun);
  cfe::restart_cfe();
  the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
  the.is_operational = true;
  the.failing["CFE_ES_RegisterCDS:State0"] = CFE_ES_CDS_INSUFFICIENT_MEMORY;
  wake_up();
  run();
  EXPECT_EQ(telemetry().mode, hal::Mode::kStandby);
}

TEST_F(CfsApp, WithoutCriticalDataStoreItWorksAndSaysSo) {
  for (const char* call : {"CFE_ES_RegisterCDS:State0", "CFE_ES_RegisterCDS:State1", "CFE_ES_CopyToCDS"}) {
    cfe::restart_cfe();
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    the.failing[call] = CFE_ES_CDS_INSUFFICIENT_MEMORY;
    wake_up();
    run();
    EXPECT_EQ(telemetry().mode, hal::Mode::kRun);
    EXPECT_EQ(telemetry().store_health, hal::StoreHealth::kNone);
    EXPECT_EQ(
        the.text_of(TUMBLESIGHT_APP_CDS_ERR_EID),
        "TUMBLESIGHT: no critical data store, RC = 0xC400000E: a reset will lose mode, bank and parameters");
    EXPECT_EQ(counters().StoreErrors, 1U);
  }
}

TEST_F(CfsApp, BlocksThatAreDamagedOrUnreadableLoseTheState) {
  for (const CFE_Status_t status : {CFE_ES_CDS_BLOCK_CRC_ERR, CFE_ES_CDS_ACCESS_ERROR}) {
    cfe::restart_cfe();
    the.met_ns = kStart_ns;
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    wake_up();
    run();
    restart_processor(CFE_PSP_RST_TYPE_PROCESSOR, CFE_PSP_RST_SUBTYPE_RESET_COMMAND);
    the.failing["CFE_ES_RestoreFromCDS"] = status;
    wake_up();
    run();
    EXPECT_EQ(telemetry().mode, hal::Mode::kSafe);
    EXPECT_GT(counters().StoreErrors, 0U);
  }
}

TEST_F(CfsApp, AStoreThatCannotBeWrittenIsReported) {
  wake_up();
  wake_up([this] { the.failing["CFE_ES_CopyToCDS"] = CFE_ES_CDS_ACCESS_ERROR; });
  set_mode(hal::Mode::kStandby);
  wake_up();
  run();
  EXPECT_GT(telemetry().state_writes_failed, 0U);
  EXPECT_GT(counters().StoreErrors, 0U);
}

// --- the table ---

TEST_F(CfsApp, DefaultTableHasTheInitialParameters) {
  tumblesight_parameters initial{};
  tumblesight_initial_parameters(&initial);
  EXPECT_EQ(std::memcmp(&initial, &TUMBLESIGHT_Parameters, sizeof initial), 0);
  wake_up();
  run();
  EXPECT_EQ(telemetry().table_crc32, crc32_of(kInitialTable));
  EXPECT_EQ(counters().TableUpdates, 1U);
}

TEST_F(CfsApp, ANewTableIsUsedFromTheNextCycleOn) {
  tumblesight_parameters parameters = TUMBLESIGHT_Parameters;
  parameters.scrub_blocks = 3;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&parameters);
  wake_up();
  wake_up([&] { EXPECT_EQ(the.load_table(Bytes(bytes, bytes + sizeof parameters)), CFE_SUCCESS); });
  run();
  ParameterTable expected = kInitialTable;
  expected[Parameter::kScrubBlocks] = 3;
  EXPECT_EQ(telemetry().table_crc32, crc32_of(expected));
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_TBL_INF_EID), 2);
  EXPECT_EQ(the.calls["CFE_TBL_Manage"], 2);
  EXPECT_EQ(the.addresses_held, 0);
}

TEST_F(CfsApp, TablesWithAFieldThatIsNotAllowedAreRefusedWithItsName) {
  wake_up();
  run();
  tumblesight_parameters parameters = TUMBLESIGHT_Parameters;
  const auto load = [&] {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&parameters);
    return the.load_table(Bytes(bytes, bytes + sizeof parameters));
  };
  parameters.scrub_blocks = 17;
  EXPECT_EQ(load(), CFE_STATUS_VALIDATION_FAILURE);
  EXPECT_EQ(the.text_of(TUMBLESIGHT_APP_TBL_VALUE_ERR_EID),
            "TUMBLESIGHT: table refused: ScrubBlocks is 17, not in 1 ... 16");
  parameters.scrub_blocks = 16;
  parameters.fault_rules[5].window_cycles = 33;
  EXPECT_EQ(load(), CFE_STATUS_VALIDATION_FAILURE);
  EXPECT_EQ(the.text_of(TUMBLESIGHT_APP_TBL_VALUE_ERR_EID),
            "TUMBLESIGHT: table refused: rule of fault 5 is 0x04210401");
}

// A bit of the table flips after cFE has validated it.
TEST_F(CfsApp, ATableThatChangesAfterItsValidationIsNotUsed) {
  wake_up();
  wake_up([this] {
    std::memset(the.table->data(), 0xFF, 4);
    the.table_is_new = true;
  });
  run();
  EXPECT_EQ(telemetry().table_crc32, crc32_of(kInitialTable));
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_TBL_VALUE_ERR_EID), 1);
  EXPECT_EQ(counters().TableUpdates, 1U);
}

TEST_F(CfsApp, WithoutTheTablesFileTheInitialParametersAreTheTable) {
  the.failing["CFE_TBL_Load:" TUMBLESIGHT_APP_TABLE_FILE] = CFE_TBL_ERR_ACCESS;
  wake_up();
  run();
  EXPECT_NE(the.text_of(TUMBLESIGHT_APP_TBL_ERR_EID).find(TUMBLESIGHT_APP_TABLE_FILE), std::string::npos);
  EXPECT_EQ(telemetry().table_crc32, crc32_of(kInitialTable));
  EXPECT_EQ(counters().TableUpdates, 1U) << "and the ground can dump and load it";
}

TEST_F(CfsApp, WithoutATableItKeepsItsParameters) {
  for (const char* call : {"CFE_TBL_Register", "CFE_TBL_Load:address", "CFE_TBL_GetAddress"}) {
    cfe::restart_cfe();
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    the.failing["CFE_TBL_Load:" TUMBLESIGHT_APP_TABLE_FILE] = CFE_TBL_ERR_ACCESS;
    the.failing[call] = CFE_TBL_ERR_INVALID_SIZE;
    wake_up();
    run();
    EXPECT_EQ(telemetry().table_crc32, crc32_of(kInitialTable));
    EXPECT_EQ(counters().TableUpdates, 0U);
    EXPECT_GE(the.count_events(TUMBLESIGHT_APP_TBL_ERR_EID), 1) << call;
    EXPECT_EQ(the.addresses_held, 0);
  }
}

// --- the whole ---

// The frames of flight_replay with the network that ships: all attitudes, events and states.
// Verifies TS-IFC-120.
TEST_F(CfsApp, RecordedFramesGiveTheGoldenDigest) {
  test::GoldenReplay replay;
  the.most_bytes_per_read = 1 << 20;
  the.failing["CFE_ES_RegisterCDS:State0"] = CFE_ES_CDS_INSUFFICIENT_MEMORY;  // flight_replay has no store
  the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = Bytes(replay.model(), replay.model() + replay.model_bytes());
  const auto end_cycle = [&] {
    for (const cfe::SentMessage& sent : the.sent) replay.take(sent.bytes.data(), sent.bytes.size());
    if (!the.sent.empty()) replay.end_cycle(tumblesight_state_crc32(TUMBLESIGHT_APP_Data.App));
    the.sent.clear();
  };
  gnc::RangeImage image;
  while (replay.recording.has_next()) {
    replay.recording.read_next(image);
    std::vector<TUMBLESIGHT_APP_FrameSegment_t> segments =
        segments_of(image, replay.recording.chaser_attitude());
    std::reverse(segments.begin(), segments.end());
    for (const auto& segment : segments) send(segment);
    TUMBLESIGHT_APP_Navigation_t navigation{};
    navigation.Attitude = segments[0].Payload.Chaser;
    the.deliver(message_of(TUMBLESIGHT_APP_NAV_MID, navigation));
    the.deliver(make_message(TUMBLESIGHT_APP_WAKEUP_MID, 8),
                [this, end_cycle, now_ns = image.exposure_time_ns] {
                  end_cycle();
                  the.met_ns = now_ns;
                });
  }
  run();
  end_cycle();
  EXPECT_EQ(replay.digest(), test::GoldenReplay::golden_digest());
}

}  // namespace
}  // namespace tumblesight::fsw
