// What survives a reset, and the mode after it.
// Verifies TS-RST-010, TS-RST-020, TS-RST-030, TS-RST-040.
#include <algorithm>

#include "fsw/app/state_keeper.hpp"
#include "gnc/numerics/crc.hpp"
#include "hal/command_authentication.hpp"
#include "hal/fake/fake_persistent_store.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

using hal::ResetCause;

class Reset : public AppFixture {
 protected:
  Reset() {
    persistent = &kept;
    init_with_model();
  }
  // The processor starts again: nothing is left but the banks and the persistent store.
  void reset(ResetCause cause) {
    app = std::make_unique<AttitudeInitApp>();
    reset_cause = cause;
    init(store);
  }
  StoredState stored() const { return stored_in(kept.copies[0]); }
  void damage(std::size_t copy, std::size_t byte = kInHead) { kept.copies[copy][byte] ^= 1; }
  // The same record of another software: `byte` is changed and all checksums are right.
  void change(std::size_t copy, std::size_t byte) { change(kept.copies[copy], byte); }
  static void change(hal::StoredBytes& bytes, std::size_t byte) {
    bytes[byte] ^= 1;
    for (const std::size_t end : {kStoredHeadBytes, kTableEnd, bytes.size()}) {
      const std::size_t begin = end == kTableEnd ? kTable : 0;
      const std::uint32_t crc = gnc::crc32(bytes.data() + begin, end - begin - 4);
      for (std::size_t i = 0; i < 4; ++i) bytes[end - 4 + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
  }
  static constexpr std::size_t kInHead = 10, kVersion = 4, kBank = 20, kTable = 28,
                               kTableVersion = kTable + 1;
  static constexpr std::size_t kTableEnd = kTable + kTableBytes;
  StoreHealth health() const { return out->telemetry.store_health; }
  // A store of which no write succeeds.
  void break_store() { kept.broken = {true, true}; }
  void step_until_given_up() {
    break_store();
    step_commands({set_mode(Mode::kStandby)});
    for (std::uint32_t i = 1; i < config::kMostFailingCycles; ++i) {
      ASSERT_EQ(health(), StoreHealth::kFailing);
      ASSERT_EQ(events(EventId::kStoreGivenUp), 0);
      step_good();
    }
  }
  // A different model in bank 1, activated.
  void use_bank_1() {
    const std::vector<std::uint8_t>& other = gnc::lasting_model_image<gnc::FixedPoint>(8);
    store.banks[1].memory = other;
    init(store);
    std::vector<std::uint8_t> crc;
    append_u32(crc, gnc::model_image_crc32(other.data()));
    step_commands(
        {set_mode(Mode::kStandby), command(FunctionCode::kModelActivate, crc), set_mode(Mode::kRun)});
    ASSERT_EQ(out->telemetry.bank_in_use, 1);
  }
  std::uint32_t refused_by(CommandRefusal why) const {
    return out->telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }

  // What a boot would find.
  Resumption resumed() {
    AppState state;
    state.platform.persistent = &kept;
    const Reporter report(state, state.events);
    StateKeeper(state, report).resume();
    return state.resumption;
  }
  static StoredState stored_in(const hal::StoredBytes& bytes) {
    StoredState state;
    std::uint32_t generation = 0;
    EXPECT_EQ(from_record(bytes, state, generation), StoreStatus::kOk);
    return state;
  }
  // A reset at every byte of the write, into memory that keeps what was there, or that was erased before:
  // calls `check` with what a boot would find and with the number of bytes written.
  template <class Check>
  void for_each_tear(const hal::fake::FakePersistentStore& before,
                     const hal::fake::FakePersistentStore::Write& write, const Check& check) {
    for (const int erased : {-1, 0x00, 0xFF}) {
      for (std::size_t written = 0; written <= write.bytes.size(); ++written) {
        kept = before;
        hal::StoredBytes& torn = kept.copies[static_cast<std::size_t>(write.copy)];
        if (erased >= 0) torn.fill(static_cast<std::uint8_t>(erased));
        std::copy_n(write.bytes.begin(), written, torn.begin());
        check(resumed(), written);
      }
    }
  }
  static constexpr int kHeadLost = 1, kBodyLost = 2, kTableLost = 4, kStale = 8, kKeySlotLost = 16,
                       kModeAndBankLost = 32;

  hal::fake::FakePersistentStore kept;
};

// The sequence of the review: upload, activate bank 1, SAFE, watchdog reset.
TEST_F(Reset, WatchdogResetInSafeStaysInSafeWithTheActivatedBank) {
  use_bank_1();
  step_commands({set_mode(Mode::kSafe)});
  reset(ResetCause::kWatchdog);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(out->telemetry.bank_status[0], BankStatus::kGood);
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kCommandSafe) << "the cause of the stored SAFE";
  EXPECT_EQ(argument(EventId::kStateResumed, 0), static_cast<int>(ResetCause::kWatchdog));
  EXPECT_EQ(argument(EventId::kStateResumed, 1), static_cast<int>(Mode::kSafe));
  EXPECT_EQ(argument(EventId::kStateResumed, 2), 1);
  EXPECT_EQ(argument(EventId::kSafeEntered, 0), static_cast<int>(Cause::kCommandSafe));
  step_good();
  EXPECT_EQ(events(EventId::kStateResumed), 0) << "reported once only";
}

TEST_F(Reset, ModeFollowsTheStoredModeAndTheCause) {
  struct Row {
    Mode before;
    ResetCause cause;
    Mode after;
  };
  for (const Row row : {Row{Mode::kRun, ResetCause::kPowerOn, Mode::kRun},
                        {Mode::kRun, ResetCause::kCommanded, Mode::kRun},
                        {Mode::kRun, ResetCause::kWatchdog, Mode::kStandby},
                        {Mode::kRun, ResetCause::kOther, Mode::kStandby},
                        {Mode::kStandby, ResetCause::kPowerOn, Mode::kStandby},
                        {Mode::kStandby, ResetCause::kWatchdog, Mode::kStandby},
                        {Mode::kSafe, ResetCause::kPowerOn, Mode::kSafe},
                        {Mode::kSafe, ResetCause::kWatchdog, Mode::kSafe}}) {
    kept = {};
    command_counter = 0;
    reset(ResetCause::kPowerOn);
    ASSERT_EQ(app->mode(), Mode::kRun) << "a first start";
    step_commands({set_mode(row.before)});
    reset(row.cause);
    EXPECT_EQ(app->mode(), row.after) << static_cast<int>(row.before) << ' ' << static_cast<int>(row.cause);
  }
}

TEST_F(Reset, WithoutAStoreAnAbnormalResetLeadsToStandby) {
  persistent = nullptr;
  reset(ResetCause::kWatchdog);
  EXPECT_EQ(app->mode(), Mode::kStandby);
  step_good();
  EXPECT_EQ(events(EventId::kStateResumed), 0);
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

TEST_F(Reset, WithoutAModelTheModeIsSafe) {
  step_good();
  store.banks[0].memory[0] ^= 1;
  store.banks[1].memory[0] ^= 1;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kNoModel);
}

TEST_F(Reset, BadStoredBankFallsBackToTheOther) {
  use_bank_1();
  store.banks[1].memory[500'000] ^= 1;
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  EXPECT_EQ(argument(EventId::kModelRefused, 2), 1);
  EXPECT_EQ(argument(EventId::kModelActivated, 1), 0);
}

TEST_F(Reset, LimitsAndDisabledResponsesStay) {
  const auto fault = static_cast<std::uint8_t>(Fault::kAttitudeJump);
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5}),
                 command(FunctionCode::kDisableResponse, {fault})});
  reset(ResetCause::kWatchdog);
  step_good();
  EXPECT_EQ(out->telemetry.responses_disabled, bit_of(Fault::kAttitudeJump));
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], 5U);
  step_good();
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], 5U)
      << "the limit in use, which is stored again in every change";
}

