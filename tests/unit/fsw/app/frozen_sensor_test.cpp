// A sensor that freezes, with the flight network of NEAR Shoemaker and the audit's recording.
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>

#include "hal/replay/recording.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

const std::vector<std::uint8_t>& contents(const char* path) {
  static std::map<std::string, std::vector<std::uint8_t>> kept;
  std::vector<std::uint8_t>& bytes = kept[path];
  if (!bytes.empty()) return bytes;
  std::ifstream file(std::string(TUMBLESIGHT_SOURCE_DIR "/") + path, std::ios::binary);
  bytes.assign(std::istreambuf_iterator<char>(file), {});
  return bytes;
}

class FrozenSensor : public AppFixture {
 protected:
  static constexpr std::size_t kGood = 10;  // one sequence of the recording

  FrozenSensor() {
    checks_attitudes = true;
    const std::vector<std::uint8_t>& bytes = contents("tests/audit/near_shoemaker.tslr");
    hal::replay::Recording recording;
    EXPECT_EQ(recording.open(bytes.data(), bytes.size()), hal::replay::RecordingStatus::kOk);
    while (recording.has_next()) recording.read_next(frames.emplace_back());
    store.fill(contents("fsw/models/near_shoemaker.tsm"));
    init(store, nullptr);
    EXPECT_EQ(app->mode(), Mode::kRun);
    for (std::size_t i = 0; i < kGood; ++i) take(frames[i]);
    EXPECT_EQ(validity(), Validity::kValid);
  }
  void take(gnc::RangeImage frame) {
    frame.sequence_number = ++sequence_number;
    frame.exposure_time_ns = next_time_ns();
    step_frame(frame);
  }
  // 30 frames that `freeze` makes from the last good ones: all are refused, and fault 8 stands.
  template <class Freeze>
  void expect_seen(const Freeze& freeze) {
    for (int i = 0; i < 30; ++i) {
      gnc::RangeImage frame = frames[kGood - 1];
      freeze(i, frame);
      take(frame);
      EXPECT_EQ(validity(), Validity::kFrameRefused) << i;
      EXPECT_EQ(events(EventId::kFrameRepeated) > 0 || i >= initial(Parameter::kEventsOfAKind), true) << i;
      EXPECT_EQ((out->telemetry.faults_persisting & bit_of(Fault::kFrameFrozen)) != 0, i >= 2) << i;
    }
    EXPECT_EQ(out->telemetry.frames_repeated, 30U);
  }

  std::vector<gnc::RangeImage> frames;
};

// Verifies TS-FDIR-170.
TEST_F(FrozenSensor, OneRangeThatTogglesDoesNotHideIt) {
  expect_seen([](int i, gnc::RangeImage& frame) {
    for (std::uint16_t& range : frame.ranges) {
      if (range == 0) continue;
      range ^= static_cast<std::uint16_t>(i % 2);
      break;
    }
  });
}

// Verifies TS-FDIR-170.
TEST_F(FrozenSensor, ATenthOfTheRangesThatFlickersDoesNotHideIt) {
  std::mt19937 engine(1);
  for (const bool drops : {false, true}) {
    if (drops) init(store, nullptr);
    for (std::size_t i = 0; drops && i < kGood; ++i) take(frames[kGood + i]);
    for (int i = 0; i < 30; ++i) {
      gnc::RangeImage frame = frames[(drops ? 2 : 1) * kGood - 1];
      for (std::uint16_t& range : frame.ranges) {
        if (range == 0 || engine() % 10 != 0) continue;
        range = drops ? std::uint16_t{0} : static_cast<std::uint16_t>(range + 1 + engine() % 9);
      }
      take(frame);
      EXPECT_EQ(validity(), Validity::kFrameRefused) << drops << ' ' << i;
    }
    EXPECT_EQ(out->telemetry.frames_repeated, 30U);
    EXPECT_NE(out->telemetry.faults_persisting & bit_of(Fault::kFrameFrozen), 0U);
  }
}

// Verifies TS-FDIR-170.
TEST_F(FrozenSensor, TwoBuffersThatAlternateDoNotHideIt) {
  expect_seen([this](int i, gnc::RangeImage& frame) {
    frame.ranges = frames[kGood - 1 - std::size_t(i % 2)].ranges;
  });
}

// Verifies TS-FDIR-170.
TEST_F(FrozenSensor, UpToEightBuffersInTurnDoNotHideIt) {
  for (const std::size_t buffers : {3U, 4U, 8U}) {
    init(store, nullptr);
    for (std::size_t i = 0; i < kGood; ++i) take(frames[i]);
    expect_seen([this, buffers](int i, gnc::RangeImage& frame) {
      frame.ranges = frames[kGood - buffers + std::size_t(i) % buffers].ranges;
    });
  }
}

// Verifies TS-FDIR-170.
TEST_F(FrozenSensor, FramesOfAWorkingSensorDifferInNineTenthsOfTheCells) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t k = i + 1; k < frames.size(); ++k) {
      const gnc::FrameSignature a = gnc::signature_of(frames[i]), b = gnc::signature_of(frames[k]);
      int returns = 0, equal = 0;
      for (std::size_t cell = 0; cell < a.size(); ++cell) {
        returns += (a[cell] | b[cell]) != 0 ? 1 : 0;
        equal += a[cell] != 0 && a[cell] == b[cell] ? 1 : 0;
      }
      EXPECT_GE(returns, 100);
      EXPECT_LT(10 * equal, returns) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace tumblesight::fsw
