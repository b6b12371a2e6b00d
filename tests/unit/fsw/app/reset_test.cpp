// What survives a reset, and the mode after it.
// Verifies TS-RST-010, TS-RST-020, TS-RST-030, TS-RST-040.
#include "fsw/app/state_keeper.hpp"
#include "gnc/numerics/crc.hpp"
#include "hal/command_authentication.hpp"
#include "hal/fake/fake_persistent_store.hpp"
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
  StoredState stored() const {
    StoredState state;
    std::uint32_t generation = 0;
    EXPECT_EQ(from_record(kept.copies[0], state, generation), StoreStatus::kOk);
    return state;
  }
  void damage(std::size_t copy, std::size_t byte = 10) { kept.copies[copy][byte] ^= 1; }
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
  StoreStatus read(int, hal::StoredBytes&) override { return StoreStatus::kBlank; }
  StoreStatus write(int, const hal::StoredBytes& bytes) override {
    StoredState state;
    std::uint32_t generation = 0;
    EXPECT_EQ(from_record(bytes, state, generation), StoreStatus::kOk);
    if (state.command_counter == counter && first.mode == Mode::kBoot) first = state;
    return StoreStatus::kOk;
  }
  std::uint32_t counter = 1;
  StoredState first;  // the first record with this counter
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
  kept.broken = {true, true};
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(refused_by(CommandRefusal::kNotStored), 1U);
  EXPECT_EQ(events(EventId::kCommandNotStored), 1);
  EXPECT_EQ(argument(EventId::kStateNotStored, 0), 0);
  EXPECT_GE(out->telemetry.state_writes_failed, 1U);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(events(EventId::kStateNotStored), 0) << "reported at the start of the failure only";
  kept.broken = {};
  step_good();
  EXPECT_EQ(kept.copies[0], kept.copies[1]);
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(events(EventId::kStateNotStored), 0);
  EXPECT_EQ(app->mode(), Mode::kSafe);
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
  const int writes = kept.writes;
  step_good();
  EXPECT_EQ(kept.writes, writes) << "nothing has changed";
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
    for (std::size_t byte = 0; byte < hal::kStoredBytes; ++byte) {
      kept = good;
      damage(copy, byte);
      StoredState state;
      std::uint32_t generation = 0;
      ASSERT_EQ(from_record(kept.copies[copy], state, generation), StoreStatus::kDamaged) << byte;
    }
    kept = good;
    damage(copy);
    reset(ResetCause::kWatchdog);
    EXPECT_EQ(app->mode(), Mode::kSafe);
    step_commands({last});
    EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
    EXPECT_EQ(events(EventId::kStoredStateLost), 0);
    EXPECT_EQ(kept.copies[0], kept.copies[1]) << "the damaged copy is written again";
  }
}

TEST_F(Reset, LossOfBothCopiesIsAColdBootInSafeWithAnEvent) {
  use_bank_1();
  step_commands({command(FunctionCode::kSetParameter, {3, 0, 0, 0, 5})});
  damage(0);
  kept.unreadable[1] = true;
  reset(ResetCause::kPowerOn);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  kept.unreadable[1] = false;
  step_good();
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kStoredStateLost);
  EXPECT_EQ(argument(EventId::kStoredStateLost, 0), static_cast<int>(StoreStatus::kDamaged));
  EXPECT_EQ(argument(EventId::kStoredStateLost, 1), static_cast<int>(StoreStatus::kFailed));
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  EXPECT_EQ(out->telemetry.command_counter, 0U);
  EXPECT_EQ(stored().table[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
  reset(ResetCause::kPowerOn);
  step_good();
  EXPECT_EQ(events(EventId::kStoredStateLost), 0) << "the store is in order again";
  EXPECT_EQ(app->mode(), Mode::kSafe);
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

TEST(StoredStateRecord, ValueOutOfItsRangeIsDamage) {
  StoredState good;
  good.table = kInitialTable;
  const auto is_damaged = [](const StoredState& state) {
    StoredState read;
    std::uint32_t generation = 0;
    return from_record(to_record(state, 1), read, generation) == StoreStatus::kDamaged;
  };
  EXPECT_FALSE(is_damaged(good));
  StoredState bad = good;
  bad.mode = static_cast<Mode>(4);
  EXPECT_TRUE(is_damaged(bad));
  bad = good;
  bad.safe_cause = static_cast<Cause>(static_cast<int>(hal::kLastCause) + 1);
  EXPECT_TRUE(is_damaged(bad));
  bad = good;
  bad.safe_fault = static_cast<Fault>(kFaults);
  EXPECT_TRUE(is_damaged(bad));
  bad = good;
  bad.key_slot = hal::kCommandKeySlots;
  EXPECT_TRUE(is_damaged(bad));
  bad = good;
  bad.bank = hal::kModelBanks;
  EXPECT_TRUE(is_damaged(bad));
  for (std::size_t i = 0; i < kTableFields; ++i) {
    bad = good;
    bad.table.fields[i] = UINT32_MAX;
    EXPECT_TRUE(is_damaged(bad)) << i;
  }
}

TEST(StoredStateRecord, OtherFormatIsDamage) {
  StoredState good;
  good.table = kInitialTable;
  for (const std::size_t byte : {0U, 4U, 23U, 25U, 109U}) {
    hal::StoredBytes bytes = to_record(good, 1);
    bytes[byte] ^= 1;
    const std::uint32_t crc = gnc::crc32(bytes.data(), bytes.size() - 4);
    for (std::size_t i = 0; i < 4; ++i)
      bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    StoredState read;
    std::uint32_t generation = 0;
    EXPECT_EQ(from_record(bytes, read, generation), StoreStatus::kDamaged) << byte;
  }
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

TEST_F(KeyRollOver, StoredSlotThatIsEmptyIsNotUsed) {
  step_commands({activate(1, 1)});
  hal::CommandKeys others = kTestKeys;
  others.slots[1] = {};
  boot(*app, {&stopwatch, &store, &others, persistent, hal::ResetCause::kPowerOn});
  step_good();
  EXPECT_EQ(out->telemetry.key_slot, 0);
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
