// What the console knows of a run is what the bus said, in whatever order it came.
#include "sim/console/step_log.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "hal/dds/idl/hello.hpp"
#include "sim/console/step_json.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kRun = 7;

hal::dds::HelloSample hello_of(std::uint32_t run_id) {
  hal::dds::HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(hal::dds::Role::kSimulator);
  hello.run_id = run_id;
  hal::dds::set_target(hello, "near_shoemaker");
  return hello;
}
template <class Sample>
Sample sample_of(std::uint32_t k, std::uint32_t run_id = kRun) {
  Sample sample{};
  sample.run_id = run_id;
  sample.k = k;
  return sample;
}
hal::dds::AttitudeSample attitude_of(std::uint32_t k) {
  auto sample = sample_of<hal::dds::AttitudeSample>(k);
  sample.time_ns = 2'700'000'000 * (k + 1LL);
  sample.q_lrf_trf[0] = sample.pose_q_lrf_trf[0] = sample.q_lrf_trf_second[0] = 1 << 30;
  sample.predicted_error_urad = 17'453;
  sample.pose_origin_lrf_um[1] = 30'000'000;
  return sample;
}
hal::dds::StepDoneSample done_of(std::uint32_t k, std::uint8_t events = 0) {
  auto done = sample_of<hal::dds::StepDoneSample>(k);
  done.attitudes = done.telemetries = 1;
  done.events = events;
  return done;
}
// Turned by 60 degrees about the boresight.
hal::dds::TruthSample truth_of(std::uint32_t k) {
  auto truth = sample_of<hal::dds::TruthSample>(k);
  truth.q_lrf_trf[0] = std::sqrt(0.75F);
  truth.q_lrf_trf[2] = 0.5F;
  truth.range_m = 31.0F;
  return truth;
}

class Log : public testing::Test {
 protected:
  Log() { log_.add(hello_of(kRun)); }
  void add_step(std::uint32_t k) {
    log_.add(attitude_of(k));
    log_.add(sample_of<hal::dds::TelemetrySample>(k));
    log_.add(done_of(k));
  }
  // The number of a field in a row.
  static Json value(const Json& row, const std::string& field) {
    const Json fields = row_fields();
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (fields[i] == field) return row[i];
    ADD_FAILURE() << field;
    return nullptr;
  }
  StepLog log_;
};

TEST_F(Log, HasAStepAsSoonAsAllOfItHasCome) {
  log_.add(done_of(0, 1));
  log_.add(sample_of<hal::dds::TelemetrySample>(0));
  log_.add(attitude_of(0));
  EXPECT_EQ(log_.state().steps, 0U);
  log_.add(sample_of<hal::dds::EventSample>(0));
  EXPECT_EQ(log_.state().steps, 1U);
  EXPECT_EQ(log_.rows(0)["events"].size(), 1U);
}

// Its topics have no order among each other.
TEST_F(Log, AStepWaitsForItsTruthIfTheRunHasOne) {
  log_.add(truth_of(0));
  add_step(0);
  add_step(1);
  EXPECT_EQ(log_.state().steps, 1U);
  log_.add(truth_of(1));
  EXPECT_EQ(log_.state().steps, 2U);
  EXPECT_FALSE(value(log_.rows(1)["rows"][0], "network_error_deg").is_null());
}

TEST_F(Log, TheTruthOfTheFirstStepMayComeAfterIt) {
  add_step(0);
  EXPECT_EQ(log_.state().steps, 1U);
  log_.add(truth_of(0));
  EXPECT_FALSE(value(log_.rows(0)["rows"][0], "network_error_deg").is_null());
}

