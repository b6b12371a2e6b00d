// What init() finds in the banks, and what the first step reports.
// Verifies TS-MODE-020, TS-MODE-030, TS-MDL-010.
#include <string>

#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Boot : public AppFixture {
 protected:
  Boot() { store.fill(test_model_image()); }
  void spoil(std::size_t bank) { store.banks[bank].memory[0] ^= 1; }
};

TEST_F(Boot, GoodBanksLeadToRunWithASecondCopy) {
  EXPECT_EQ(app->mode(), Mode::kBoot);
  init(store);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kOk);
  EXPECT_EQ(app->boot_status(1), gnc::ModelStatus::kOk);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(events(EventId::kModelActivated), 1);
  EXPECT_EQ(argument(EventId::kModelActivated, 0),
            static_cast<std::int32_t>(gnc::kModelImageSize<gnc::FixedPoint>));
  EXPECT_EQ(argument(EventId::kModelActivated, 1), 0);
  EXPECT_EQ(out->telemetry.second_copy, 1U);
  EXPECT_EQ(out->telemetry.bank_crc32[0], app->estimator().model().crc32);
  EXPECT_EQ(out->telemetry.bank_crc32[1], app->estimator().model().crc32);
  step_good();
  EXPECT_EQ(events(EventId::kModelActivated), 0) << "reported once only";
}

TEST_F(Boot, DamagedFirstBankFallsBackToTheSecondOne) {
  spoil(0);
  init(store);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kBadMagic);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(argument(EventId::kModelRefused, 0), static_cast<int>(gnc::ModelStatus::kBadMagic));
  EXPECT_EQ(argument(EventId::kModelRefused, 2), 0);
  EXPECT_EQ(argument(EventId::kModelActivated, 1), 1);
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(out->telemetry.second_copy, 0);
}

TEST_F(Boot, DamagedSecondBankIsReportedAndIsNoSecondCopy) {
  spoil(1);
  init(store);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(argument(EventId::kModelRefused, 2), 1);
  EXPECT_EQ(out->telemetry.second_copy, 0);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
}

TEST_F(Boot, AnotherModelInTheSecondBankIsKeptAsFallback) {
  store.banks[1].memory = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init(store);
  step_good();
  EXPECT_EQ(out->telemetry.second_copy, 0);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  EXPECT_EQ(events(EventId::kModelRefused), 0);
}

TEST_F(Boot, NoSecondBankIsNoError) {
  store.banks[1] = {};
  init(store);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(events(EventId::kModelRefused), 0);
}

TEST_F(Boot, EmptyFirstBankIsReportedEvenIfTheSecondOneIsGood) {
  store.banks[0] = {};
  init(store);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(events(EventId::kModelRefused), 1);
  EXPECT_EQ(argument(EventId::kModelRefused, 2), 0);
  EXPECT_EQ(argument(EventId::kModelActivated, 1), 1);
}

TEST_F(Boot, FirstCycleMayHaveAnyTime) {
  for (const std::int64_t first_ns : {std::int64_t{0}, std::int64_t{-1'000'000'000'000}}) {
    init(store);
    now_ns = first_ns - config::kFramePeriod_ns;
    step_good();
    EXPECT_EQ(validity(), Validity::kValid) << first_ns;
    EXPECT_EQ(events(EventId::kCycleTimeNotAdvancing), 0) << first_ns;
  }
}

TEST_F(Boot, WithoutAModelTheModeIsSafeWithItsCause) {
  spoil(0);
  spoil(1);
  init(store);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(events(EventId::kModelRefused), 2);
  EXPECT_EQ(events(EventId::kModelActivated), 0);
  EXPECT_EQ(argument(EventId::kSafeEntered, 0), static_cast<int>(Cause::kNoModel));
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kNoModel);
  EXPECT_EQ(event(EventId::kModelRefused)->severity, Severity::kError);
  step_commands({set_mode(Mode::kRun)});
  EXPECT_EQ(events(EventId::kCommandWrongMode), 1) << "the mode is checked before the model";
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(events(EventId::kCommandNoModel), 1);
}

TEST_F(Boot, WithoutAModelFaultsStillEnd) {
  spoil(0);
  spoil(1);
  init(store);
  StepInputs late;
  late.cycle_slips = 1;
  for (int cycle = 0; cycle < 3; ++cycle) step(late);
  EXPECT_EQ(out->telemetry.faults_persisting, bit_of(Fault::kSlip)) << "no model was lost";
  for (int cycle = 0; cycle < 3; ++cycle) step(StepInputs{});
  EXPECT_EQ(out->telemetry.faults_persisting, 0U);
}

TEST_F(Boot, EmptyBanksOrAnotherTargetLeadToSafe) {
  hal::fake::FakeModelStore empty;
  init(empty);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kTooShort);
  init(store, "another_craft");
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kBadTarget);
  init(store);
  EXPECT_EQ(app->mode(), Mode::kRun) << "every init() boots again";
}

TEST_F(Boot, TargetIsComparedToTheEndOfItsName) {
  init(store, "test_craft_2");
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kBadTarget);
  init(store, std::string(100, 'x').c_str());
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kBadTarget);
  std::vector<std::uint8_t> image(gnc::kModelImageSize<gnc::FixedPoint>);
  gnc::NetworkWeights<gnc::FixedPoint> weights;
  gnc::ModelHeader header;
  ASSERT_EQ(gnc::read_model_image<gnc::FixedPoint>(test_model_image().data(), test_model_image().size(),
                                                   nullptr, header, weights),
            gnc::ModelStatus::kOk);
  const std::string longest(header.target.size() - 1, 'x');
  ASSERT_TRUE(gnc::set_target(header, longest.c_str()));
  ASSERT_EQ(gnc::write_model_image(header, weights, image.data(), image.size()), image.size());
  store.fill(image);
  init(store, longest.c_str());
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kOk);
  for (const std::size_t more : {1U, 2U, 70U}) {
    init(store, (longest + std::string(more, 'x')).c_str());
    EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kBadTarget) << "the name goes on by " << more;
  }
  init(store, nullptr);
  EXPECT_EQ(app->boot_status(0), gnc::ModelStatus::kOk) << "any target";
}

TEST_F(Boot, PlatformWithoutStopwatchOrBanksIsABugOfTheCaller) {
  app->init({&stopwatch, nullptr, nullptr}, nullptr);
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(events(EventId::kAssertion), 1);
  app->init({nullptr, &store, nullptr}, nullptr);
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_FALSE(out->duties_done);
}

TEST_F(Boot, StepBeforeInitIsABugOfTheCaller) {
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(events(EventId::kAssertion), 1);
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kAssertion);
}

}  // namespace
}  // namespace tumblesight::fsw