// Verifies TS-SEC-030.
TEST_F(Reset, LastAcceptedCommandIsRefusedAfterAReset) {
  const hal::CommandPacket standby = set_mode(Mode::kStandby);
  step_commands({standby});
  step_commands({set_mode(Mode::kRun)});
  const hal::CommandPacket last = set_mode(Mode::kRun);
  step_commands({last});
  reset(ResetCause::kPowerOn);
  step_commands({standby, last});
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 2U);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// A store that looks at what the application had done when it was written.
class WatchingStore final : public hal::PersistentStore {
 public:
  StoreStatus read(int copy, hal::StoredBytes& bytes) override { return kept_.read(copy, bytes); }
  StoreStatus write(int copy, const hal::StoredBytes& bytes) override {
    StoredState state;
    std::uint32_t generation = 0;
    EXPECT_EQ(from_record(bytes, state, generation), StoreStatus::kOk);
    if (state.command_counter == counter && first.mode == Mode::kBoot) first = state;
    return kept_.write(copy, bytes);
  }
  std::uint32_t counter = 1;
  StoredState first;  // the first record with this counter

 private:
  hal::fake::FakePersistentStore kept_;
};

// Verifies TS-SEC-070.
TEST_F(Reset, CounterIsStoredBeforeTheCommandIsCarriedOut) {
  WatchingStore watching;
  persistent = &watching;
  init(store);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(watching.first.command_counter, 1U);
  EXPECT_EQ(watching.first.mode, Mode::kRun) << "the command was not carried out yet";
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-SEC-070.
TEST_F(Reset, CommandWhoseCounterCannotBeStoredIsRefused) {
  step_good();
  break_store();
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 1U);
  EXPECT_EQ(events(EventId::kCommandNotStored), 1);
  EXPECT_EQ(argument(EventId::kStateNotStored, 0), 0);
  EXPECT_GE(out->telemetry.state_writes_failed, 1U);
  EXPECT_EQ(health(), StoreHealth::kFailing);
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(events(EventId::kStateNotStored), 0) << "reported at the start of the failure only";
  kept.broken = {};
  step_good();
  EXPECT_EQ(kept.copies[0], kept.copies[1]);
  EXPECT_EQ(health(), StoreHealth::kGood);
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(events(EventId::kStateNotStored), 0);
  EXPECT_EQ(app->mode(), Mode::kStandby);
}

// Verifies TS-SEC-070.
TEST_F(Reset, OnlySafeIsCarriedOutWhileItsCounterCannotBeStored) {
  step_good();
  break_store();
  static_assert(static_cast<int>(Mode::kSafe) == 3, "the first argument of SET_PARAMETER looks the same");
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5}), set_mode(Mode::kStandby)});
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 2U);
  const hal::CommandPacket safe = set_mode(Mode::kSafe);
  step_commands({safe});
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
  step_commands({safe});
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U) << "the counter is spent until the next reset";
  step_commands({command(static_cast<FunctionCode>(99))});
  EXPECT_EQ(refused_by(CommandRefusal::kUnknownFunction), 1U)
      << "the first check that fails gives the reason";
}

// Verifies TS-SEC-075.
TEST_F(Reset, DeadStoreIsGivenUpSoThatTheCraftCanBeCommanded) {
  step_until_given_up();
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(argument(EventId::kStoreGivenUp, 0), static_cast<int>(config::kMostFailingCycles));
  EXPECT_EQ(event(EventId::kStoreGivenUp)->severity, Severity::kError);
  EXPECT_EQ(out->telemetry.store_given_up, 1U);
  EXPECT_EQ(health(), StoreHealth::kGivenUp);
  const hal::CommandPacket standby = set_mode(Mode::kStandby);
  step_commands({standby});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(out->telemetry.store_given_up, 1U) << "once only";
  step_commands({standby});
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
}