// A page that asks for the frame of a step as soon as it knows the step must get it.
TEST_F(Log, AStepWaitsForItsFrames) {
  const auto add_announced = [this](std::uint32_t k, std::uint8_t frames) {
    auto announced = sample_of<hal::dds::StepSample>(k);
    announced.frames = frames;
    log_.add(announced);
    add_step(k);
  };
  const auto frame = std::make_unique<hal::dds::LidarFrameSample>(sample_of<hal::dds::LidarFrameSample>(0));
  add_announced(0, 1);
  EXPECT_EQ(log_.state().steps, 1U) << "a late console may never get the first one";
  log_.add(*frame);
  frame->k = 1;
  add_announced(1, 2);
  EXPECT_EQ(log_.state().steps, 1U) << "but the run has frames";
  log_.add(*frame);
  EXPECT_EQ(log_.state().steps, 1U);
  log_.add(*frame);
  EXPECT_EQ(log_.state().steps, 2U);
  add_announced(2, 0);
  EXPECT_EQ(log_.state().steps, 3U) << "a step without a frame waits for none";
}

// The answers of a step may be read before its command: a page that shows the step has no second look at it.
TEST_F(Log, AStepWaitsForItsCommands) {
  auto announced = sample_of<hal::dds::StepSample>(0);
  announced.commands = 2;
  log_.add(announced);
  add_step(0);
  EXPECT_EQ(log_.state().steps, 0U);
  const auto command = sample_of<hal::dds::CommandSample>(0);
  log_.add(command);
  EXPECT_EQ(log_.state().steps, 0U);
  log_.add(command);
  EXPECT_EQ(log_.state().steps, 1U);
  EXPECT_EQ(log_.rows(0)["commands"].size(), 2U);
}

TEST_F(Log, ALateConsoleDoesNotWaitForTheCommandsOfItsFirstStep) {
  auto announced = sample_of<hal::dds::StepSample>(40);
  announced.commands = 1;
  log_.add(announced);
  add_step(40);
  EXPECT_EQ(log_.state().steps, 1U);
}

TEST_F(Log, ACommandThatIsLostDelaysItsStepByFourOthers) {
  for (std::uint32_t k = 0; k <= 4; ++k) {
    EXPECT_EQ(log_.state().steps, 0U);
    auto announced = sample_of<hal::dds::StepSample>(k);
    announced.commands = k == 0 ? 1 : 0;
    log_.add(announced);
    add_step(k);
  }
  EXPECT_EQ(log_.state().steps, 5U);
  EXPECT_TRUE(log_.rows(0)["commands"].empty());
}

TEST_F(Log, RowsHaveANumberOrNullForEachField) {
  log_.add(truth_of(0));
  add_step(0);
  add_step(1);
  log_.end();
  const Json rows = log_.rows(0)["rows"];
  ASSERT_EQ(rows.size(), 2U);
  for (const Json& row : rows) ASSERT_EQ(row.size(), row_fields().size());
  EXPECT_NEAR(value(rows[0], "network_error_deg").get<double>(), 60.0, 1e-4);
  EXPECT_NEAR(value(rows[0], "network_expected_deg").get<double>(), 1.0, 1e-4);
  EXPECT_NEAR(value(rows[0], "true_range_m").get<double>(), 31.0, 1e-4);
  EXPECT_NEAR(value(rows[0], "pose_range_m").get<double>(), 30.0, 1e-9);
  EXPECT_EQ(value(rows[0], "verified"), 1);
  EXPECT_TRUE(value(rows[1], "network_error_deg").is_null());
  EXPECT_NEAR(value(rows[1], "t_s").get<double>(), 2.7, 1e-9);
}

TEST_F(Log, AStepWhoseSampleIsLostIsShownWhenOthersFollow) {
  log_.add(attitude_of(0));
  for (std::uint32_t k = 1; k <= 4; ++k) add_step(k);
  EXPECT_EQ(log_.state().steps, 5U);
  EXPECT_TRUE(value(log_.rows(0)["rows"][0], "cycle_ms").is_null());
}

TEST_F(Log, AStepThatIsOnlyAnnouncedIsNone) {
  log_.add(sample_of<hal::dds::StepSample>(0));
  log_.end();
  EXPECT_EQ(log_.state().steps, 0U);
  EXPECT_TRUE(log_.state().has_ended);
}

