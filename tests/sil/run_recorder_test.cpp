// A run as an MCAP file: every sample of the bus, and what viewers show.
#include "sim/sil/run_recorder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/sil/sil_test_support.hpp"
#include "tests/support/mcap_reader.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSteps = 20;

class RecordedRun : public testing::Test {
 protected:
  static SilRunResult run(const std::string& mcap_path) { return test::run_shipped(mcap_path, kSteps / 10); }
};

// Verifies TS-SIL-190.
TEST_F(RecordedRun, HasEverySampleAndTheSameTraceAsWithoutTheRecording) {
  const std::string path = test::temporary_path("run.mcap");
  const SilRunResult recorded = run(path), plain = run("");
  ASSERT_EQ(recorded.failure, "");
  EXPECT_EQ(recorded.trace_crc32, plain.trace_crc32);
  const std::string bytes = test::read_file(path);
  const McapReader reader(bytes);
  for (const char* topic : {"sil/lidar_frame", "sil/navigation", "sil/step", "sil/attitude", "sil/telemetry",
                            "sil/step_done", "sil/truth", "/lidar/points", "/tf", "/figures"})
    EXPECT_EQ(reader.count(topic), kSteps) << topic;
  std::size_t events = 0;
  for (const StepResult& step : recorded.steps) events += step.events.size();
  EXPECT_EQ(reader.count("sil/event"), events);
  EXPECT_EQ(reader.count("/events"), events);
  EXPECT_GE(reader.count("sil/hello"), 2U);
}

// Encapsulation header of plain little-endian CDR, run id, k, time: as tumblesight.idl has them.
TEST_F(RecordedRun, KeepsTheSamplesAsTheyAre) {
  const std::string path = test::temporary_path("run.mcap");
  const SilRunResult recorded = run(path);
  const std::string bytes = test::read_file(path);
  const McapReader reader(bytes);
  std::uint32_t k = 0;
  for (const McapReader::Message& message : reader.messages) {
    if (message.topic != "sil/attitude") continue;
    const StepResult& step = recorded.steps[k];
    EXPECT_EQ(message.time_ns, static_cast<std::uint64_t>(step.time_ns));
    ASSERT_GT(message.data.size(), 44U);
    EXPECT_EQ(message.data.substr(0, 2), std::string("\x00\x01", 2));
    std::uint32_t found_k = 0, sequence_number = 0;
    std::memcpy(&found_k, message.data.data() + 4 + 4, sizeof found_k);
    std::memcpy(&sequence_number, message.data.data() + 4 + 24, sizeof sequence_number);
    EXPECT_EQ(found_k, k);
    EXPECT_EQ(sequence_number, step.attitude.sequence_number);
    ++k;
  }
  EXPECT_EQ(k, kSteps);
}

TEST_F(RecordedRun, ShowsPointsFramesAndErrors) {
  const std::string path = test::temporary_path("run.mcap");
  const SilRunResult recorded = run(path);
  const std::string bytes = test::read_file(path);
  const McapReader reader(bytes);
  const auto points = nlohmann::json::parse(reader.first("/lidar/points")->data);
  EXPECT_EQ(points["frame_id"], "lrf");
  std::size_t returns = 0;
  for (const std::uint16_t range : recorded.pictures.front().second.ranges) returns += range != 0 ? 1U : 0U;
  EXPECT_EQ(points["data"].get<std::string>().size(), (returns * 12 + 2) / 3 * 4);
  const auto frames = nlohmann::json::parse(reader.first("/tf")->data)["transforms"];
  ASSERT_GE(frames.size(), 2U);
  const FrameTruth& truth = recorded.steps[0].truth;
  EXPECT_EQ(frames[0]["child_frame_id"], "target_true");
  EXPECT_NEAR(frames[0]["translation"]["y"].get<double>(), truth.range_m, 1e-9);
  EXPECT_NEAR(frames[0]["rotation"]["w"].get<double>(), truth.q_lrf_trf.w(), 1e-9);
  const auto figures = nlohmann::json::parse(reader.first("/figures")->data);
  EXPECT_NEAR(figures["true_range_m"].get<double>(), truth.range_m, 1e-9);
  EXPECT_TRUE(figures.contains("network_error_deg"));
}

TEST_F(RecordedRun, AFileThatCannotBeWrittenEndsTheRunWithItsName) {
  EXPECT_NE(run("/none/run.mcap").failure.find("recording '/none/run.mcap': cannot be written"),
            std::string::npos);
}

// The recording has a participant of its own, which may get a sample later than the one with the answers.
class LateSamples : public testing::Test {
 protected:
  LateSamples() {
    EXPECT_EQ(domain_.open(static_cast<std::uint32_t>(test::spare_domain())), 0);
    writer_ = hal::dds::create_writer(domain_, hal::dds::topic_of<hal::dds::StepDoneSample>());
    recorder_ = std::make_unique<RunRecorder>(domain_, path_, test::kSwath_m);
    dds_publication_matched_status_t status{};
    for (int i = 0; i < 500 && status.current_count == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      dds_get_publication_matched_status(writer_, &status);
    }
    EXPECT_EQ(status.current_count, 1U);
    StepAnswer answer;
    answer.samples = 1;
    recorder_->add(answer);
  }
  std::size_t recorded() const {
    const std::string bytes = test::read_file(path_);
    return McapReader(bytes).count("sil/step_done");
  }

  hal::dds::Domain domain_;
  dds_entity_t writer_ = 0;
  const std::string path_ = test::temporary_path("run.mcap");
  std::unique_ptr<RunRecorder> recorder_;
};

TEST_F(LateSamples, AreWaitedForAtTheEnd) {
  const auto late = std::async(std::launch::async, [this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const hal::dds::StepDoneSample sample{};
    EXPECT_EQ(dds_write(writer_, &sample), 0);
  });
  recorder_->close();
  late.wait();
  EXPECT_EQ(recorded(), 1U);
}

TEST_F(LateSamples, ThatNeverComeDoNotHoldUpTheEnd) {
  recorder_->close();
  EXPECT_EQ(recorded(), 0U);
}

}  // namespace
}  // namespace tumblesight::sim
