// The network that ships, on the mesh that ships, through the flight program over DDS: what it reports while
// the sensor loses and repeats frames, and while the chaser turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "sim/evaluation/host_estimator.hpp"
#include "sim/model/model_file.hpp"
#include "sim/report/sil_report.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kSequences = 40;
constexpr std::uint32_t kFrames = 10;
constexpr std::uint32_t kLongFrames = 16;
constexpr double kMostlyRight = 0.97;

double shipped_swath_m() {
  const std::vector<std::uint8_t> image = read_model_bytes(TUMBLESIGHT_SHIPPED_MODEL);
  return 1e-3 * HostEstimator(image).model().projection.swath_mm;
}

SilRunResult run_of(const std::vector<Sequence>& sequences) {
  const SilSettings settings = test::shipped_settings();
  SilRunResult run = run_sil(settings, test::lidar(), shipped_swath_m(), sequences, {});
  EXPECT_EQ(run.steps.size(), sequences.size() * sequences.front().frames.size());
  EXPECT_EQ(run_faults(run), std::vector<std::string>{});
  return run;
}

SilRunResult run_with(const Disturbances& disturbances, std::uint32_t frames = kFrames) {
  ScenarioSettings scenario{Condition::kNominal, static_cast<int>(frames)};
  scenario.disturbances = disturbances;
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < kSequences; ++i) sequences.push_back(make_sequence(scenario, 1, i));
  return run_of(sequences);
}

ErrorSummary expect_right_and_valid(const SilRunResult& run, std::uint32_t frames = kFrames) {
  const ErrorSummary errors =
      last_frame_summary(frame_results(run, shipped_swath_m()), frames, Estimator::kRcnn);
  EXPECT_EQ(errors.count, kSequences);
  EXPECT_EQ(errors.wrong_and_valid, 0.0);
  EXPECT_GE(errors.right_and_valid, kMostlyRight);
  return errors;
}

bool has_event(const StepResult& step, hal::EventId id) {
  return std::any_of(step.events.begin(), step.events.end(),
                     [id](const hal::Event& event) { return event.id == id; });
}

bool stands(const StepResult& step, hal::Fault fault) {
  return (step.telemetry.faults_persisting >> static_cast<unsigned>(fault) & 1U) != 0;
}

// In every sequence the fault stands from frame `first` to frame `last`.
void expect_stands(const SilRunResult& run, hal::Fault fault, std::uint32_t first, std::uint32_t last) {
  for (const StepResult& step : run.steps) {
    if (step.frame_index < first || step.frame_index > last) continue;
    EXPECT_TRUE(stands(step, fault)) << "sequence " << step.sequence << ", frame " << step.frame_index;
  }
}

// No frame of a frozen sensor gives an attitude.
void expect_no_attitude_from_repeats(const SilRunResult& run) {
  for (const StepResult& step : run.steps) {
    if (step.truth.is_genuine()) continue;
    EXPECT_FALSE(gives_attitude(step.attitude))
        << "sequence " << step.sequence << ", frame " << step.frame_index;
  }
}

// The registered pose of the last frames is verified, and right; every verified pose is counted, and the
// event says when the verdict changes.
void expect_verified_poses(const SilRunResult& run) {
  std::uint32_t verified = 0, last = 0, last_verified = 0;
  bool before = false;
  for (const StepResult& step : run.steps) {
    const hal::AttitudeReport& report = step.attitude;
    if (!gives_attitude(report)) continue;
    const bool is_verified = report.pose_doubts == 0;
    verified += is_verified ? 1 : 0;
    EXPECT_EQ(has_event(step, is_verified ? hal::EventId::kPoseVerified : hal::EventId::kPoseDoubtful),
              is_verified != before);
    before = is_verified;
    if (step.frame_index + 1 < kFrames) continue;
    ++last;
    if (!is_verified) continue;
    ++last_verified;
    // A pose of the first frames that contradicts the others is forgotten.
    EXPECT_GE(report.pose_frames, kFrames / 2);
    EXPECT_LE(report.pose_frames, kFrames);
    EXPECT_LT(angular_error_rad(step.truth.q_lrf_trf, gnc::to_double(report.pose_q_lrf_trf)), 0.0175);
    EXPECT_NEAR(1e-6 * report.pose_origin_lrf_um[0], 0.0, 0.02);
    EXPECT_NEAR(1e-6 * report.pose_origin_lrf_um[1], step.truth.range_m, 0.15);
    EXPECT_NEAR(1e-6 * report.pose_origin_lrf_um[2], 0.0, 0.02);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(1e-6 * report.pose_rate_lrf_urad_s[i], step.truth.rate_lrf_rad_s[static_cast<int>(i)],
                  0.003);
      EXPECT_NEAR(1e-6 * report.pose_origin_lrf_now_um[i], 1e-6 * report.pose_origin_lrf_um[i], 0.05);
    }
  }
  EXPECT_GE(last_verified, kMostlyRight * last);
  ASSERT_FALSE(run.steps.empty());
  EXPECT_EQ(run.steps.back().telemetry.poses_verified, verified);
}

