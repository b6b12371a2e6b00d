// Bit flips between two cycles, in all memory that is kept from cycle to cycle.
#include <algorithm>
#include <cstddef>
#include <random>

#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

bool is_allowed(std::size_t field, std::uint32_t value) {
  ParameterTable table = kInitialTable;
  table.fields[field] = value;
  return first_wrong_field(table) == kTableFields;
}

class MemoryScrubberTest : public AppFixture {
 protected:
  MemoryScrubberTest() {
    init_with_model();
    step_good();
    step_good();
  }
  // The attitude of an undisturbed application, the twin, after the frames so far and the next one. It never
  // gets the frames that were passed over.
  gnc::QuaternionQ30 undisturbed_next() {
    if (twin == nullptr) {
      twin = std::make_unique<AttitudeInitApp>();
      twin_models.fill(test_model_image());
      boot(*twin, {&stopwatch, &twin_models, &kTestKeys, nullptr, hal::ResetCause::kPowerOn});
      twin_sequence_number = 100;
    }
    auto twin_out = std::make_unique<StepOutputs>();
    while (twin_sequence_number <= sequence_number) {
      const std::uint32_t number = ++twin_sequence_number;
      StepInputs inputs;
      const std::int64_t time_ns = kStart_ns + (number - 100) * config::kFramePeriod_ns;
      const gnc::RangeImage frame = good_frame(number, time_ns, number - 1);
      if (std::find(passed_over.begin(), passed_over.end(), number) == passed_over.end())
        inputs.frame = &frame;
      twin->step(time_ns, inputs, *twin_out);
    }
    return twin_out->attitude.q_lrf_trf;
  }
  void expect_undisturbed_step() {
    const gnc::QuaternionQ30 expected = undisturbed_next();
    step_good();
    EXPECT_EQ(validity(), Validity::kValid);
    EXPECT_EQ(out->attitude.q_lrf_trf, expected);
  }
  // No attitude in `cycles` cycles, in each of which one repair is made; then the attitudes of an application
  // that has only lost the frames of these cycles.
  void expect_repaired_after(int cycles) {
    const hal::Telemetry before = AppMemory::state(*app).counters;
    const auto repairs = [](const hal::Telemetry& h) {
      return h.constants_reloaded + h.model_tables_rebuilt;
    };
    for (int i = 1; i <= cycles; ++i) {
      const std::uint32_t repairs_before = repairs(AppMemory::state(*app).counters);
      step_good();
      passed_over.push_back(sequence_number);
      EXPECT_EQ(validity(), Validity::kPassedOver);
      EXPECT_EQ(out->telemetry.long_task, 1);
      EXPECT_GT(repairs(out->telemetry), repairs_before);
      EXPECT_EQ(out->telemetry.frames_passed_over, before.frames_passed_over + static_cast<std::uint32_t>(i));
    }
    expect_undisturbed_step();
    EXPECT_EQ(out->telemetry.long_task, 0);
    EXPECT_EQ(out->telemetry.frames_refused, before.frames_refused);
    EXPECT_EQ(out->telemetry.sequence_gaps, before.sequence_gaps) << "the frames did arrive";
    EXPECT_EQ(app->mode(), Mode::kRun);
  }
  // Steps until every block has been checked once.
  void steps_of_a_pass(bool with_frames = true) {
    constexpr std::uint32_t kBlocks = ModelBanks::kBlocks;
    for (std::uint32_t block = 0; block <= kBlocks;
         block += AppMemory::state(*app).table[Parameter::kScrubBlocks]) {
      if (with_frames) {
        step_good();
      } else {
        step(StepInputs{});
      }
    }
  }
  // Flips a bit that is not padding.
  void flip_a_constant() {
    const std::uint32_t before = app->estimator().constants_crc32();
    const Region region = AppMemory::constants(*app);
    for (std::size_t bit = 8 * 300; app->estimator().constants_crc32() == before; ++bit) region.flip(bit);
  }
  std::vector<std::uint8_t>& bank(std::size_t index) { return store.banks[index].memory; }
  void hit_block(std::size_t index, std::size_t block) {
    bank(index)[block * config::kModelBlockBytes + 9] ^= 1;
  }
  // Detected in the next cycle.
  void hit_table(std::size_t index = 0) {
    AppMemory::scrubber(*app).flip(8 * (index * sizeof(ModelBanks) / 2 + 40));
  }

  std::vector<std::uint32_t> passed_over;  // sequence numbers
  std::unique_ptr<AttitudeInitApp> twin;   // of the application since its start, or nullptr
  hal::fake::FakeModelStore twin_models;
  std::uint32_t twin_sequence_number = 0;  // of the last frame that the twin has had, or passed over
};

// Verifies TS-FDIR-010.
TEST_F(MemoryScrubberTest, FlippedBitsOfTheRedundantStateAreOutvotedAndCounted) {
  const Region region = AppMemory::redundant_state(*app);
  std::mt19937 engine(1);
  std::uint32_t corrections = 0;
  for (int i = 0; i < 30; ++i) {
    region.flip(engine() % (8 * region.size));
    expect_undisturbed_step();
    EXPECT_TRUE(events(EventId::kMemoryCorrected) == 1 || out->telemetry.events_suppressed > 0);
    EXPECT_EQ(out->telemetry.memory_corrections, ++corrections);
    EXPECT_EQ(app->mode(), Mode::kRun);
  }
  EXPECT_EQ(out->telemetry.frames_used, 32U) << "no counter is lost";
}

// Verifies TS-FDIR-020.
TEST_F(MemoryScrubberTest, FlippedBitsOfTheEstimatorsStateAreRestoredFromTheCopy) {
  std::mt19937 engine(2);
  std::uint32_t restored = 0;
  for (int i = 0; i < 20; ++i) {
    AppMemory::flip_state_bit(*app, engine() % AppMemory::kStateBits);
    const bool seen = estimator_crc() != AppMemory::state(*app).estimator_crc32;  // padding does not count
    expect_undisturbed_step();
    restored += seen ? 1U : 0U;
    EXPECT_EQ(out->telemetry.states_restored, restored);
  }
  EXPECT_GT(restored, 10U);
  EXPECT_EQ(out->telemetry.states_lost, 0U);
}

// Verifies TS-FDIR-020.
TEST_F(MemoryScrubberTest, StateAndCopyHitTogetherStartANewSequence) {
  AppMemory::flip_state_bit(*app, 5);
  const Region scrubber = AppMemory::scrubber(*app);
  constexpr std::size_t kStateBytes = AppMemory::kStateBits / 8;
  scrubber.flip(8 * (scrubber.size - kStateBytes) + 5);  // the copy is its last member
  step_good();
  EXPECT_EQ(out->telemetry.states_lost, 1U);
  EXPECT_EQ(argument(EventId::kEstimatorResetByFault, 0), static_cast<int>(Fault::kStateLost));
  EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kResetSequence));
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(events(EventId::kFaultOver), 1);
}

// Verifies TS-FDIR-030, TS-FDIR-190.
TEST_F(MemoryScrubberTest, FlippedBitsOfBiasesShiftsAndPointersAreReloadedFromTheBank) {
  const Region region = AppMemory::constants(*app);
  std::mt19937 engine(3);
  std::uint32_t reloaded = 0;
  for (int i = 0; i < 20; ++i) {
    region.flip(engine() % (8 * region.size));
    const bool seen =
        app->estimator().constants_crc32() != AppMemory::state(*app).constants_crc32;  // no padding
    expect_repaired_after(seen ? 1 : 0);
    reloaded += seen ? 1U : 0U;
    EXPECT_EQ(out->telemetry.constants_reloaded, reloaded);
  }
  EXPECT_GT(reloaded, 15U);
}

// Verifies TS-FDIR-040.
TEST_F(MemoryScrubberTest, FlippedWeightIsRepairedFromTheSecondCopyWithinAPass) {
  bank(0)[700'000] ^= 0x10;
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 1U);
  EXPECT_EQ(bank(0), bank(1));
  EXPECT_EQ(bank(0), test_model_image());
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_GE(out->telemetry.model_passes, 1U);
}

// Verifies TS-FDIR-040.
TEST_F(MemoryScrubberTest, FlippedBitOfTheSecondCopyIsRepairedFromTheBankInUse) {
  bank(1).back() ^= 0x80;
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 1U);
  EXPECT_EQ(bank(1), test_model_image());
}

// Verifies TS-FDIR-047.
TEST_F(MemoryScrubberTest, CorruptedReadOnlySecondCopyIsReportedAsLost) {
  store.banks[1].writable = false;
  bank(1)[0] ^= 1;
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 0U);
  EXPECT_EQ(out->telemetry.model_blocks_lost, 1U);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(out->telemetry.second_copy, 0U);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-FDIR-047.
TEST_F(MemoryScrubberTest, CorruptedFallbackIsReportedWithinAPassAndNotUsed) {
  bank(1) = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init(store);
  step_good();
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood) << "checked against its own table";
  hit_block(1, 150);
  int reports = 0;
  for (std::uint32_t block = 0; block <= ModelBanks::kBlocks;
       block += AppMemory::state(*app).table[Parameter::kScrubBlocks]) {
    step_good();
    reports += events(EventId::kFallbackLost);
    if (events(EventId::kFallbackLost) == 0) continue;
    EXPECT_EQ(argument(EventId::kFallbackLost, 0), 1);
    EXPECT_EQ(argument(EventId::kModelBlockLost, 1), 150);
  }
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(out->telemetry.faults_persisting, 0U) << "the model in use is good";
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-FDIR-047.
TEST_F(MemoryScrubberTest, ModelThatIsNoLongerInUseStaysAFallbackThatIsChecked) {
  const std::vector<std::uint8_t>& other = gnc::lasting_model_image<gnc::FixedPoint>(8);
  bank(1) = other;
  init(store);
  std::vector<std::uint8_t> arguments;
  append_u32(arguments, gnc::model_image_crc32(other.data()));
  step_commands(
      {set_mode(Mode::kStandby), command(FunctionCode::kModelActivate, arguments), set_mode(Mode::kRun)});
  ASSERT_EQ(out->telemetry.bank_in_use, 1U);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.bank_status[0], BankStatus::kGood);
  hit_block(0, 7);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.bank_status[0], BankStatus::kEmpty);
}

// Verifies TS-FDIR-040, TS-FDIR-047.
TEST_F(MemoryScrubberTest, FlippedBitOfTheFallbacksTableIsRepairedUnlessTheFallbackIsLostToo) {
  bank(1) = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init(store);
  step_good();
  hit_table(1);
  step_good();
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 1U);
  EXPECT_EQ(argument(EventId::kModelTableRebuilt, 0), 1);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  hit_block(1, 200);
  hit_table(1);
  step_good();
  EXPECT_EQ(argument(EventId::kFallbackLost, 0), 1);
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 1U);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-FDIR-015. The vote cannot correct the same bit in two copies.
TEST_F(MemoryScrubberTest, ModeThatIsNoneGoesSafe) {
  for (const int number : {4, 32, 255}) {
    init(store);
    step_good();
    AppMemory::state(*app).mode = static_cast<Mode>(number);
    AppMemory::commit(*app);
    command_counter = 0;
    step_commands({command(FunctionCode::kNoop)});
    EXPECT_EQ(app->mode(), Mode::kSafe) << number;
    EXPECT_EQ(out->telemetry.safe_cause, Cause::kFault);
    EXPECT_EQ(out->telemetry.safe_fault, Fault::kStateLost);
    EXPECT_EQ(events(EventId::kSafeEntered), 1);
    EXPECT_EQ(events(EventId::kCommandAccepted), 1) << "SAFE accepts commands";
  }
}

// Verifies TS-FDIR-015.
TEST_F(MemoryScrubberTest, IndicesOutOfRangeAreBoundedAndGoSafe) {
  for (const std::uint32_t bank : {2U, 0x8000'0000U}) {
    init(store);
    step_good();
    AppMemory::state(*app).banks.in_use = bank;
    AppMemory::commit(*app);
    step_good();
    EXPECT_EQ(app->mode(), Mode::kSafe);
    EXPECT_EQ(out->telemetry.bank_in_use, 0U) << "the image that the estimator has loaded";
    EXPECT_EQ(out->telemetry.bank_status[0], BankStatus::kGood);
  }
  init(store);
  step_good();
  AppMemory::state(*app).banks.next_block = ModelBanks::kBlocks;
  AppMemory::commit(*app);
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.model_blocks_lost, 0U);
}

// Verifies TS-FDIR-015.
TEST_F(MemoryScrubberTest, FieldsOutOfRangeBecomeTheInitialOnesAndGoSafe) {
  for (std::size_t field = 0; field < kTableFields; ++field) {
    std::vector<std::uint32_t> wrong{UINT32_MAX};
    if (field < kParameters)
      wrong = {config::kParameterRules[field].lowest - 1, config::kParameterRules[field].highest + 1};
    for (const std::uint32_t value : wrong) {
      ASSERT_FALSE(is_allowed(field, value)) << field;
      init(store);
      step_good();
      std::uint32_t& now = AppMemory::state(*app).table.fields[field];
      now = value;
      AppMemory::commit(*app);
      step_good();
      EXPECT_EQ(app->mode(), Mode::kSafe);
      EXPECT_EQ(now, kInitialTable.fields[field]);
    }
  }
}

// Verifies TS-FDIR-015.
TEST_F(MemoryScrubberTest, TableWithEveryFieldOutOfRangeBecomesTheInitialOne) {
  AppMemory::state(*app).table.fields.fill(UINT32_MAX);
  AppMemory::commit(*app);
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(AppMemory::state(*app).table.fields, kInitialTable.fields);
}

// Verifies TS-FDIR-040.
TEST_F(MemoryScrubberTest, FlippedBitsOfTheTableAreRepaired) {
  const Region scrubber = AppMemory::scrubber(*app);
  scrubber.flip(8 * 40 + 3);
  expect_undisturbed_step();
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 1U);
  EXPECT_EQ(events(EventId::kModelTableRebuilt), 1);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 0U);
  EXPECT_EQ(bank(0), test_model_image());
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, SameBlockHitInBothBanksSwitchesOrGoesSafe) {
  bank(0)[700'000] ^= 0x10;
  bank(1)[700'001] ^= 0x10;
  for (int i = 0; i < 30 && app->mode() == Mode::kRun; ++i) step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kFault);
  EXPECT_EQ(out->telemetry.safe_fault, Fault::kModelCorrupted);
  EXPECT_EQ(events(EventId::kModelBlockLost), 1);
  EXPECT_EQ(events(EventId::kSafeEntered), 1);
  EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kSafe));
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "a damaged model does not run again";
  for (int i = 0; i < 5; ++i) {
    step(StepInputs{});
    EXPECT_EQ(events(EventId::kFaultOver), 0) << "the model is still lost";
    EXPECT_EQ(events(EventId::kFaultPersists), 0) << "one response";
    EXPECT_TRUE(out->telemetry.faults_persisting & bit_of(Fault::kModelCorrupted));
  }
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, DamagedModelWithoutSecondCopyFallsBackOnAnotherGoodOne) {
  const std::vector<std::uint8_t>& other = gnc::lasting_model_image<gnc::FixedPoint>(8);
  bank(1) = other;
  init(store);
  step_good();
  bank(0)[5'000] ^= 1;
  for (int i = 0; i < 30 && out->telemetry.bank_switches == 0; ++i) step_good();
  EXPECT_EQ(argument(EventId::kBankSwitched, 0), 0);
  EXPECT_EQ(argument(EventId::kBankSwitched, 1), 1);
  EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kSwitchBank));
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(app->estimator().model().crc32, gnc::model_image_crc32(other.data()));
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, HitReadOnlyBankWithoutSecondCopyLeadsToSafe) {
  store.banks[0].writable = false;
  store.banks[1] = {};
  init(store);
  step_good();
  bank(0)[5'000] ^= 1;
  for (int i = 0; i < 30 && app->mode() == Mode::kRun; ++i) step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-FDIR-040.
TEST_F(MemoryScrubberTest, TableAndModelHitTogetherAreRepairedFromTheSecondCopy) {
  hit_block(0, 200);
  hit_table();
  expect_undisturbed_step();
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 1U);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 1U);
  EXPECT_EQ(out->telemetry.bank_switches, 0U);
  EXPECT_EQ(bank(0), test_model_image());
}

// Verifies TS-FDIR-040, TS-FDIR-190. One repair in each cycle, whatever is hit.
TEST_F(MemoryScrubberTest, EveryCombinationOfTablesAndConstantsIsRepairedWithinTheMostRepairCycles) {
  int longest = 0;
  for (const bool has_fallback : {false, true}) {
    if (has_fallback) bank(1) = gnc::lasting_model_image<gnc::FixedPoint>(8);
    for (unsigned hit = 0; hit < 8; ++hit) {
      const bool first = (hit & 1) != 0, second = (hit & 2) != 0, constants = (hit & 4) != 0;
      init(store);
      sequence_number = 100;
      now_ns = kStart_ns;
      passed_over.clear();
      twin.reset();
      step_good();
      if (first) hit_table(0);
      if (second) hit_table(1);
      if (constants) flip_a_constant();
      // A second copy's table is copied in no time, and each of two is once one of them is sound.
      const int tables = has_fallback ? (first ? 1 : 0) + (second ? 1 : 0) : first && second ? 1 : 0;
      const int cycles = tables + (constants ? 1 : 0);
      expect_repaired_after(cycles);
      EXPECT_EQ(out->telemetry.model_tables_rebuilt, (first ? 1U : 0U) + (second ? 1U : 0U)) << hit;
      EXPECT_EQ(out->telemetry.constants_reloaded, constants ? 1U : 0U) << hit;
      longest = std::max(longest, cycles);
      steps_of_a_pass(false);
      EXPECT_EQ(out->telemetry.model_blocks_repaired + out->telemetry.model_blocks_lost, 0U) << hit;
    }
  }
  EXPECT_EQ(longest, MemoryScrubber::kMostRepairCycles);
}

// Verifies TS-FDIR-190. The other flips of the vote and of the estimator's state are still corrected at once.
TEST_F(MemoryScrubberTest, WhatIsHitWhileARepairWaitsIsCorrectedToo) {
  bank(1) = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init(store);
  sequence_number = 100;
  now_ns = kStart_ns;
  step_good();
  hit_table(0);
  flip_a_constant();
  step_good();
  EXPECT_EQ(out->telemetry.constants_reloaded, 0U) << "it waits";
  passed_over.push_back(sequence_number);
  AppMemory::flip_state_bit(*app, 5);
  AppMemory::redundant_state(*app).flip(8 * offsetof(AppState, long_task));
  hit_table(1);
  expect_repaired_after(2);
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 2U);
  EXPECT_EQ(out->telemetry.constants_reloaded, 1U);
  EXPECT_EQ(out->telemetry.states_restored, 1U);
  EXPECT_EQ(out->telemetry.memory_corrections, 1U);
}

// Verifies TS-FDIR-190.
TEST_F(MemoryScrubberTest, RepairsInStandbyAreSpreadTooAndRunWaitsForTheLast) {
  step_commands({set_mode(Mode::kStandby)});
  hit_table(0);
  hit_table(1);
  flip_a_constant();
  step(StepInputs{});
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 2U);
  StepInputs inputs;
  const gnc::RangeImage frame = next_frame();
  sequence_number = frame.sequence_number;
  inputs.frame = &frame;
  inputs.commands[0] = set_mode(Mode::kRun);
  inputs.command_count = 1;
  step(inputs);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(out->telemetry.constants_reloaded, 1U);
  EXPECT_EQ(validity(), Validity::kPassedOver);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.sequence_gaps, 0U);
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, TableAndModelHitTogetherLeadToSafeWithoutASecondCopy) {
  store.banks[1] = {};
  init(store);
  step_good();
  bank(0)[900'000] ^= 1;
  AppMemory::scrubber(*app).flip(8 * 40);
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 0U);
}

// Verifies TS-FDIR-030.
TEST_F(MemoryScrubberTest, ConstantsHitTogetherWithTheirImageAreReloadedAfterItsRepair) {
  flip_a_constant();
  for (std::size_t at = 0; at < bank(0).size(); at += config::kModelBlockBytes) bank(0)[at + 64] ^= 1;
  expect_repaired_after(1);
  EXPECT_EQ(out->telemetry.constants_reloaded, 1U);
  EXPECT_EQ(bank(0), test_model_image());
}

// Verifies TS-FDIR-030.
TEST_F(MemoryScrubberTest, ConstantsThatNoBankHoldsLeadToSafe) {
  store.banks[1] = {};
  init(store);
  step_good();
  flip_a_constant();
  for (std::size_t at = 0; at < bank(0).size(); at += config::kModelBlockBytes) bank(0)[at + 64] ^= 1;
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, HitReadOnlyBankIsReplacedByItsSecondCopy) {
  for (const std::uint32_t used : {0U, 1U}) {
    store.fill(test_model_image());
    store.banks[used].writable = false;
    init(store);
    command_counter = 0;
    if (used == 1) {
      std::vector<std::uint8_t> arguments;
      append_u32(arguments, gnc::model_image_crc32(test_model_image().data()));
      step_commands(
          {set_mode(Mode::kStandby), command(FunctionCode::kModelActivate, arguments), set_mode(Mode::kRun)});
      ASSERT_EQ(out->telemetry.bank_in_use, 1U);
      ASSERT_EQ(out->telemetry.second_copy, 1U);
    }
    hit_block(used, 20);
    steps_of_a_pass();
    EXPECT_EQ(out->telemetry.model_blocks_lost, 1U);
    EXPECT_EQ(out->telemetry.model_blocks_repaired, 0U);
    EXPECT_EQ(out->telemetry.bank_in_use, 1 - used);
    EXPECT_EQ(out->telemetry.second_copy, 0U) << "the header has the same CRC, but the image is not good";
    EXPECT_EQ(app->mode(), Mode::kRun);
  }
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, SameHitInBothBanksIsNotAccepted) {
  hit_block(0, 100);
  hit_block(1, 100);
  steps_of_a_pass();
  EXPECT_EQ(out->telemetry.model_blocks_lost, 1U);
  EXPECT_EQ(out->telemetry.model_tables_rebuilt, 0U);
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-FDIR-045.
TEST_F(MemoryScrubberTest, ScrubbingEndsAtTheFirstLostBlock) {
  store.banks[1] = {};
  init(store);
  step_good();
  for (const std::size_t block : {15U, 16U, 17U}) hit_block(0, block);  // all checked in the next cycle
  step_good();
  EXPECT_EQ(out->telemetry.model_blocks_lost, 1U);
  EXPECT_EQ(argument(EventId::kModelBlockLost, 1), 15);
}

// Verifies TS-FDIR-030, TS-FDIR-045.
TEST_F(MemoryScrubberTest, ConstantsAreNotReloadedFromAnImageWithALostBlock) {
  store.banks[1] = {};
  init(store);
  step_good();
  flip_a_constant();
  for (const std::size_t block : {100U, 101U}) hit_block(0, block);  // not checked in the next cycle
  step_good();
  EXPECT_EQ(out->telemetry.model_blocks_lost, 1U);
  EXPECT_EQ(argument(EventId::kModelBlockLost, 1), 100);
  EXPECT_EQ(out->telemetry.constants_reloaded, 0U);
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-FDIR-045, TS-FDIR-090, TS-FDIR-190.
TEST_F(MemoryScrubberTest, FrameOfTheCycleThatLosesTheModelIsPassedOverAndCounted) {
  bank(1) = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init(store);
  step_good();
  hit_block(0, 200);
  hit_table();
  step_good();
  EXPECT_EQ(out->telemetry.bank_switches, 1U);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(validity(), Validity::kPassedOver);
  EXPECT_EQ(out->telemetry.frames_passed_over, 1U);
  EXPECT_EQ(out->telemetry.frames_refused, 0U);
  EXPECT_EQ(out->telemetry.frames_used, 1U);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.sequence_gaps, 0U);
}

// Verifies TS-FDIR-045. The vote cannot correct the same bits in two copies.
TEST_F(MemoryScrubberTest, WithoutAGoodModelNoFrameIsUsed) {
  AppMemory::state(*app).banks.descriptor[0].set(BankStatus::kEmpty);
  AppMemory::commit(*app);
  step_good();
  EXPECT_EQ(validity(), Validity::kPassedOver);
  EXPECT_EQ(out->telemetry.long_task, 0);
}

// Verifies TS-FDIR-045, TS-FDIR-190.
TEST_F(MemoryScrubberTest, CommandsOfTheCycleThatLosesTheModelDoNotLengthenTheSwitch) {
  const std::vector<std::uint8_t>& other = gnc::lasting_model_image<gnc::FixedPoint>(8);
  std::vector<std::uint8_t> arguments;
  append_u32(arguments, gnc::model_image_crc32(other.data()));
  for (const bool by_table : {true, false}) {
    bank(0) = test_model_image();
    bank(1) = other;
    init(store);
    command_counter = 0;
    step_commands({set_mode(Mode::kStandby)});
    const std::uint32_t next = AppMemory::state(*app).banks.next_block;
    hit_block(0, by_table ? 200 : next);
    if (by_table) hit_table();
    step_commands({command(FunctionCode::kModelActivate, arguments), set_mode(Mode::kRun)});
    EXPECT_EQ(argument(EventId::kCommandBusy, 2), 1) << "the bank";
    EXPECT_EQ(out->telemetry.bank_in_use, 1U);
    EXPECT_EQ(out->telemetry.bank_switches, 1U);
    EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "at that time there was no model to run";
    EXPECT_EQ(app->mode(), Mode::kStandby);
    EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kSwitchBank));
  }
}

// Verifies TS-FDIR-045, TS-MDL-020.
TEST_F(MemoryScrubberTest, UploadContinuesWhenTheModelInUseIsLost) {
  const auto load = [this](std::uint32_t offset) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, offset);
    arguments.resize(4 + kSegmentBytes);
    step_commands({command(FunctionCode::kModelLoad, arguments)});
  };
  step_commands({command(FunctionCode::kModelBegin, {0})});
  load(0);
  hit_block(0, 200);
  hit_table();
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  load(kSegmentBytes);
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments - 2);
}

// Verifies TS-FDIR-030.
TEST_F(MemoryScrubberTest, ConstantsThatDifferFromTheActivationSwitchBanks) {
  const Region redundant = AppMemory::redundant_state(*app);
  const std::size_t one = redundant.size / 3;
  const auto offset = static_cast<std::size_t>(
      reinterpret_cast<std::uint8_t*>(&AppMemory::state(*app).constants_crc32) - redundant.data);
  for (const std::size_t copy : {std::size_t{0}, one})
    redundant.data[copy + offset] ^= 1;  // the same hit in two copies
  step_good();
  EXPECT_EQ(app->mode(), Mode::kRun) << "the other bank is activated";
  EXPECT_EQ(out->telemetry.bank_switches, 1U);
}

// Verifies TS-FDIR-080.
TEST_F(MemoryScrubberTest, ActivationsAreRewritten) {
  const Region region = AppMemory::activations(*app);
  std::mt19937 engine(5);
  for (int i = 0; i < 20; ++i) {
    for (int flips = 0; flips < 50; ++flips) region.flip(engine() % (8 * region.size));
    expect_undisturbed_step();
  }
}

// What tests/campaigns/fault compares with.
TEST_F(MemoryScrubberTest, WithoutProtectionsAFlipPersists) {
  AppMemory::state(*app).mode = Mode::kSafe;
  now_ns = next_time_ns();
  AppMemory::step_unprotected(*app, now_ns, StepInputs{}, *out);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.memory_corrections, 0U);
}

}  // namespace
}  // namespace tumblesight::fsw
