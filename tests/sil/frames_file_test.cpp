// Frames without a flight program as an MCAP file.
#include "sim/recording/frames_file.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "sim/recording/run_steps.hpp"
#include "sim/sil/simulated_steps.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kRun = 77;

std::vector<Sequence> sequences() {
  ScenarioSettings scenario;
  scenario.disturbances.loss_every = 4;
  scenario.disturbances.chaser_rate_deg_s = 2.0;
  return {make_sequence(scenario, 3, 0), make_sequence(scenario, 3, 1)};
}
std::string written() {
  const std::string path = test::temporary_path("frames.mcap");
  const std::vector<Sequence> all = sequences();
  SimulatedSteps source(test::lidar(), test::kSwath_m, all, true);
  write_frames_file(path, source, "near_shoemaker", kRun, test::kSwath_m);
  return path;
}

TEST(FramesFile, GivesTheStepsThatWereWritten) {
  const std::vector<Sequence> all = sequences();
  SimulatedSteps source(test::lidar(), test::kSwath_m, all, true);
  RunSteps read(written());
  EXPECT_FALSE(read.has_flown());
  EXPECT_TRUE(read.is_whole());
  EXPECT_EQ(read.target(), "near_shoemaker");
  ASSERT_EQ(read.steps(), source.steps());
  std::uint32_t frames = 0;
  for (std::uint32_t k = 0; k < read.steps(); ++k) {
    const SourcedStep wanted = source.next(), got = read.next();
    EXPECT_EQ(got.input.time_ns, wanted.input.time_ns);
    EXPECT_EQ(got.step.sequence, wanted.step.sequence);
    EXPECT_EQ(got.step.frame_index, wanted.step.frame_index);
    EXPECT_EQ(got.step.truth.lost, wanted.step.truth.lost);
    EXPECT_LT(got.step.truth.q_lrf_trf.angularDistance(wanted.step.truth.q_lrf_trf), 1e-6);
    EXPECT_FALSE(read.state_crc32(k).has_value());
    ASSERT_EQ(got.input.frames.size(), wanted.input.frames.size()) << k;
    ASSERT_EQ(got.input.navigations.size(), wanted.input.navigations.size()) << k;
    for (std::size_t i = 0; i < got.input.frames.size(); ++i, ++frames) {
      EXPECT_EQ(got.input.frames[i]->ranges, wanted.input.frames[i]->ranges) << k;
      EXPECT_EQ(got.input.frames[i]->exposure_time_ns, wanted.input.frames[i]->exposure_time_ns);
      EXPECT_EQ(got.input.navigations[i].q_inertial_lrf, wanted.input.navigations[i].q_inertial_lrf);
    }
  }
  EXPECT_EQ(frames, read.frames());
  EXPECT_LT(frames, read.steps());  // some were lost
}

TEST(FramesFile, HasPointsForEveryFrameAndTheTruthForEveryStep) {
  const McapReader reader(written());
  const std::uint32_t frames = RunSteps(written()).frames();
  EXPECT_EQ(reader.entries(reader.find("/lidar/points")->id).size(), frames);
  EXPECT_EQ(reader.entries(reader.find("/tf")->id).size(), sequences().size() * 10);
}

// The bytes are those that DDS itself writes.
TEST(FramesFile, SerializesSamplesAsTheBusDoes) {
  const SilSettings settings = test::shipped_settings(test::temporary_path("run.mcap"));
  ASSERT_EQ(run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {}).failure, "");
  const RunFile file(settings.mcap_path);
  const auto compare = [&](auto& sample) {
    using Sample = std::remove_reference_t<decltype(sample)>;
    std::size_t compared = 0;
    file.each(sample, [&](const Sample& read, const McapReader::Entry& entry) {
      const McapReader::Message message = file.reader().read(file.channel<Sample>().id, entry);
      const std::vector<std::uint8_t> bytes = cdr_of(read);
      ASSERT_EQ(bytes.size(), message.size) << file.channel<Sample>().topic;
      EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), message.bytes)) << file.channel<Sample>().topic;
      ++compared;
    });
    EXPECT_GT(compared, 0U) << file.channel<Sample>().topic;
  };
  hal::dds::HelloSample hello;
  compare(hello);
  hal::dds::TruthSample truth;
  compare(truth);
  hal::dds::StepSample step;
  compare(step);
  hal::dds::NavigationSample navigation;
  compare(navigation);
  const auto frame = std::make_unique<hal::dds::LidarFrameSample>();
  compare(*frame);
}

// The flight program sees the same through the file.
TEST(FramesFile, IsReplayedAsTheFramesThemselves) {
  const SilSettings settings = test::shipped_settings();
  RunSteps first(written()), second(written());
  const SilRunResult run = run_sil(settings, first, {});
  ASSERT_EQ(run.failure, "");
  EXPECT_EQ(run.steps_missed, 0U);
  EXPECT_EQ(run_sil(settings, second, {}).trace_crc32, run.trace_crc32);
  EXPECT_GT(std::count_if(run.steps.begin(), run.steps.end(),
                          [](const StepResult& one) { return gives_attitude(one.attitude); }),
            10);
}

}  // namespace
}  // namespace tumblesight::sim