// Verifies TS-SEC-075.
TEST_F(Reset, StoreThatWasGivenUpIsTriedAgainAtEachCheck) {
  step_until_given_up();
  const auto cycles_to_a_try = [this] {
    const std::uint32_t before = out->telemetry.state_writes_failed;
    std::uint32_t cycles = 0;
    while (out->telemetry.state_writes_failed == before && cycles < 1'000) {
      step(StepInputs{});
      ++cycles;
    }
    return cycles;
  };
  cycles_to_a_try();
  EXPECT_EQ(cycles_to_a_try(), config::kStoreCheck_cycles);
  const std::uint32_t failed = out->telemetry.state_writes_failed;
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(out->telemetry.state_writes_failed, failed) << "commands and changes do not try";
  EXPECT_EQ(cycles_to_a_try(), config::kStoreCheck_cycles - 1);
  EXPECT_EQ(out->telemetry.store_given_up, 1U);
  kept.broken = {};
  for (std::uint32_t i = 1; i < config::kStoreCheck_cycles; ++i) {
    step(StepInputs{});
    ASSERT_EQ(health(), StoreHealth::kGivenUp) << i;
  }
  step(StepInputs{});
  EXPECT_EQ(argument(EventId::kStoreUsable, 0), 2);
  EXPECT_EQ(health(), StoreHealth::kGood);
  EXPECT_EQ(stored().mode, Mode::kSafe);
  step(StepInputs{});
  EXPECT_EQ(events(EventId::kStoreUsable), 0) << "once only";
  step_until_given_up();
  EXPECT_EQ(out->telemetry.store_given_up, 2U);
}

// Verifies TS-SEC-075.
TEST_F(Reset, ChangeWhileTheStoreIsGivenUpIsReportedSinceAResetUndoesIt) {
  step_until_given_up();
  step_commands({command(FunctionCode::kNoop)});
  EXPECT_EQ(events(EventId::kChangeNotStored), 0) << "nothing but the counter changes";
  for (const Mode mode : {Mode::kStandby, Mode::kSafe}) {
    step_commands({set_mode(mode)});
    EXPECT_EQ(app->mode(), mode);
    EXPECT_EQ(argument(EventId::kChangeNotStored, 1), static_cast<int>(mode));
    EXPECT_EQ(event(EventId::kChangeNotStored)->severity, Severity::kError);
    step_good();
    EXPECT_EQ(events(EventId::kChangeNotStored), 0) << "once only";
  }
  const auto fault = static_cast<std::uint8_t>(Fault::kAttitudeJump);
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  EXPECT_EQ(events(EventId::kChangeNotStored), 1);
  step_commands({command(FunctionCode::kDisableResponse, {fault})});
  EXPECT_EQ(events(EventId::kChangeNotStored), 1);
  ParameterTable given = AppMemory::state(*app).table;
  ASSERT_TRUE(app->use(given));
  step_good();
  EXPECT_EQ(events(EventId::kChangeNotStored), 0) << "nothing changed";
  given[Parameter::kScrubBlocks] = 6;
  ASSERT_TRUE(app->use(given));
  step_good();
  EXPECT_EQ(events(EventId::kChangeNotStored), 1);
  StepInputs bug_of_the_caller;
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  bug_of_the_caller.command_count = -1;
  step(bug_of_the_caller);
  EXPECT_EQ(argument(EventId::kChangeNotStored, 1), static_cast<int>(Mode::kSafe)) << "not commanded";
  kept.broken = {};
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kRun) << "the stored mode";
  step_good();
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(events(EventId::kChangeNotStored), 0) << "it is stored";
}

// Verifies TS-SEC-075. It may still be stored until the store is given up.
TEST_F(Reset, ChangeWhileTheStoreFailsIsReportedWhenItIsGivenUp) {
  const auto reports_until_given_up = [this] {
    int reports = 0;
    for (std::uint32_t i = 0; health() != StoreHealth::kGivenUp && i < 2 * config::kStoreCheck_cycles; ++i) {
      step(StepInputs{});
      reports += events(EventId::kChangeNotStored);
    }
    EXPECT_EQ(health(), StoreHealth::kGivenUp);
    return reports;
  };
  step_good();
  break_store();
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(events(EventId::kChangeNotStored), 0);
  EXPECT_EQ(reports_until_given_up(), 1);

  kept.broken = {};
  reset(ResetCause::kPowerOn);
  step_good();
  break_store();
  step_commands({set_mode(Mode::kSafe)});
  kept.broken = {};
  step(StepInputs{});
  EXPECT_EQ(stored().mode, Mode::kSafe);
  break_store();
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(reports_until_given_up(), 0) << "the change was stored in between";
}

// A copy that fails for long, and then the other one too: the ten cycles begin with the second one.
TEST_F(Reset, StoreIsGivenUpOnlyAfterTenCyclesWithoutACopy) {
  step_good();
  kept.broken[1] = true;
  step_commands({command(FunctionCode::kNoop)});
  for (int i = 0; i < 30; ++i) step(StepInputs{});
  EXPECT_EQ(health(), StoreHealth::kOneCopy);
  step_until_given_up();
  EXPECT_EQ(health(), StoreHealth::kGivenUp);
}

TEST_F(Reset, StoreThatFailsInEverySecondCycleIsNotGivenUp) {
  step_good();
  for (int i = 0; i < 40; ++i) {
    kept.broken = {i % 2 == 0, i % 2 == 0};
    step_commands({command(FunctionCode::kNoop)});
    ASSERT_NE(health(), StoreHealth::kGivenUp) << i;
  }
}

// A record of the boot is written before any command comes.
TEST_F(Reset, StoreThatIsDeadAtBootIsGivenUpToo) {
  kept = {};
  kept.unreadable = {true, true};
  break_store();
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kFailed));
  EXPECT_EQ(argument(EventId::kStateNotStored, 0), 0);
  for (std::uint32_t i = 1; i < config::kMostFailingCycles; ++i) step_good();
  EXPECT_EQ(health(), StoreHealth::kGivenUp);
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  EXPECT_EQ(app->mode(), Mode::kRun);
}