struct VerifiedPoses {
  std::size_t all = 0;
  std::size_t wrong = 0;  // more than 5 degrees off
};
VerifiedPoses verified_poses(const SilRunResult& run) {
  constexpr double kWrong_rad = 0.0873;
  VerifiedPoses poses;
  for (const StepResult& step : run.steps) {
    if (!gives_attitude(step.attitude) || step.attitude.pose_doubts != 0) continue;
    const double error_rad =
        angular_error_rad(step.truth.q_lrf_trf, gnc::to_double(step.attitude.pose_q_lrf_trf));
    ++poses.all;
    if (error_rad <= kWrong_rad) continue;
    ++poses.wrong;
    std::cout << "verified and wrong: sequence " << step.sequence << ", frame " << step.frame_index << '\n';
  }
  return poses;
}

// Verifies TS-SIL-100, TS-EST-200, TS-EST-202.
TEST(ShippedNetwork, ReportsVerifiedPoses) {
  expect_verified_poses(run_with({}));
}

// Verifies TS-EST-202, TS-EST-204.
// In these sequences of 6,000 the network keeps to an attitude half a turn from the right one, which is its
// second. Each had a pose that was verified and wrong when settled tracks were not compared with it.
TEST(ShippedNetwork, DoesNotVerifyAPoseWhileItsSecondAttitudeIsBetter) {
  constexpr std::uint64_t kSeed = 22;
  const ScenarioSettings scenario{Condition::kDegraded, static_cast<int>(kFrames)};
  std::vector<Sequence> sequences;
  for (const std::uint64_t index : {112, 210, 810, 1515, 1685, 1842, 2000, 2629, 4396, 5321, 5363, 5677})
    sequences.push_back(make_sequence(scenario, kSeed, index));
  const VerifiedPoses poses = verified_poses(run_of(sequences));
  EXPECT_EQ(poses.wrong, 0U);
  EXPECT_GE(poses.all, sequences.size());
}

std::vector<Sequence> sequences_of_few_rays(const std::vector<std::uint64_t>& indices) {
  constexpr std::uint64_t kSeed = 22;
  Effects few_rays;
  few_rays.rays = 32;
  ScenarioSettings scenario{Condition::kNominal, static_cast<int>(kFrames)};
  scenario.effects = few_rays;
  std::vector<Sequence> sequences;
  for (const std::uint64_t index : indices) sequences.push_back(make_sequence(scenario, kSeed, index));
  return sequences;
}

// Verifies TS-EST-202.
// With 32 rays single frames hardly tell half a turn. In these sequences, the worst of 2,000, 74 poses were
// verified and wrong when an alternative that does not explain a frame counted as much as one that does. Now
// 19 are, and at most a third shall be.
TEST(ShippedNetwork, VerifiesFewerWrongPosesOfFewRays) {
  const std::vector<std::uint64_t> worst{136, 485,  523,  532,  576,  599,  614,  652,  755, 827,
                                         915, 1125, 1228, 1426, 1533, 1902, 1941, 1957, 1962};
  EXPECT_LE(verified_poses(run_of(sequences_of_few_rays(worst))).wrong, 74U / 3);
}

// Verifies TS-EST-202.
TEST(ShippedNetwork, VerifiesPosesOfFewRays) {
  std::vector<std::uint64_t> first(20);
  std::iota(first.begin(), first.end(), 0);
  const VerifiedPoses poses = verified_poses(run_of(sequences_of_few_rays(first)));
  EXPECT_GE(poses.all, 1.5 * first.size());
  EXPECT_LE(poses.wrong, 1U);
}