TEST_F(Log, ACommandIsAcceptedOrRefusedByTheCounters) {
  add_step(0);
  auto command = sample_of<hal::dds::CommandSample>(1);
  command.size = 8 + 1 + 24;
  command.bytes[6] = 3;
  command.bytes[8] = 2;
  log_.add(command);
  auto telemetry = sample_of<hal::dds::TelemetrySample>(1);
  telemetry.commands_accepted = 1;
  log_.add(telemetry);
  log_.add(attitude_of(1));
  log_.add(done_of(1));
  command.k = telemetry.k = 2;
  command.bytes[6] = 99;
  telemetry.commands_refused = 1;
  log_.add(command);
  log_.add(telemetry);
  log_.add(attitude_of(2));
  log_.add(done_of(2));
  const Json commands = log_.rows(0)["commands"];
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(commands[0], Json({1, 2.7, "SET_MODE 2", "accepted"}));
  EXPECT_EQ(commands[1][2], "FUNCTION 99 2");
  EXPECT_EQ(commands[1][3], "refused");
}

// RESET_COUNTERS after a refused one.
TEST_F(Log, ACommandThatResetsTheCountersIsAccepted) {
  auto telemetry = sample_of<hal::dds::TelemetrySample>(0);
  telemetry.commands_accepted = 1;
  telemetry.commands_refused = 4;
  log_.add(attitude_of(0));
  log_.add(telemetry);
  log_.add(done_of(0));
  auto command = sample_of<hal::dds::CommandSample>(1);
  command.size = 20;
  log_.add(command);
  telemetry = sample_of<hal::dds::TelemetrySample>(1);
  telemetry.commands_accepted = 1;
  log_.add(attitude_of(1));
  log_.add(telemetry);
  log_.add(done_of(1));
  EXPECT_EQ(log_.rows(0)["commands"][0][3], "accepted");
}

// What came before it is not known.
TEST_F(Log, OfACommandInTheFirstStepThatALateConsoleSeesOnlyThatItWasSent) {
  auto command = sample_of<hal::dds::CommandSample>(50);
  command.size = 20;
  log_.add(command);
  auto telemetry = sample_of<hal::dds::TelemetrySample>(50);
  telemetry.commands_refused = 4;
  log_.add(attitude_of(50));
  log_.add(telemetry);
  log_.add(done_of(50));
  EXPECT_EQ(log_.rows(0)["commands"][0][3], "sent");
}

// A frame that was delivered a step late: the truth is that of its exposure.
TEST_F(Log, AnErrorIsToTheTruthAtTheExposure) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    auto truth = truth_of(k);
    truth.time_ns = 2'700'000'000 * (k + 1LL);
    if (k == 1) truth.q_lrf_trf[0] = 1.0F, truth.q_lrf_trf[2] = 0.0F;
    log_.add(truth);
    auto attitude = attitude_of(k);
    attitude.exposure_time_ns = k == 2 ? 2 * 2'700'000'000LL : attitude.time_ns;
    log_.add(attitude);
    log_.add(sample_of<hal::dds::TelemetrySample>(k));
    log_.add(done_of(k));
  }
  const Json rows = log_.rows(0)["rows"];
  EXPECT_NEAR(value(rows[0], "network_error_deg").get<double>(), 60.0, 1e-3);
  EXPECT_NEAR(value(rows[1], "network_error_deg").get<double>(), 0.0, 1e-3);
  EXPECT_NEAR(value(rows[2], "network_error_deg").get<double>(), 0.0, 1e-3);
}

TEST_F(Log, AnErrorIsNotKnownWithoutATruthAtTheExposure) {
  auto truth = truth_of(0);
  truth.time_ns = 5;
  log_.add(truth);
  add_step(0);
  EXPECT_TRUE(value(log_.rows(0)["rows"][0], "network_error_deg").is_null());
  EXPECT_EQ(value(log_.rows(0)["rows"][0], "true_range_m"), 31.0);
}

// The cycle of a flight program on its own timer has another time than the frame.
TEST_F(Log, AStepHasTheTimeThatTheSimulatorGaveIt) {
  auto step = sample_of<hal::dds::StepSample>(0);
  step.time_ns = 1000;
  log_.add(step);
  add_step(0);
  EXPECT_EQ(log_.time_ns_of(0), 1000);
}