TEST_F(Reset, WithoutAStoreItsHealthIsNone) {
  persistent = nullptr;
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(health(), StoreHealth::kNone);
  EXPECT_EQ(out->telemetry.store_us, 0U);
}

// Verifies TS-RST-070.
TEST_F(Reset, WriteThatChangesNothingCountsAsFailed) {
  step_good();
  kept.protected_silently = {true, true};
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 1U);
  EXPECT_EQ(argument(EventId::kStateNotStored, 0), 0);
  kept.protected_silently = {false, true};
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(health(), StoreHealth::kOneCopy);
}

// Verifies TS-RST-070. As a file whose bytes have reached the cache and not the disk.
TEST_F(Reset, WriteThatReportsAnErrorCountsAsFailedEvenIfItCanBeReadBack) {
  step_good();
  kept.unsure = {true, true};
  for (int i = 0; i < 3; ++i) {
    step_commands({command(FunctionCode::kNoop)});
    EXPECT_EQ(health(), StoreHealth::kFailing);
    step_good();
    EXPECT_EQ(health(), StoreHealth::kFailing);
  }
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 3U);
}

// Verifies TS-RST-070. Bytes of either copy, in flight.
TEST_F(Reset, CopyThatChangesInTheStoreIsFoundAndWrittenAgain) {
  step_good();
  const hal::fake::FakePersistentStore good = kept;
  std::uint32_t found = 0;
  for (const std::size_t copy : {0U, 1U}) {
    for (const std::size_t byte : {std::size_t{0}, kInHead, kBank, kTable, kept.copies[0].size() - 1}) {
      damage(copy, byte);
      for (std::uint32_t i = 0; i < config::kStoreCheck_cycles; ++i) step(StepInputs{});
      ASSERT_EQ(kept.copies[copy], good.copies[copy]) << byte;
      ASSERT_EQ(out->telemetry.state_writes_failed, ++found);
    }
  }
  EXPECT_EQ(kept.writes, good.writes + static_cast<int>(found)) << "the good copy is not worn out";
  EXPECT_EQ(health(), StoreHealth::kGood);
}

TEST_F(Reset, BrokenCopyDoesNotWearOutTheGoodOne) {
  step_good();
  kept.broken[1] = true;
  step_commands({set_mode(Mode::kStandby)});
  const int writes = kept.writes, reads = kept.reads;
  constexpr int kCycles = 3 * static_cast<int>(config::kStoreCheck_cycles);
  for (int i = 0; i < kCycles; ++i) step(StepInputs{});
  EXPECT_EQ(kept.writes, writes);
  EXPECT_LE(kept.reads, reads + 4 * (static_cast<int>(config::kMostFailingCycles) + 3))
      << "tried now and then";
  kept.broken[1] = false;
  for (std::uint32_t i = 0; i < config::kStoreCheck_cycles; ++i) step(StepInputs{});
  EXPECT_EQ(kept.copies[0], kept.copies[1]);
}

// Verifies TS-TLM-050.
TEST_F(Reset, TimeOfTheStoreAtTheEndOfAStepIsMeasured) {
  stopwatch.tick_ns = 5'000;
  step_good();
  EXPECT_EQ(out->telemetry.store_us, 5U);
  stopwatch.tick_ns = 3'000;
  step_good();
  EXPECT_EQ(out->telemetry.store_us, 3U);
  EXPECT_EQ(out->telemetry.store_max_us, 5U);
}

// The step goes SAFE and does not kick the watchdog, whose reset comes next.
TEST_F(Reset, SafeAfterRefusedInputsIsStored) {
  step_good();
  StepInputs inputs;
  inputs.command_count = -1;
  step(inputs);
  ASSERT_EQ(app->mode(), Mode::kSafe);
  reset(ResetCause::kWatchdog);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kAssertion);
}

TEST_F(Reset, PlatformThatIsIncompleteChangesNoStoredState) {
  step_commands({set_mode(Mode::kStandby)});
  const hal::fake::FakePersistentStore before = kept;
  boot(*app, {nullptr, &store, &kTestKeys, &kept, ResetCause::kPowerOn});
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(kept.copies, before.copies);
}

TEST_F(Reset, StoredBankStaysIfNeitherImageIsGood) {
  use_bank_1();
  const std::vector<std::uint8_t> image = store.banks[1].memory;
  store.banks[0].memory[0] ^= 1;
  store.banks[1].memory[0] ^= 1;
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kNoModel);
  store.fill(test_model_image());
  store.banks[1].memory = image;
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(out->telemetry.bank_in_use, 1) << "the images were unreadable for one boot only";
}

TEST_F(Reset, OneBrokenCopyIsReportedAndCommandsContinue) {
  step_good();
  kept.broken[1] = true;
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(argument(EventId::kStateNotStored, 0), 1);
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kStandby) << "the newer copy counts";
  kept.broken[1] = false;
  step_good();
  EXPECT_EQ(kept.copies[0], kept.copies[1]) << "both are written again";
}

TEST_F(Reset, CopyThatCouldNotBeWrittenIsWrittenAgainWithoutAChange) {
  step_good();
  kept.broken[1] = true;
  step_commands({set_mode(Mode::kStandby)});
  kept.broken[1] = false;
  EXPECT_NE(kept.copies[0], kept.copies[1]);
  step_good();
  EXPECT_EQ(kept.copies[0], kept.copies[1]);
}

