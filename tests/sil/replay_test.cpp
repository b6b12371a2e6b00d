// A recording through the flight program: the attitudes of the simulated run, cycles without a frame, and
// frames that are refused.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/model/model_file.hpp"
#include "sim/recording/make_recording.hpp"
#include "sim/recording/recorded_steps.hpp"
#include "sim/report/replay_report.hpp"
#include "sim/report/sil_report.hpp"
#include "sim/sil/simulated_steps.hpp"
#include "tests/sil/sil_test_support.hpp"
#include "tests/support/mcap_reader.hpp"

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

constexpr double kSwath_m = 10.0;

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
  RecordedSteps steps(result.file, by_frame, kSwath_m);
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

// With lost frames and a chaser that turns: gaps, attitudes of the chaser and pauses have to be right.
// Verifies TS-SIL-140.
TEST(Replay, GivesTheAttitudesOfTheSimulatedRunBitForBit) {
  RecordingSettings recorded;
  recorded.sequences = 3;
  recorded.seed = 11;
  recorded.scenario.disturbances.loss_every = 4;
  recorded.scenario.disturbances.chaser_rate_deg_s = 2.0;
  const SilSettings settings = test::shipped_settings();
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
  std::uint32_t tracks = 0, last_frame_of_track = 0;
  for (const StepResult& step : simulated.steps) {
    if (step.truth.lost) continue;
    if (step.attitude.frames_since_reset <= last_frame_of_track || tracks == 0) ++tracks;
    last_frame_of_track = step.attitude.frames_since_reset;
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
  EXPECT_GE(tracks, recorded.sequences);
  EXPECT_EQ(replay.report.run.results.back().sequence + 1, tracks) << "a result's sequence is its track";
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

// The second truth is of the attitude alone. The frame at time 0 is not that of the cycle without one, whose
// report has no exposure.
TEST(Replay, ARecordingOfTheRunHasTheTruthThatIsKnownAndNoTimeBeforeZero) {
  RecordingWriter writer(128, 4);
  std::vector<std::optional<RecordedTruth>> truth;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::int64_t time_ns = i < 3 ? (std::int64_t{i} - 2) * kPeriod : 2 * kPeriod;
    const gnc::RangeImage frame = frame_at(i, i, time_ns);
    writer.add(frame, {time_ns, {1 << 30, 0, 0, 0}, true});
    RecordedTruth of_frame;
    if (i != 1) of_frame.trf_origin_lrf_m = Eigen::Vector3d(0.5, 60.0 + i, -1.0);
    if (i != 1) of_frame.rate_lrf_rad_s = Eigen::Vector3d(0.0, 0.1, 0.0);
    truth.push_back(of_frame);
  }
  SilSettings settings = test::settings();
  settings.mcap_path = test::temporary_path("run.mcap");
  settings.swath_m = kSwath_m;
  const std::string frames_path = test::temporary_path("frames.tslr");
  test::write_file(frames_path, writer.finish());
  const RecordingFile recording = read_recording(frames_path);
  RecordedSteps steps(recording, truth, kSwath_m);
  ASSERT_EQ(run_sil(settings, steps, {}, [](const StepResult&, const gnc::RangeImage&) {}).failure, "");
  const std::string bytes = test::read_file(settings.mcap_path);
  const McapReader reader(bytes);
  std::vector<nlohmann::json> figures;
  for (const McapReader::Message& message : reader.messages) {
    if (message.topic != "/figures") continue;
    EXPECT_EQ(message.time_ns, figures.size() * static_cast<std::uint64_t>(kPeriod));
    figures.push_back(nlohmann::json::parse(message.data));
  }
  ASSERT_EQ(figures.size(), 5U);
  EXPECT_NEAR(figures[0]["true_range_m"].get<double>(), 60.0, 1e-6);
  EXPECT_FALSE(figures[1].contains("true_range_m"));
  EXPECT_FALSE(figures[1].contains("true_rate_deg_s"));
  EXPECT_TRUE(figures[1].contains("network_error_deg"));
  EXPECT_NEAR(figures[2]["true_range_m"].get<double>(), 62.0, 1e-6);
  EXPECT_FALSE(figures[3].contains("true_range_m"));
  const auto place = nlohmann::json::parse(reader.first("/tf")->data)["transforms"][0];
  EXPECT_EQ(place["child_frame_id"], "target_true");
  EXPECT_NEAR(place["translation"]["x"].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(place["translation"]["z"].get<double>(), -1.0, 1e-6);
}

}  // namespace
}  // namespace tumblesight::sim
