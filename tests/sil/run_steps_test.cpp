// A run that was recorded, sent again: the flight program comes to the same states.
#include "sim/recording/run_steps.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/sil/simulated_steps.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSteps = 40;

// With lost frames and a chaser that turns.
SilRunResult record(const std::string& path) {
  ScenarioSettings scenario;
  scenario.disturbances.loss_every = 4;
  scenario.disturbances.chaser_rate_deg_s = 2.0;
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < kSteps / 10; ++i) sequences.push_back(make_sequence(scenario, 3, i));
  return run_sil(test::shipped_settings(path), test::lidar(), test::kSwath_m, sequences, {});
}
SilRunResult replay(StepSource& steps) {
  return run_sil(test::shipped_settings(), steps, {}, [](const StepResult&, const gnc::RangeImage&) {});
}

// Verifies TS-SIL-197.
TEST(RecordedRunAgain, GivesTheSameTraceAndStates) {
  const std::string path = test::temporary_path("run.mcap");
  const SilRunResult recorded = record(path);
  ASSERT_EQ(recorded.failure, "");
  RunSteps steps(path);
  EXPECT_EQ(steps.target(), "near_shoemaker");
  EXPECT_EQ(steps.steps(), kSteps);
  EXPECT_NE(steps.model_crc32(), 0U);
  const SilRunResult again = replay(steps);
  ASSERT_EQ(again.failure, "");
  EXPECT_EQ(again.trace_crc32, recorded.trace_crc32);
  for (std::uint32_t k = 0; k < kSteps; ++k) {
    EXPECT_EQ(again.steps[k].state_crc32, recorded.steps[k].state_crc32) << k;
    EXPECT_EQ(steps.state_crc32(k), recorded.steps[k].state_crc32) << k;
    EXPECT_EQ(again.steps[k].telemetry.commands_accepted, recorded.steps[k].telemetry.commands_accepted);
    EXPECT_EQ(again.steps[k].truth.lost, recorded.steps[k].truth.lost) << k;
  }
}

// One range of one frame is another: the states differ from that step on, so that equal ones mean something.
TEST(RecordedRunAgain, WithAnotherRangeGivesOtherStates) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(record(path).failure, "");
  class Changed final : public StepSource {
   public:
    explicit Changed(const std::string& path) : recorded_(path) {}
    std::uint32_t steps() const override { return recorded_.steps(); }
    std::int64_t time_ns(std::uint32_t k) const override { return recorded_.time_ns(k); }
    SourcedStep next() override {
      SourcedStep step = recorded_.next();
      if (next_++ != 1) return step;
      image_ = *step.input.frames.at(0);
      std::uint16_t& range =
          *std::find_if(image_.ranges.begin(), image_.ranges.end(), [](std::uint16_t r) { return r != 0; });
      range = static_cast<std::uint16_t>(range + 16);
      step.input.frames = {&image_};
      return step;
    }

   private:
    RunSteps recorded_;
    gnc::RangeImage image_{};
    std::uint32_t next_ = 0;
  };
  Changed changed(path);
  const SilRunResult again = replay(changed);
  ASSERT_EQ(again.failure, "");
  const RunSteps recorded(path);
  EXPECT_EQ(again.steps[0].state_crc32, recorded.state_crc32(0));
  EXPECT_NE(again.steps[1].state_crc32, recorded.state_crc32(1));
}

TEST(RecordedRunAgain, OfARunThatWasKilledHasTheStepsBeforeItsEnd) {
  const std::string path = test::temporary_path("run.mcap");
  ASSERT_EQ(record(path).failure, "");
  const std::string bytes = test::read_file(path);
  constexpr std::ptrdiff_t kLeft = 1'250'000;
  ASSERT_GT(bytes.size(), kLeft + 10'000);
  test::write_file(path, {bytes.begin(), bytes.begin() + kLeft});
  RunSteps steps(path);
  EXPECT_FALSE(steps.is_whole());
  EXPECT_GT(steps.steps(), 5U);
  EXPECT_LT(steps.steps(), kSteps);
  const SilRunResult again = replay(steps);
  ASSERT_EQ(again.failure, "");
  for (std::uint32_t k = 0; k < steps.steps(); ++k)
    EXPECT_EQ(again.steps[k].state_crc32, steps.state_crc32(k)) << k;
}

TEST(RecordedRunAgain, RefusesARecordingThatLacksAStep) {
  const std::string path = test::temporary_path("part.mcap");
  {
    const std::string whole = test::temporary_path("run.mcap");
    ASSERT_EQ(record(whole).failure, "");
    // All but the step with number 2.
    const McapReader reader(whole);
    McapWriter writer(path, "test");
    for (const McapReader::Channel& channel : reader.channels()) {
      const McapId own = writer.add_channel(
          channel.topic, channel.encoding,
          writer.add_schema(channel.schema_name, channel.schema_encoding, channel.schema_text));
      std::uint32_t number = 0;
      for (const McapReader::Entry& entry : reader.entries(channel.id)) {
        const McapReader::Message message = reader.read(channel.id, entry);
        if (channel.topic == "sil/step" && number++ == 2) continue;
        writer.write(own, static_cast<std::int64_t>(entry.time_ns), message.bytes, message.size);
      }
    }
    writer.close();
  }
  try {
    const RunSteps steps(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("lacks step 2"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim
