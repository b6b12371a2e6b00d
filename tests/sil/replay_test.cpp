// A recording through the flight program: the attitudes of the simulated run, cycles without a frame, and
// frames that are refused.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/model/model_file.hpp"
#include "sim/recording/make_recording.hpp"
#include "sim/report/replay_report.hpp"
#include "sim/report/sil_report.hpp"
#include "sim/sil/recorded_steps.hpp"
#include "sim/sil/simulated_steps.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kPeriod = kFramePeriod_ns;

std::string plan_of(const std::vector<std::int64_t>& exposures_ns) {
  std::vector<FrameStamp> frames;
  for (const std::int64_t exposure_ns : exposures_ns)
    frames.push_back({static_cast<std::uint32_t>(frames.size()), exposure_ns});
  std::string plan;
  try {
    for (const RecordedCycle& cycle : plan_cycles(frames))
      plan += (plan.empty() ? "" : " ") + std::to_string(cycle.time_ns) + (cycle.has_frame ? "+" : "-");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return plan;
}

// Verifies TS-SIL-140.
TEST(PlanCycles, GivesEachFrameACycleAtItsExposureAndOneToEachThatIsMissing) {
  EXPECT_EQ(plan_of({-5}), "-5+");
  EXPECT_EQ(plan_of({0, kPeriod, 4 * kPeriod}), "0+ 2700000000+ 5400000000- 8100000000- 10800000000+");
  EXPECT_EQ(plan_of({0, kPeriod / 2, 3 * kPeriod / 2}), "0+ 1350000000+ 4050000000+") << "a faster sensor";
  EXPECT_EQ(plan_of({0, 4'049'999'999}), "0+ 4049999999+");
  EXPECT_EQ(plan_of({0, 4'050'000'000}), "0+ 2700000000- 4050000000+");
}

TEST(PlanCycles, DeliversFramesThatWereNotExposedLaterOneAfterTheOther) {
  EXPECT_EQ(plan_of({kPeriod, kPeriod, 0, 2 * kPeriod}), "2700000000+ 2701000000+ 2702000000+ 5400000000+");
}

TEST(PlanCycles, RefusesTimesThatNoMissionHas) {
  EXPECT_NE(plan_of({0, std::numeric_limits<std::int64_t>::min()})
                .find("frame 2 of the recording, sequence number 1: exposure time -9223372036854775808 ns "
                      "must be from"),
            std::string::npos);
  EXPECT_NE(plan_of({0, 2'700'000'000'000'000}).find("is cycle 1000001; a run has at most 1000000: divide"),
            std::string::npos);
  EXPECT_EQ(plan_of({-3'000'000'000'000'000'000, 3'000'000'000'000'000'000}).find("frame 2 of the recording"),
            0U);
}

// The frames as a recording, and the run over it.
struct Replayed {
  RecordingFile file;
  SilRunResult run;
  ReplayReport report;
};

Replayed replayed(std::vector<std::uint8_t> bytes, const SilSettings& settings,
                  const std::vector<RecordedTruth>& truth = {}) {
  Replayed result;
  const std::string path = test::temporary_path("frames.tslr");
  test::write_file(path, bytes);
  result.file = read_recording(path);
  const auto by_frame = truth_by_frame(result.file, parse_truth(truth_csv(truth), "truth.csv"), "truth.csv");
  RecordedSteps steps(result.file, by_frame);
  std::vector<ReplayedFrame> frames;
  result.run = run_sil(settings, steps, {}, [&](const StepResult& step, const gnc::RangeImage& frame) {
    frames.push_back(replayed_frame(step, frame));
  });
  EXPECT_EQ(result.run.failure, "");
  ReplaySetup setup;
  setup.target = settings.target;
  setup.frames = static_cast<std::uint32_t>(frames.size());
  setup.truth = truth.empty() ? "" : "truth.csv";
  setup.projection = {8000, 4000};
  result.report = replay_report(setup, result.run, frames);
  return result;
}

void expect_same_attitude(const hal::AttitudeReport& a, const hal::AttitudeReport& b) {
  EXPECT_EQ(a.validity, b.validity);
  EXPECT_EQ(a.frames_since_reset, b.frames_since_reset);
  EXPECT_EQ(a.q_lrf_trf, b.q_lrf_trf);
  EXPECT_EQ(a.predicted_error_urad, b.predicted_error_urad);
  EXPECT_EQ(a.q_lrf_trf_single_frame, b.q_lrf_trf_single_frame);
  EXPECT_EQ(a.rate_lrf_urad_s, b.rate_lrf_urad_s);
  EXPECT_EQ(a.attitude_covariance_e8, b.attitude_covariance_e8);
  EXPECT_EQ(a.rate_covariance_e8, b.rate_covariance_e8);
  EXPECT_EQ(a.q_lrf_trf_now, b.q_lrf_trf_now);
  EXPECT_EQ(a.centroid_lrf_mm, b.centroid_lrf_mm);
}

// With lost frames and a chaser that turns, so that gaps, attitudes of the chaser and pauses have to be
// right. Verifies TS-SIL-140.
TEST(Replay, GivesTheAttitudesOfTheSimulatedRunBitForBit) {
  RecordingSettings recorded;
  recorded.sequences = 3;
  recorded.seed = 11;
  recorded.scenario.disturbances.loss_every = 4;
  recorded.scenario.disturbances.chaser_rate_deg_s = 2.0;
  SilSettings settings = test::settings();
  settings.target = "near_shoemaker";
  settings.model_path = TUMBLESIGHT_SHIPPED_MODEL;
  const double swath_m =
      1e-3 * HostEstimator(read_model_bytes(TUMBLESIGHT_SHIPPED_MODEL)).model().projection.swath_mm;
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < recorded.sequences; ++i)
    sequences.push_back(make_sequence(recorded.scenario, recorded.seed, i));
  const SilRunResult simulated = run_sil(settings, test::lidar(), swath_m, sequences, {});
  ASSERT_EQ(simulated.failure, "");

  const MadeRecording made =
      make_recording(FrameRenderer(test::lidar(), swath_m), recorded, [](std::uint32_t) {});
  const Replayed replay = replayed(made.bytes, settings, made.truth);
  auto row = replay.report.rows.begin();
  std::size_t compared = 0;
  for (const StepResult& step : simulated.steps) {
    if (step.truth.lost) continue;
    while (row != replay.report.rows.end() && !row->frame) ++row;
    ASSERT_NE(row, replay.report.rows.end());
    expect_same_attitude(step.attitude, row->attitude);
    const double error_deg =
        angular_error_rad(step.truth.q_lrf_trf, gnc::to_double(step.attitude.q_lrf_trf)) * 180.0 /
        3.14159265358979;
    EXPECT_NEAR(row->error_deg.value(), error_deg, 1e-9);
    EXPECT_EQ(replay.run.steps[row->cycle].sequence, step.sequence);
    ++compared;
    ++row;
  }
  EXPECT_EQ(compared, made.truth.size());
  EXPECT_EQ(replay.report.run.results.back().sequence, 2U) << "a track per sequence";
  EXPECT_EQ(replay.report.run.results.size(), compared);
}

gnc::RangeImage frame_at(std::size_t content, std::uint32_t number, std::int64_t exposure_ns) {
  gnc::RangeImage frame = test::frames()[content];
  frame.sequence_number = number;
  frame.exposure_time_ns = exposure_ns;
  return frame;
}

// Verifies TS-SIL-140.
TEST(Replay, SaysWhyEachFrameWasRefusedAndWhichAreMissing) {
  constexpr std::size_t kNoChaser = 7, kEmpty = 9, kNarrow = 10;
  std::vector<gnc::RangeImage> frames{
      frame_at(0, 0, 0),           frame_at(1, 1, kPeriod),      frame_at(2, 1, 2 * kPeriod),
      frame_at(3, 3, kPeriod),     frame_at(4, 4, 5 * kPeriod),  frame_at(5, 5, 5 * kPeriod + 50'000'000),
      frame_at(6, 6, 6 * kPeriod), frame_at(7, 7, 7 * kPeriod),  frame_at(6, 8, 8 * kPeriod),
      frame_at(8, 9, 9 * kPeriod), frame_at(9, 10, 10 * kPeriod)};
  frames[kEmpty].ranges.fill(0);
  frames[kNarrow].fov_urad = 1000;
  RecordingWriter writer(frames[0].rays, static_cast<std::uint32_t>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i)
    writer.add(frames[i], {frames[i].exposure_time_ns, {1 << 30, 0, 0, 0}, i != kNoChaser});
  const Replayed replay = replayed(writer.finish(), test::settings());
  std::vector<std::string> found;
  for (const ReplayRow& row : replay.report.rows) found.push_back(row.has_attitude ? "attitude" : row.status);
  EXPECT_EQ(found,
            (std::vector<std::string>{
                "attitude", "attitude", "refused: duplicate", "refused: exposure backwards", "no frame",
                "no frame", "attitude", "refused: too soon", "attitude", "refused: chaser unknown",
                "refused: repeated", "refused: too few returns", "refused: bad field of view"}));
  const nlohmann::ordered_json json = replay_json(replay.report, replay.run);
  EXPECT_EQ(json.at("refused").dump(),
            R"({"duplicate":1,"stale":2,"bad":2,"repeated":1,"without_chaser":1})");
  EXPECT_EQ(json.at("cycles_without_frame"), 2);
  EXPECT_EQ(json.at("frames"), 11);
  EXPECT_EQ(json.at("rows").size(), 13U);
  EXPECT_TRUE(json.at("truth").is_null());
  EXPECT_EQ(flight_faults(replay.run), std::vector<std::string>{}) << "a refused frame is a result";
}

}  // namespace
}  // namespace tumblesight::sim
