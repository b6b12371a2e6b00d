#include "sim/report/sil_report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/evaluation/curves.hpp"
#include "sim/operations/fault_names.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSwath_m = 8.0;

// Two sequences of two frames; every attitude 0.1 rad off, the single frame's 0.5 rad.
SilRunResult two_sequences() {
  SilRunResult made;
  for (std::uint32_t i = 0; i < 4; ++i) {
    StepResult step;
    step.sequence = i / 2;
    step.frame_index = i % 2;
    step.truth = {Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 50.0};
    step.answered = true;
    step.attitude.q_lrf_trf = {1072399895, 53664725, 0, 0};
    step.attitude.q_lrf_trf_single_frame = {1040361791, 0, 265647978, 0};
    step.telemetry.mode = hal::Mode::kStandby;
    step.telemetry.inference_us = 1000 + 100 * i;
    made.steps.push_back(step);
  }
  made.steps_planned = 4;
  made.trace_crc32 = 123;
  return made;
}

SilRunSetup setup() {
  SilRunSetup made;
  made.target = "near_shoemaker";
  made.condition = "nominal";
  made.sequences = 2;
  made.frames = 2;
  made.projection.swath_mm = 8000;
  return made;
}

// The same with verified poses in the second frames: 0.01 rad, 5 mm across and 10 mm along off.
SilRunResult run_with_poses() {
  SilRunResult made = two_sequences();
  for (StepResult& step : made.steps) {
    step.truth.offset_swaths = {0.25, 0.0};
    if (step.frame_index == 0) continue;
    hal::AttitudeReport& report = step.attitude;
    report.pose_doubts = 0;
    report.pose_q_lrf_trf = {1073728403, 5368687, 0, 0};
    report.pose_origin_lrf_um = {2'003'000, 50'010'000, -4'000};
    report.pose_rate_lrf_urad_s = {0, 0, 17'453};
    report.pose_velocity_lrf_um_s = {0, 3'000, 0};
    report.pose_sigma.fill(10'000);
  }
  return made;
}

TEST(RunJson, HasExactlyTheAgreedKeys) {
  const nlohmann::ordered_json json = run_json(setup(), two_sequences());
  std::string keys;
  for (const auto& [key, value] : json.items()) keys += key + " ";
  EXPECT_EQ(keys,
            "target condition sequences disturbances effect rcnn cnn pose pose_first inference_us "
            "flight_heap_allocations steps_missed frames_superseded trace_crc32 faults requests ");
  EXPECT_NEAR(json["rcnn"]["mean_deg"].get<double>(), 5.7296, 1e-3);
  EXPECT_NEAR(json["cnn"]["mean_deg"].get<double>(), 28.648, 1e-3);
  EXPECT_EQ(json["rcnn"]["within_20deg"], 1.0);
  EXPECT_EQ(json["cnn"]["within_20deg"], 0.0);
  EXPECT_EQ(json["inference_us"]["median"], 1150.0);
  EXPECT_EQ(json["inference_us"]["max"], 1300.0);
  EXPECT_EQ(json["trace_crc32"], 123);
}

TEST(RunJson, HoldsTheComparisonWithTheFloat32Reference) {
  NumericsComparison numerics;
  numerics.float32 = summarise({1.0, 2.0});
  numerics.difference = summarise({0.25});
  numerics.largest_difference_deg = 0.5;
  const nlohmann::ordered_json json = run_json(setup(), two_sequences(), numerics);
  EXPECT_EQ(json["float32"]["mean_deg"], 1.5);
  EXPECT_EQ(json["difference_to_float32"]["mean_deg"], 0.25);
  EXPECT_EQ(json["difference_to_float32"]["max_deg"], 0.5);
}

TEST(RunFaults, AreNoneOfAGoodRun) {
  EXPECT_TRUE(run_faults(two_sequences()).empty());
}

TEST(RunFaults, NameAnEarlyEndAndTheStepsMissed) {
  SilRunResult cut = two_sequences();
  cut.steps.pop_back();
  cut.steps_missed = 1;
  cut.failure = "the flight program has ended";
  const std::vector<std::string> found = run_faults(cut);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NE(found[0].find("the flight program has ended"), std::string::npos);
  EXPECT_NE(found[1].find("1 of 4 steps"), std::string::npos);
}

TEST(RunFaults, AreNoneWhereANewerFrameOfTheSameCycleWasUsed) {
  SilRunResult fast = two_sequences();
  fast.steps[1].answered = false;
  fast.frames_superseded = 1;
  EXPECT_TRUE(run_faults(fast).empty());
  EXPECT_EQ(steps_text(fast), "3 of 4 answered, 1 superseded by a newer frame of the same cycle");
  EXPECT_EQ(run_json(setup(), fast).at("frames_superseded"), 1);
}

TEST(RunFaults, NameAFlightProgramWithoutAModel) {
  SilRunResult safe = two_sequences();
  for (StepResult& step : safe.steps) {
    step.attitude.validity = hal::Validity::kStandby;
    step.telemetry.mode = hal::Mode::kSafe;
  }
  const std::vector<std::string> found = run_faults(safe);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("not in RUN"), std::string::npos);
  EXPECT_EQ(run_json(setup(), safe)["rcnn"]["mean_deg"], 180.0);
}

// Verifies TS-SIL-110.
TEST(RunFaults, NameRefusedTelecommands) {
  SilRunResult refusing = two_sequences();
  refusing.steps.back().telemetry.commands_refused = 1;
  const std::vector<std::string> found = run_faults(refusing);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("refused 1 telecommand;"), std::string::npos) << found[0];
}

TEST(RunFaults, DoNotNameAFrameThatOwesNoAttitude) {
  SilRunResult disturbed = two_sequences();
  disturbed.steps[0].truth.lost = true;
  disturbed.steps[0].attitude.validity = hal::Validity::kNoFrame;
  disturbed.steps[2].truth.frozen_for = 1;
  disturbed.steps[2].attitude.validity = hal::Validity::kNoFrame;
  EXPECT_TRUE(run_faults(disturbed).empty());
  EXPECT_EQ(errors_by_frame(frame_results(disturbed, kSwath_m), 2)[0].rcnn.count, 0U);
}

TEST(StandingFaults, AreCountedByStepAndSequence) {
  SilRunResult faulty = two_sequences();
  const auto bit = [](hal::Fault fault) { return 1U << static_cast<unsigned>(fault); };
  faulty.steps[1].telemetry.faults_persisting = bit(hal::Fault::kFrameFrozen);
  faulty.steps[2].telemetry.faults_persisting = bit(hal::Fault::kFrameFrozen) | bit(hal::Fault::kOutage);
  faulty.steps[3].telemetry.faults_persisting = bit(hal::Fault::kFrameFrozen);
  EXPECT_EQ(text_of(standing_faults(two_sequences())), "none");
  EXPECT_EQ(text_of(standing_faults(faulty)),
            "OUTAGE in 1 step of 1 sequence, FRAME_FROZEN in 3 steps of 2 sequences");
  EXPECT_EQ(run_json(setup(), faulty)["faults"].dump(),
            R"({"OUTAGE":{"steps":1,"sequences":1,"first_step":2},)"
            R"("FRAME_FROZEN":{"steps":3,"sequences":2,"first_step":1}})");
  faulty.steps[2].answered = false;
  EXPECT_EQ(text_of(standing_faults(faulty)), "FRAME_FROZEN in 2 steps of 2 sequences");
}

TEST(StandingFaults, HaveTheNamesOfTheInterfaceDocument) {
  std::ostringstream document;
  document << std::ifstream(TUMBLESIGHT_SOURCE_DIR "/docs/icd.md").rdbuf();
  for (int i = 0; i < hal::kFaults; ++i) {
    const std::string row = "\n| " + std::to_string(i) + " | " + name_of(static_cast<hal::Fault>(i)) + " | ";
    EXPECT_NE(document.str().find(row), std::string::npos) << row;
  }
  EXPECT_EQ(name_of(hal::Fault{99}), "FAULT 99");
}

// Verifies TS-MEM-020.
TEST(RunFaults, NameHeapAllocations) {
  SilRunResult allocating = two_sequences();
  allocating.flight_heap_allocations = 3;
  EXPECT_EQ(run_faults(allocating).size(), 1U);
}

TEST(FrameResults, LeaveOutStepsWithoutAnAnswer) {
  SilRunResult some = two_sequences();
  some.steps[2].answered = false;
  EXPECT_EQ(frame_results(some, kSwath_m).size(), 3U);
}

TEST(FrameResults, HoldThePosesOfTheReports) {
  const std::vector<FrameResult> results = frame_results(run_with_poses(), kSwath_m);
  ASSERT_EQ(results.size(), 4U);
  EXPECT_FALSE(results[0].pose.known);
  const PoseErrors& pose = results[1].pose;
  EXPECT_TRUE(pose.known);
  EXPECT_TRUE(pose.verified);
  EXPECT_NEAR(pose.turn_deg, 0.01 * 57.29578, 1e-4);
  EXPECT_NEAR(pose.across_m, 0.005, 1e-6);
  EXPECT_NEAR(pose.along_m, 0.010, 1e-6);
  EXPECT_NEAR(pose.rate_deg_s, 1.0, 1e-3);
  EXPECT_NEAR(pose.velocity_m_s, 0.003, 1e-6);
  EXPECT_TRUE(pose.inside_95) << "10 mrad and 10 mm, one standard deviation each";
}

TEST(RunJson, NamesWhatWasAskedOfTheRun) {
  SilRunResult asked = two_sequences();
  asked.requests = {{4, "freeze for 2 steps"}, {6, "telecommand NOOP"}};
  const nlohmann::ordered_json json = run_json(SilRunSetup{}, asked);
  EXPECT_EQ(json["requests"][1]["step"], 6);
  EXPECT_EQ(json["requests"][1]["request"], "telecommand NOOP");
  EXPECT_EQ(text_of(asked.requests), "step 4: freeze for 2 steps; step 6: telecommand NOOP");
  asked.requests.assign(10, {1, "drop for 1 step"});
  EXPECT_NE(text_of(asked.requests).find("; and 2 more"), std::string::npos);
}

TEST(RunJson, HoldsThePoses) {
  const nlohmann::ordered_json json = run_json(setup(), run_with_poses());
  EXPECT_TRUE(json["pose_first"].is_null());
  EXPECT_NEAR(json["pose"]["across_m"].get<double>(), 0.005, 1e-6);
  EXPECT_EQ(json["pose"]["verified"], 1.0);
  EXPECT_TRUE(run_json(setup(), two_sequences())["pose"].is_null());
}

TEST(RunPage, ShowsThePosesWhereThereAreAny) {
  EXPECT_TRUE(run_poses_table(run_report(setup(), two_sequences())).rows.empty());
  EXPECT_EQ(run_page(run_report(setup(), two_sequences())).find("registered pose"), std::string::npos);
  const RunReport report = run_report(setup(), run_with_poses());
  const DataTable table = run_poses_table(report);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][1].text, "-") << "the first frames have none";
  const std::string page = run_page(report);
  for (const char* part :
       {"registered pose", "0.573°", "5.0 mm", "10.0 mm", "1.000°/s", "3.0 mm/s",
        "Attitude of the registered pose", "Position of the registered pose", "Verified poses"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  const std::vector<std::string> svgs = svgs_of(page);
  EXPECT_EQ(svgs.size(), svgs_of(run_page(run_report(setup(), two_sequences()))).size() + 3);
  for (const std::string& svg : svgs) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
  }
}

TEST(RunReport, CountsWarningsAndErrorsByEvent) {
  SilRunResult warned = two_sequences();
  const hal::Event from_future{0, hal::EventId::kFrameFromFuture, hal::Severity::kWarning, {}};
  const hal::Event accepted{0, hal::EventId::kCommandAccepted, hal::Severity::kInformation, {}};
  warned.steps[1].events = {from_future, accepted};
  warned.steps[3].events = {from_future};
  const RunReport report = run_report(setup(), warned);
  const auto& facts = report.facts.back().facts;
  ASSERT_EQ(facts.size(), 1U);
  EXPECT_EQ(facts[0].first, "frame from the future (event 34)");
  EXPECT_EQ(facts[0].second, "2 times, first in step 1");
}

// Verifies TS-SIL-390.
TEST(RunReport, IsModuloTheSymmetryOfTheTargetAndWithoutThePapersFigures) {
  SilRunResult quarter = two_sequences();
  for (StepResult& step : quarter.steps) step.attitude.q_lrf_trf = {759250125, 0, 0, 759250125};
  SilRunSetup symmetric = setup();
  EXPECT_TRUE(run_report(symmetric, quarter).paper.rcnn.has_value());
  EXPECT_EQ(run_json(symmetric, quarter).count("symmetry"), 0U);
  symmetric.symmetry = target_symmetry_from({"z:4"});
  const RunReport report = run_report(symmetric, quarter);
  EXPECT_FALSE(report.paper.rcnn.has_value());
  EXPECT_EQ(mostly_wrong_text(report), "");
  EXPECT_NE(run_page(report).find("Errors modulo the symmetry of the target: 1/4 turn about z."),
            std::string::npos);
  const nlohmann::ordered_json json = run_json(symmetric, quarter);
  EXPECT_EQ(json.at("symmetry"), "1/4 turn about z");
  EXPECT_LT(json.at("rcnn").at("mean_deg").get<double>(), 1e-3);
}

// Verifies TS-SIL-380.
TEST(RunReport, SaysFirstThatTheAttitudesAreMostlyWrong) {
  SilRunResult quarter = two_sequences();
  for (StepResult& step : quarter.steps) step.attitude.q_lrf_trf = {759250125, 0, 0, 759250125};
  SilRunSetup wrong = setup();
  EXPECT_EQ(run_page(run_report(wrong, two_sequences())).find("does not know the attitude"),
            std::string::npos);
  EXPECT_NE(run_page(run_report(wrong, quarter))
                .find("<p class=lead>The network does not know the attitude of NEAR Shoemaker in these "
                      "frames. 100 % of the attitudes are more than 20° off"),
            std::string::npos);
  wrong.effects.sphere = 1.0;
  EXPECT_EQ(mostly_wrong_text(run_report(wrong, quarter)), "") << "it is not the target";
}

TEST(RunReport, CarriesPicturesAndSettings) {
  SilRunResult recorded = two_sequences();
  gnc::RangeImage frame;
  frame.rays = 128;
  frame.fov_urad = 140'000;
  for (int i = 0; i < 400; ++i) frame.ranges[8000 + i] = static_cast<std::uint16_t>(6400 + i % 7);
  recorded.pictures = {{1, frame}, {99, frame}};
  SilRunSetup described = setup();
  described.projection = {7000, 3800};
  described.model_path = "models/some.tsm";
  described.remarks = {"another swath"};
  const RunReport report = run_report(described, recorded);
  ASSERT_EQ(report.pictures.size(), 1U);
  EXPECT_EQ(report.pictures[0].frame, 1U);
  EXPECT_EQ(report.setup.remarks, std::vector<std::string>{"another swath"});
  EXPECT_NE(run_page(report).find("some.tsm"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