TEST_F(Log, FramesThatNoFlightProgramSeesAreStepsToo) {
  StepLog log;
  log.expect_no_answers();
  log.add(hello_of(kRun));
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (k != 1) log.add(truth_of(k));  // a pause has none
    log.add(sample_of<hal::dds::StepSample>(k));
  }
  log.end();
  ASSERT_EQ(log.state().steps, 3U);
  EXPECT_EQ(value(log.rows(0)["rows"][0], "true_range_m"), 31.0);
  EXPECT_TRUE(value(log.rows(0)["rows"][0], "network_error_deg").is_null());
}

TEST_F(Log, ALaterRunTakesThePlaceOfTheOneBefore) {
  add_step(0);
  log_.add(hello_of(kRun));
  EXPECT_EQ(log_.state().steps, 1U);
  log_.end();
  log_.add(hello_of(8));
  EXPECT_EQ(log_.state().steps, 0U);
  EXPECT_FALSE(log_.state().has_ended);
  log_.add(attitude_of(0));  // of the run before
  log_.end();
  EXPECT_EQ(log_.state().steps, 0U);
}

TEST_F(Log, ALateConsoleNumbersItsStepsFromZero) {
  for (std::uint32_t k = 40; k < 45; ++k) add_step(k);
  EXPECT_EQ(log_.state().steps, 5U);
  EXPECT_EQ(log_.k_of(2), 42);
  EXPECT_EQ(log_.number_of(44), 4U);
  EXPECT_EQ(log_.k_of(5), -1);
}

TEST_F(Log, RowsBeginWhereTheyAreAskedFor) {
  for (std::uint32_t k = 0; k < 10; ++k) add_step(k);
  const Json rows = log_.rows(7);
  EXPECT_EQ(rows["from"], 7);
  EXPECT_EQ(rows["to"], 10);
  EXPECT_EQ(rows["rows"].size(), 3U);
  EXPECT_EQ(rows["rows"][0][0], 7);
  EXPECT_TRUE(log_.rows(100)["rows"].empty());
  EXPECT_TRUE(log_.step(10).is_null());
}

// A console that stood still, or came late.
TEST_F(Log, ARowAndADetailHaveTheRunsOwnNumberOfTheStep) {
  for (const std::uint32_t k : {0U, 1U, 28U}) add_step(k);
  log_.add(attitude_of(29));  // without telemetry
  log_.end();
  const Json rows = log_.rows(0)["rows"];
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& [number, k] : {std::pair{0, 0}, {1, 1}, {2, 28}, {3, 29}}) {
    EXPECT_EQ(value(rows[number], "k"), number);
    EXPECT_EQ(value(rows[number], "step"), k);
    EXPECT_EQ(log_.step(static_cast<std::uint64_t>(number))["step"], k);
  }
}

TEST_F(Log, ADetailHasTheAttitudesThePoseAndEveryCounter) {
  log_.add(truth_of(0));
  auto attitude = attitude_of(0);
  attitude.pose_doubts = hal::kPoseDoubtAmbiguous;
  attitude.second_odds_ppm = 250'000;
  log_.add(attitude);
  auto telemetry = sample_of<hal::dds::TelemetrySample>(0);
  telemetry.mode = static_cast<std::uint8_t>(hal::Mode::kSafe);
  telemetry.faults_persisting = 1U << static_cast<int>(hal::Fault::kFrameFrozen);
  telemetry.cycles = 12;
  log_.add(telemetry);
  log_.add(done_of(0));
  const Json step = log_.step(0);
  EXPECT_EQ(step["pose"]["doubts"][0], "other attitudes are not ruled out");
  EXPECT_NEAR(step["second"]["odds"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(step["telemetry"]["cycles"], 12);
  bool has_mode = false, has_fault = false;
  for (const Json& light : step["lights"]) {
    has_mode |= light["name"] == "mode" && light["text"] == "SAFE" && light["state"] == "alarm";
    has_fault |= light["name"] == "faults" && light["text"] == "FRAME_FROZEN";
  }
  EXPECT_TRUE(has_mode);
  EXPECT_TRUE(has_fault);
}

}  // namespace
}  // namespace tumblesight::sim