TEST_F(Reset, FailedWriteAtTheEndOfAStepIsRepeated) {
  step_good();
  const int writes = kept.writes, reads = kept.reads;
  step_good();
  EXPECT_EQ(kept.writes, writes) << "nothing has changed";
  EXPECT_EQ(kept.reads, reads);
  kept.broken = {true, true};
  store.banks[0].memory[200'000] ^= 1;
  store.banks[1].memory[200'000] ^= 1;
  for (int i = 0; i < 30 && app->mode() == Mode::kRun; ++i) step_good();
  ASSERT_EQ(app->mode(), Mode::kSafe) << "a change without a command";
  kept.broken = {};
  step_good();
  EXPECT_EQ(stored().mode, Mode::kSafe);
}

TEST_F(Reset, EitherCopyAloneIsEnough) {
  const hal::CommandPacket last = set_mode(Mode::kSafe);
  step_commands({last});
  const hal::fake::FakePersistentStore good = kept;
  for (const std::size_t copy : {0U, 1U}) {
    for (const std::size_t byte : {kInHead, kBank}) {
      kept = good;
      damage(copy, byte);
      reset(ResetCause::kWatchdog);
      EXPECT_EQ(app->mode(), Mode::kSafe);
      step_commands({last});
      EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
      EXPECT_EQ(events(EventId::kStoredStateLost), 0);
      const auto status =
          static_cast<int>(byte == kInHead ? StoreStatus::kDamaged : StoreStatus::kBodyDamaged);
      EXPECT_EQ(argument(EventId::kStoredCopyUnusable, copy), status);
      EXPECT_EQ(argument(EventId::kStoredCopyUnusable, 1 - copy), static_cast<int>(StoreStatus::kOk));
      EXPECT_EQ(kept.copies[0], kept.copies[1]) << "the damaged copy is written again";
    }
  }
}

TEST_F(Reset, LossOfBothCopiesIsAColdBootInSafeWithAnEvent) {
  use_bank_1();
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  damage(0);
  kept.unreadable[1] = true;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kStoredStateLost);
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kDamaged));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 1), static_cast<int>(StoreStatus::kFailed));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kHeadLost + kBodyLost);
  EXPECT_EQ(events(EventId::kStateResumed), 0);
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  EXPECT_EQ(out->telemetry.command_counter, 0U);
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
  kept.unreadable[1] = false;
  step_good();
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(events(EventId::kStoredStateLost), 0) << "the store is in order again";
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

// Verifies TS-RST-080.
TEST_F(Reset, ReadThatFailsTwiceIsRepeated) {
  step_commands({set_mode(Mode::kStandby)});
  kept.failing_reads = {2, 2};
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(app->command_counter(), 1U);
  step_good();
  EXPECT_EQ(events(EventId::kStoredCopyUnusable), 0);
  const int reads = kept.reads;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(kept.reads, reads + 2) << "good reads are not repeated";
}

// Verifies TS-RST-080. Memory that needs some time after power-on.
TEST_F(Reset, CounterIsResumedInTheFirstStepIfNothingCouldBeReadAtBoot) {
  const std::uint8_t fault = static_cast<std::uint8_t>(Fault::kAttitudeJump);
  const hal::CommandPacket last = set_mode(Mode::kRun);
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5}),
                 command(FunctionCode::kDisableResponse, {fault}), last});
  const std::uint32_t counter = app->command_counter();
  kept.failing_reads = {3, 3};
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(app->command_counter(), 0U);
  step_commands({last});
  EXPECT_EQ(app->command_counter(), counter);
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kOk));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kModeAndBankLost) << "they were decided at boot";
  EXPECT_EQ(events(EventId::kStateResumed), 0);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], 5U);
  EXPECT_EQ(stored().responses_disabled, bit_of(Fault::kAttitudeJump));
}

// Verifies TS-RST-080. What is lost by then is named, and nothing else.
TEST_F(Reset, LateResumptionNamesWhatIsLostThen) {
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  const hal::fake::FakePersistentStore good = kept;
  const auto lost_with = [&](const auto& change_store) {
    kept = good;
    change_store();
    kept.failing_reads = {3, 3};
    reset(ResetCause::kPowerOn);
    step_good();
    EXPECT_EQ(app->mode(), Mode::kSafe);
    EXPECT_EQ(app->state_lost(), static_cast<std::uint32_t>(argument(EventId::kStoredStateLost, 2)));
    return argument(EventId::kStoredStateLost, 2);
  };
  const auto change_both = [this](std::size_t byte) {
    for (const std::size_t copy : {0U, 1U}) change(copy, byte);
  };
  EXPECT_EQ(lost_with([&] {}), kModeAndBankLost);
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], 5U);
  EXPECT_EQ(lost_with([&] { change_both(kTableVersion); }), kTableLost + kModeAndBankLost);
  EXPECT_EQ(lost_with([&] { change_both(kVersion); }), kBodyLost);
  EXPECT_EQ(lost_with([&] { kept.copies = {}; }), kHeadLost + kBodyLost);
  EXPECT_EQ(lost_with([&] { kept.blank = {true, true}; }), kModeAndBankLost);
}

// Verifies TS-RST-090. Other software, or damage behind the heads.
TEST_F(Reset, CounterAndKeySlotAreKeptIfOnlyTheHeadsAreGood) {
  const hal::CommandPacket last = command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5});
  step_commands({last});
  const hal::fake::FakePersistentStore good = kept;
  for (const StoreStatus status : {StoreStatus::kOtherVersion, StoreStatus::kBodyDamaged}) {
    kept = good;
    for (const std::size_t copy : {0U, 1U}) {
      if (status == StoreStatus::kOtherVersion) change(copy, kVersion);
      if (status == StoreStatus::kBodyDamaged) damage(copy, kBank);
    }
    reset(ResetCause::kPowerOn);
    EXPECT_EQ(app->mode(), Mode::kSafe);
    step_commands({last});
    EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
    EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(status));
    EXPECT_EQ(argument(EventId::kStoredStateLost, 1), static_cast<int>(status));
    EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kBodyLost);
    EXPECT_EQ(events(EventId::kStateResumed), 0);
    EXPECT_EQ(stored().table[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
  }
}

// Verifies TS-RST-090.
TEST_F(Reset, TableOfOtherSoftwareIsReplacedByTheInitialOne) {
  use_bank_1();
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  for (const std::size_t copy : {0U, 1U}) change(copy, kTableVersion);
  const std::uint32_t counter = app->command_counter();
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(app->command_counter(), counter);
  step_good();
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(argument(EventId::kStateResumed, 1), static_cast<int>(Mode::kRun));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kOtherTable));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kTableLost);
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
}