// Verifies TS-SIL-100, TS-EST-330.
TEST(ShippedNetwork, IsNotMisledByAFrozenSensor) {
  Disturbances frozen;
  frozen.frozen = 3;
  frozen.well_frames = 2;
  const SilRunResult run = run_with(frozen);
  expect_right_and_valid(run);
  expect_no_attitude_from_repeats(run);
  expect_stands(run, hal::Fault::kFrameFrozen, kFrames - 3, kFrames - 1);  // from the third repeat
}

// Verifies TS-SIL-100, TS-EST-330.
TEST(ShippedNetwork, KeepsItsTrackWhenEverySecondFrameIsLost) {
  Disturbances lossy;
  lossy.loss_every = 2;
  const SilRunResult run = run_with(lossy);
  expect_right_and_valid(run);
  expect_stands(run, hal::Fault::kOutage, 6, kFrames - 1);  // from the fourth lost frame
}

// Verifies TS-SIL-100, TS-EST-330.
TEST(ShippedNetwork, IsNotMisledByAFrozenSensorThatLosesEverySecondFrame) {
  Disturbances both;
  both.frozen = 7;  // of these four are lost, the first among them
  both.loss_every = 2;
  both.well_frames = 2;
  const SilRunResult run = run_with(both, kLongFrames);
  expect_right_and_valid(run, kLongFrames);
  expect_no_attitude_from_repeats(run);
  const std::uint32_t first_frozen = kLongFrames - both.well_frames - both.frozen;
  // Within six cycles of the freeze, and until three cycles after the last repeat.
  expect_stands(run, hal::Fault::kFrameFrozen, first_frozen + 5, first_frozen + 7);
}

// Verifies TS-SIL-100, TS-EST-310.
TEST(ShippedNetwork, FollowsTheTargetFromATurningChaser) {
  Disturbances turning;
  turning.chaser_rate_deg_s = 5.0;
  const SilRunResult run = run_with(turning);
  const ErrorSummary errors = expect_right_and_valid(run);
  EXPECT_LE(errors.mean_within_20_deg, 2.5);
  EXPECT_TRUE(standing_faults(run).empty()) << text_of(standing_faults(run));
}

struct ProgramRun {
  const char* name;
  std::vector<std::string> options;
  const char* fault;  // that stands in every sequence; nullptr: none
};

class ShippedSimulation : public ::testing::TestWithParam<ProgramRun> {};

// Verifies TS-SIL-100.
TEST_P(ShippedSimulation, EndsWellWithFiguresAndFaults) {
  constexpr int kProgramSequences = 20;
  const std::string log = test::temporary_path("simulate.log"), json_path = test::temporary_path("run.json");
  std::vector<std::string> arguments{"simulate", "--sequences", std::to_string(kProgramSequences), "--json",
                                     json_path,  "--report",    test::temporary_path("run.html")};
  arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
  FlightProcess simulate(TUMBLESIGHT_PROGRAM, arguments, log);
  ASSERT_TRUE(simulate.wait_for_end(60.0));
  ASSERT_TRUE(simulate.ended_well()) << simulate.how_it_ended() << "\n" << test::read_file(log);
  const auto json = nlohmann::json::parse(test::read_file(json_path));
  EXPECT_EQ(json.at("steps_missed"), 0);
  EXPECT_EQ(json.at("rcnn").at("wrong_and_valid"), 0.0);
  EXPECT_GE(json.at("rcnn").at("right_and_valid"), 0.95);
  if (GetParam().fault == nullptr) return;
  EXPECT_EQ(json.at("faults").at(GetParam().fault).at("sequences"), kProgramSequences);
  EXPECT_NE(test::read_file(log).find(GetParam().fault), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Sil, ShippedSimulation,
    ::testing::Values(ProgramRun{"Undisturbed", {}, nullptr},
                      ProgramRun{"Frozen", {"--frozen", "3", "--well-frames", "2"}, "FRAME_FROZEN"},
                      ProgramRun{"Lossy", {"--loss-every", "2"}, "OUTAGE"},
                      ProgramRun{
                          "FrozenAndLossy",
                          {"--loss-every", "2", "--frozen", "7", "--well-frames", "2", "--frames", "16"},
                          "FRAME_FROZEN"},
                      ProgramRun{"Turning", {"--chaser-rate", "5"}, nullptr}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace tumblesight::sim
