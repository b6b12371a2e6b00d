#include "sim/recording/recording_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "sim/recording/make_recording.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/hostile_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

MadeRecording made(const RecordingSettings& settings) {
  static const FlashLidar lidar(make_near_shoemaker());
  return make_recording(FrameRenderer(lidar, 6.0), settings, [](std::uint32_t) {});
}

std::string refusal_of(const std::string& path) {
  try {
    (void)read_recording(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TruthTable table_of(const MadeRecording& recording) {
  return parse_truth(truth_csv(recording.truth), "a.csv");
}

// Verifies TS-SIL-130.
TEST(RecordingFile, HasTheTruthOfEachFrameBesideIt) {
  RecordingSettings settings;
  settings.sequences = 2;
  settings.scenario.frames = 4;
  settings.scenario.disturbances.lost_frames = 1;
  const MadeRecording recording = made(settings);
  const TemporaryFolder folder;
  const RecordingFile file = read_recording(folder.put("a.tslr", recording.bytes));
  ASSERT_EQ(file.frames.size(), 6U) << "a lost frame is in neither file";
  EXPECT_EQ(file.open().frames(), 6U);
  const auto truth = truth_by_frame(file, table_of(recording), "a.csv");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const FrameTruth expected = make_sequence(settings.scenario, 1, i / 3).frames[i % 3 == 2 ? 3 : i % 3];
    ASSERT_TRUE(truth[i].has_value());
    EXPECT_LT(truth[i]->q_lrf_trf.angularDistance(expected.q_lrf_trf), 1e-12);
    EXPECT_EQ(truth[i]->rate_lrf_rad_s, expected.rate_lrf_rad_s);
    EXPECT_EQ(truth[i]->trf_origin_lrf_m, Eigen::Vector3d(0.0, expected.range_m, 0.0));
  }
}

TEST(RecordingFile, MayHaveFramesWithoutTruthButNoTruthWithoutFrames) {
  const MadeRecording recording = made({});
  const TemporaryFolder folder;
  const RecordingFile file = read_recording(folder.put("a.tslr", recording.bytes));
  TruthTable table = table_of(recording);
  const RecordedTruth first = table.begin()->second;
  table.erase(table.begin());
  const auto truth = truth_by_frame(file, table, "a.csv");
  EXPECT_FALSE(truth[0].has_value());
  EXPECT_TRUE(truth[1].has_value());
  table[{77, 0}] = first;
  try {
    (void)truth_by_frame(file, table, "a.csv");
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("a.csv, line 2: the recording has no frame with sequence_number 77 and "
                        "exposure_time_ns 0; give"),
              std::string::npos)
        << error.what();
  }
}

// Verifies TS-SIL-130.
TEST(RecordingFile, IsRefusedWithItsNameReasonAndRemedy) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> good = made({}).bytes;
  std::vector<std::uint8_t> damaged = good;
  damaged[good.size() / 2] ^= 1;
  RecordingWriter short_of_one(128, 1);
  RecordingWriter none(128, 0);
  const std::pair<std::vector<std::uint8_t>, const char*> refusals[] = {
      {{1, 2, 3}, "a.tslr': shorter than a recording's header; write it with `tumblesight record`"},
      {std::vector<std::uint8_t>(100, 7), "a.tslr': not a recording; "},
      {damaged, "a.tslr': a damaged recording; "},
      {short_of_one.finish(), "a.tslr': frame 1 of 1 is incomplete, or a row has more ranges than rays; "},
      {none.finish(), "a.tslr': it has no frames; "},
  };
  for (const auto& [bytes, message] : refusals) {
    const std::string refusal = refusal_of(folder.put("a.tslr", bytes));
    EXPECT_NE(refusal.find(message), std::string::npos) << refusal;
  }
  EXPECT_NE(refusal_of(folder.path("none")).find("none' cannot be read; give an existing file"),
            std::string::npos);
  EXPECT_NE(refusal_of(folder.path("")).find("cannot be read"), std::string::npos);
}

TEST(RecordingFile, IsRefusedBeforeItIsLoaded) {
  expect_all_refused(".tslr", [](const std::string& path) { (void)read_recording(path); });
}

TEST(RecordingFile, ThatIsLargerThanItsFramesIsNotLoaded) {
  const TemporaryFolder folder;
  const std::string path = folder.put("a.tslr", made({}).bytes);
  std::filesystem::resize_file(path, 3ULL << 30);
  const Outcome outcome = outcome_of([&] { (void)read_recording(path); });
  EXPECT_NE(outcome.message.find("a.tslr': it has 3221225472 bytes, and its 10 frames have at most"),
            std::string::npos)
      << outcome.message;
  EXPECT_LT(outcome.peak_kib, own_peak_kib() + 100 * 1024);
}

}  // namespace
}  // namespace tumblesight::sim