// One copy could not be written for long, and the other one is lost.
TEST_F(Reset, OldBodyIsResumedInSafe) {
  step_good();
  kept.broken[1] = true;
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun), set_mode(Mode::kSafe)});
  kept.broken[1] = false;
  damage(0, kBank);
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(app->command_counter(), 3U) << "that of the newest head";
  step_good();
  EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kStale);
}

// Verifies TS-RST-030. The state is the one before the write or the one after it, and the counter never an
// older one.
TEST_F(Reset, TornWriteLosesNothing) {
  step_good();
  hal::fake::FakePersistentStore before = kept;
  before.log.clear();
  kept.log.clear();
  step_commands({set_mode(Mode::kStandby), command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  const auto writes = kept.log;
  ASSERT_EQ(writes.size(), 6U) << "two commands and the end of the step";
  StoredState old = stored_in(before.copies[0]);
  for (const hal::fake::FakePersistentStore::Write& write : writes) {
    const StoredState next = stored_in(write.bytes);
    for_each_tear(before, write, [&](const Resumption& found, std::size_t written) {
      ASSERT_EQ(found.lost, 0U) << written;
      StoredState body = found.stored;
      ASSERT_GE(body.command_counter, old.command_counter);
      body.command_counter = next.command_counter;
      StoredState old_body = old;
      old_body.command_counter = next.command_counter;
      ASSERT_TRUE(body == next || body == old_body) << written;
    });
    before.copies[static_cast<std::size_t>(write.copy)] = write.bytes;
    if (write.copy == 1) old = next;
  }
  EXPECT_EQ(old.mode, Mode::kStandby);
  EXPECT_EQ(old.table[Parameter::kScrubBlocks], 5U);
}

// Verifies TS-RST-030. A second reset, during the first write after the first one, for every byte of it.
TEST_F(Reset, TwoResetsInARowLoseNothing) {
  step_good();
  hal::fake::FakePersistentStore before = kept;
  kept.log.clear();
  step_commands({set_mode(Mode::kSafe)});
  auto writes = kept.log;
  ASSERT_EQ(writes.size(), 4U) << "the counter before the command, and the mode at the end of the step";
  for (const std::size_t i : {0U, 1U})
    before.copies[static_cast<std::size_t>(writes[i].copy)] = writes[i].bytes;
  const StoredState next = stored_in(writes[2].bytes);
  for (const bool second_is_torn : {false, true}) {
    kept = before;
    kept.copies[static_cast<std::size_t>(writes[2].copy)] = writes[2].bytes;
    auto& second = kept.copies[static_cast<std::size_t>(writes[3].copy)];
    if (second_is_torn) std::copy_n(writes[3].bytes.begin(), 10, second.begin());
    kept.log.clear();
    const hal::fake::FakePersistentStore after_first_reset = kept;
    reset(ResetCause::kWatchdog);
    step_good();
    ASSERT_FALSE(kept.log.empty());
    const hal::fake::FakePersistentStore::Write write = kept.log.front();
    for_each_tear(after_first_reset, write, [&](const Resumption& found, std::size_t written) {
      ASSERT_EQ(found.lost, 0U) << second_is_torn << ' ' << written;
      ASSERT_EQ(found.stored.mode, Mode::kSafe) << second_is_torn << ' ' << written;
      ASSERT_GE(found.stored.command_counter, next.command_counter) << second_is_torn << ' ' << written;
    });
  }
}

// Verifies TS-RST-030. Every single byte of either copy.
TEST_F(Reset, EveryDamagedByteOfOneCopyLosesNothing) {
  step_commands({set_mode(Mode::kSafe), command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  const hal::fake::FakePersistentStore good = kept;
  const StoredState state = stored();
  for (const std::size_t copy : {0U, 1U}) {
    for (std::size_t byte = 0; byte < hal::kStoredBytes; ++byte) {
      for (const int flips : {0x01, 0x80, 0xFF}) {
        kept = good;
        kept.copies[copy][byte] ^= static_cast<std::uint8_t>(flips);
        const Resumption found = resumed();
        ASSERT_NE(found.copies[copy], StoreStatus::kOk) << byte;
        ASSERT_EQ(found.lost, 0U) << byte;
        ASSERT_TRUE(found.stored == state) << byte;
      }
    }
  }
}

// Verifies TS-RST-040, TS-RST-090. A byte of each copy: what is lost is said, and the counter is lost only if
// both heads are.
TEST_F(Reset, EveryPairOfDamagedBytesIsSeen) {
  step_commands({set_mode(Mode::kSafe)});
  const hal::fake::FakePersistentStore good = kept;
  for (std::size_t first = 0; first < hal::kStoredBytes; first += 3) {
    for (std::size_t second = 0; second < hal::kStoredBytes; second += 3) {
      kept = good;
      damage(0, first);
      damage(1, second);
      const bool head = first >= kStoredHeadBytes || second >= kStoredHeadBytes;
      const Resumption found = resumed();
      ASSERT_FALSE(found.found);
      ASSERT_EQ(static_cast<int>(found.lost), head ? kBodyLost : kHeadLost + kBodyLost);
      ASSERT_EQ(found.stored.command_counter, head ? 1U : 0U);
    }
  }
}

// A copy that was unreadable at one boot and is older than the generations say.
TEST_F(Reset, CounterIsTheHighestOfBothCopies) {
  step_commands({set_mode(Mode::kStandby)});
  StoredState high = stored();
  high.command_counter = 70;
  kept.copies[1] = to_record(high, 1);
  EXPECT_EQ(resumed().stored.command_counter, 70U);
  kept.copies[1] = kept.copies[0];
  kept.copies[0] = to_record(high, 1);
  EXPECT_EQ(resumed().stored.command_counter, 70U);
}

// Verifies TS-SEC-050.
TEST_F(Reset, WindowOfTheCounterContinuesFromTheStoredOne) {
  step_commands({set_mode(Mode::kStandby)});
  for (const std::uint32_t ahead : {hal::kCommandWindow + 1, hal::kCommandWindow}) {
    reset(ResetCause::kPowerOn);
    const std::uint32_t last = app->command_counter();
    command_counter = last + ahead - 1;
    step_commands({set_mode(Mode::kSafe)});
    const bool within = ahead == hal::kCommandWindow;
    EXPECT_EQ(app->mode(), within ? Mode::kSafe : Mode::kStandby);
    EXPECT_EQ(refused_by(CommandRefusal::kOutOfWindow), within ? 0U : 1U);
    EXPECT_EQ(stored().command_counter, within ? last + ahead : last);
  }
}

TEST_F(Reset, FirstStartSaysThatNothingWasStored) {
  kept = {};
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(kept.reads, 2);
  step_good();
  EXPECT_EQ(argument(EventId::kStoredCopyUnusable, 0), static_cast<int>(StoreStatus::kBlank));
  EXPECT_EQ(argument(EventId::kStoredCopyUnusable, 1), static_cast<int>(StoreStatus::kBlank));
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(events(EventId::kStoredCopyUnusable), 0);
}

TEST_F(Reset, OneBlankAndOneDamagedCopyIsALoss) {
  kept.blank[0] = true;
  kept.blank[1] = false;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  kept.blank = {false, true};
  kept.copies[0] = {};
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

class StoredStateRecord : public Reset {
 protected:
  static StoreStatus status_of(const hal::StoredBytes& bytes) {
    StoredState read;
    std::uint32_t generation = 0;
    return from_record(bytes, read, generation);
  }
  static StoreStatus status_of(const StoredState& state) { return status_of(to_record(state, 1)); }
};

TEST_F(StoredStateRecord, ValueOutOfItsRangeIsDamage) {
  StoredState bad;
  EXPECT_EQ(status_of(bad), StoreStatus::kOk);
  bad.mode = static_cast<Mode>(4);
  EXPECT_EQ(status_of(bad), StoreStatus::kBodyDamaged);
  bad = {};
  bad.safe_cause = static_cast<Cause>(static_cast<int>(hal::kLastCause) + 1);
  EXPECT_EQ(status_of(bad), StoreStatus::kBodyDamaged);
  bad = {};
  bad.safe_fault = static_cast<Fault>(kFaults);
  EXPECT_EQ(status_of(bad), StoreStatus::kBodyDamaged);
  bad = {};
  bad.bank = hal::kModelBanks;
  EXPECT_EQ(status_of(bad), StoreStatus::kBodyDamaged);
  for (std::size_t i = 0; i < kTableFields; ++i) {
    bad = {};
    bad.table.fields[i] = UINT32_MAX;
    EXPECT_EQ(status_of(bad), StoreStatus::kOtherTable) << i;
  }
}

TEST_F(StoredStateRecord, OtherFormatIsToldApart) {
  const auto changed = [](std::size_t byte) {
    hal::StoredBytes bytes = to_record(StoredState{}, 1);
    change(bytes, byte);
    return status_of(bytes);
  };
  EXPECT_EQ(changed(0), StoreStatus::kDamaged) << "no record at all";
  EXPECT_EQ(changed(kVersion), StoreStatus::kOtherVersion);
  EXPECT_EQ(changed(kTableVersion), StoreStatus::kOtherTable);
  EXPECT_EQ(changed(kTable + 3), StoreStatus::kOtherTable) << "the number of fields";
  EXPECT_EQ(changed(hal::kStoredBytes - 5), StoreStatus::kOk) << "not used yet";
}

// Verifies TS-RST-090. Later software relies on these offsets.
TEST_F(StoredStateRecord, HeadIsTheSameInEveryVersion) {
  StoredState state;
  state.command_counter = 0x01020304;
  state.key_slot = 3;
  const hal::StoredBytes bytes = to_record(state, 0x0A0B0C0D);
  const std::array<std::uint8_t, 16> head{'T', 'S', 'S', 'T', 3, 3, 0, 0, 0x0A, 0x0B, 0x0C, 0x0D, 1, 2, 3, 4};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  const std::uint32_t crc = gnc::crc32(head.data(), head.size());
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(bytes[16 + i], static_cast<std::uint8_t>(crc >> (24 - 8 * i)));
}

// Key roll-over.
class KeyRollOver : public Reset {
 protected:
  KeyRollOver() {
    second.key = kSecondTestKey;
    second.slot = 1;
  }
  hal::CommandPacket activate(std::uint8_t slot, std::uint8_t proof_slot, int spoilt_byte = -1) {
    std::vector<std::uint8_t> arguments{slot};
    const gnc::Sha256Digest proof = hal::proof_of_key(kTestKeys, proof_slot, command_counter + 1);
    arguments.insert(arguments.end(), proof.begin(), proof.begin() + hal::kCommandMacBytes);
    if (spoilt_byte >= 0) arguments[static_cast<std::size_t>(spoilt_byte)] ^= 1;
    return command(FunctionCode::kKeyActivate, arguments);
  }
  Signature second;
};

// Verifies TS-SEC-100.
TEST_F(KeyRollOver, AuthenticCommandActivatesAnotherSlotForGood) {
  const hal::CommandPacket with_old_key = set_mode(Mode::kSafe);
  step_commands({activate(1, 1)});
  EXPECT_EQ(out->telemetry.key_slot, 1);
  EXPECT_EQ(argument(EventId::kKeyActivated, 0), 0);
  EXPECT_EQ(argument(EventId::kKeyActivated, 1), 1);
  step_commands({set_mode(Mode::kSafe), with_old_key});
  EXPECT_EQ(refused_by(CommandRefusal::kOtherKey), 2U) << "the old key is no longer valid";
  signature = second;
  reset(ResetCause::kWatchdog);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kSafe) << "the slot survives a reset";
  EXPECT_EQ(out->telemetry.key_slot, 1);
}

// Verifies TS-SEC-100.
TEST_F(KeyRollOver, WithoutProofOfTheNewKeyNothingChanges) {
  step_commands({activate(1, 0), activate(1, 1, 1), activate(1, 1, 16), activate(2, 1), activate(7, 1)});
  EXPECT_EQ(refused_by(CommandRefusal::kWrongArgument), 5U);
  EXPECT_EQ(out->telemetry.key_slot, 0);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kSafe) << "the old key is still valid";
}

TEST_F(KeyRollOver, LinkThatAuthenticatesHasNoKeys) {
  boot(*app, {&stopwatch, &store, nullptr, nullptr, hal::ResetCause::kPowerOn});
  step_commands({unsigned_packet(
      packet_of(static_cast<std::uint8_t>(FunctionCode::kKeyActivate), std::vector<std::uint8_t>(17, 0)))});
  EXPECT_EQ(refused_by(CommandRefusal::kWrongArgument), 1U);
}

// Verifies TS-SEC-110.
TEST_F(KeyRollOver, StoredSlotThatIsEmptyLeadsToSafeWithTheLowestKey) {
  step_commands({activate(1, 1)});
  hal::CommandKeys others;
  others.slots[2] = kTestKeys.slots[0];
  others.slots[3] = kTestKeys.slots[1];
  others.spacecraft_id = kTestKeys.spacecraft_id;
  boot(*app, {&stopwatch, &store, &others, persistent, hal::ResetCause::kPowerOn});
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kStoredStateLost);
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kOk));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 2), kKeySlotLost);
  EXPECT_EQ(out->telemetry.key_slot, 2);
  signature.slot = 2;
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby) << "the craft can be commanded";
}

// Verifies TS-SEC-110.
TEST_F(KeyRollOver, FirstStartUsesTheLowestSlotWithAKey) {
  hal::CommandKeys keys = kTestKeys;
  keys.slots[0] = {};
  kept = {};
  boot(*app, {&stopwatch, &store, &keys, persistent, hal::ResetCause::kPowerOn});
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(app->key_slot(), 1U);
}

TEST_F(KeyRollOver, StoredSlotIsNoLossIfTheLinkAuthenticates) {
  step_commands({activate(1, 1)});
  boot(*app, {&stopwatch, &store, nullptr, persistent, hal::ResetCause::kPowerOn});
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-SEC-100. Otherwise the old key would be valid again after a reset.
TEST_F(KeyRollOver, SlotThatCannotBeStoredIsNotActivated) {
  step_good();
  kept.last_write = kept.writes + 2;  // both copies with the counter of the command
  step_commands({activate(1, 1)});
  EXPECT_EQ(out->telemetry.key_slot, 0);
  EXPECT_EQ(events(EventId::kKeyActivated), 0);
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 1U);
  kept.last_write = -1;
  kept.broken = {};
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby) << "the old key is still valid";
  kept.last_write = kept.writes + 3;  // and one copy with the new slot
  step_commands({activate(1, 1)});
  EXPECT_EQ(out->telemetry.key_slot, 1);
  kept.last_write = -1;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->key_slot(), 1U);
}

// Verifies TS-SEC-075, TS-SEC-100. After the loss of the stored counter only another key ends replays, so the
// change is not refused.
TEST_F(KeyRollOver, SlotActivatedWhileTheStoreIsGivenUpHoldsUntilAResetAndIsReportedSo) {
  step_until_given_up();
  step_commands({activate(1, 1)});
  EXPECT_EQ(out->telemetry.key_slot, 1);
  EXPECT_EQ(events(EventId::kKeyActivated), 1);
  EXPECT_EQ(argument(EventId::kChangeNotStored, 0), 1);
  EXPECT_EQ(argument(EventId::kChangeNotStored, 1), static_cast<int>(Mode::kRun));
  EXPECT_EQ(argument(EventId::kChangeNotStored, 2), 0);
  const hal::fake::FakePersistentStore dead = kept;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->key_slot(), 0U) << "the old key again";
  // With a store that recovers before the reset the slot is kept.
  kept = dead;
  kept.broken = {};
  reset(ResetCause::kPowerOn);
  step_until_given_up();
  step_commands({activate(1, 1)});
  EXPECT_EQ(events(EventId::kChangeNotStored), 1);
  kept.broken = {};
  for (std::uint32_t i = 0; i < config::kStoreCheck_cycles; ++i) step(StepInputs{});
  EXPECT_EQ(health(), StoreHealth::kGood);
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->key_slot(), 1U);
}

TEST_F(KeyRollOver, TornWriteLeavesTheOldSlotOrTheNewOne) {
  step_good();
  hal::fake::FakePersistentStore before = kept;
  before.log.clear();
  kept.log.clear();
  step_commands({activate(1, 1)});
  bool new_slot_is_stored = false;
  for (const hal::fake::FakePersistentStore::Write& write : std::vector(kept.log)) {
    const std::uint32_t slot = stored_in(write.bytes).key_slot;
    for_each_tear(before, write, [&](const Resumption& found, std::size_t written) {
      ASSERT_EQ(found.lost, 0U) << written;
      ASSERT_TRUE(found.stored.key_slot == slot || !new_slot_is_stored) << written;
    });
    before.copies[static_cast<std::size_t>(write.copy)] = write.bytes;
    new_slot_is_stored = slot == 1;
  }
  EXPECT_TRUE(new_slot_is_stored);
}

// Verifies TS-SEC-050.
TEST_F(KeyRollOver, CounterOfTheEndLocksNothingOut) {
  const hal::CommandPacket far = signed_as(signature, 0xFFFFFFFF, packet_of(1));
  step_commands({far});
  EXPECT_EQ(refused_by(CommandRefusal::kOutOfWindow), 1U);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

TEST(Platform, AnUnknownResetCauseIsAbnormal) {
  EXPECT_TRUE(hal::is_abnormal(hal::Platform{}.reset_cause));
}

}  // namespace
}  // namespace tumblesight::fsw
