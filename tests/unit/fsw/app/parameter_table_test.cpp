// The parameter table: its format, its ranges, and the telecommands that load, validate and activate it.
// Verifies TS-CMD-170, TS-CMD-180.
#include "fsw/app/parameter_table.hpp"

#include "gnc/numerics/crc.hpp"
#include "hal/fake/fake_persistent_store.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

bool is_accepted(std::size_t field, std::uint32_t value) {
  ParameterTable table = kInitialTable;
  table.fields[field] = value;
  return first_wrong_field(table) == kTableFields;
}

constexpr std::uint32_t rule_field(int cycles, int window, int good, Response response) {
  return static_cast<std::uint32_t>(cycles << 24 | window << 16 | good << 8 | static_cast<int>(response));
}
constexpr std::size_t field_of(Fault fault) {
  return kParameters + static_cast<std::size_t>(fault);
}

TEST(ParameterTable, FieldsAreBigEndianBehindVersionAndNumberAndBeforeTheCrc) {
  ParameterTable table = kInitialTable;
  table[Parameter::kPredictedError_urad] = 0x01020304;
  const TableBytes bytes = to_bytes(table);
  const std::vector<std::uint8_t> head(bytes.begin(), bytes.begin() + 8);
  EXPECT_EQ(head, (std::vector<std::uint8_t>{0, 1, 0, kTableFields, 1, 2, 3, 4}));
  EXPECT_EQ(bytes.size(), 8 + 4 * kTableFields);
  EXPECT_EQ(gnc::crc32(bytes.data(), bytes.size() - 4), crc32_of(table));
  ParameterTable read;
  EXPECT_EQ(from_bytes(bytes.data(), bytes.size(), read), TableFormat::kOk);
  EXPECT_EQ(read.fields, table.fields);
}

TEST(ParameterTable, EveryFlippedBitIsRefusedAndChangesNothing) {
  TableBytes bytes = to_bytes(kInitialTable);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    ParameterTable read;
    EXPECT_EQ(from_bytes(bytes.data(), bytes.size(), read),
              bit < 32 ? TableFormat::kOther : TableFormat::kWrongCrc);
    EXPECT_EQ(read.fields, ParameterTable{}.fields);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

TEST(ParameterTable, EveryParameterHasItsRangeAndStartsWithinIt) {
  for (std::size_t field = 0; field < kParameters; ++field) {
    const config::ParameterRule& rule = config::kParameterRules[field];
    EXPECT_TRUE(is_accepted(field, rule.lowest)) << field;
    EXPECT_TRUE(is_accepted(field, rule.highest)) << field;
    EXPECT_FALSE(is_accepted(field, rule.lowest - 1)) << field;
    EXPECT_FALSE(is_accepted(field, rule.highest + 1)) << field;
  }
  EXPECT_EQ(first_wrong_field(kInitialTable), kTableFields);
}

TEST(ParameterTable, FaultRulesThatAreImpossibleOrProtectTheModelAreNotTaken) {
  for (const config::FaultRule& rule : config::kFaultRules) {
    const std::size_t field = field_of(rule.fault);
    EXPECT_TRUE(is_accepted(field, kInitialTable.fields[field]));
    EXPECT_EQ(is_accepted(field, rule_field(2, 5, 7, Response::kSafe)), rule.can_be_disabled);
    EXPECT_EQ(is_accepted(field, rule_field(32, 32, 255, Response::kIgnore)), rule.can_be_disabled);
    EXPECT_FALSE(is_accepted(field, rule_field(0, 5, 7, Response::kFlag))) << "no cycles";
    EXPECT_FALSE(is_accepted(field, rule_field(2, 5, 0, Response::kFlag))) << "no good cycles";
    EXPECT_FALSE(is_accepted(field, rule_field(6, 5, 7, Response::kFlag)))
        << "more cycles than the window has";
    EXPECT_FALSE(is_accepted(field, rule_field(6, 33, 7, Response::kFlag))) << "a window beyond the history";
    EXPECT_FALSE(is_accepted(field, rule_field(2, 5, 7, static_cast<Response>(5)))) << "no such response";
  }
}

TEST(ParameterTable, FirstWrongFieldIsNamed) {
  for (std::size_t field = 0; field < kTableFields; ++field) {
    ParameterTable table = kInitialTable;
    table.fields[field] = UINT32_MAX;
    EXPECT_EQ(first_wrong_field(table), field);
    table.fields[kTableFields - 1] = UINT32_MAX;
    EXPECT_EQ(first_wrong_field(table), field);
  }
}

class Tables : public AppFixture {
 protected:
  Tables() {
    persistent = &kept;
    checks_attitudes = true;  // with the limits of the table
    init_with_model();
  }
  hal::CommandPacket load(const TableBytes& bytes) {
    return command(FunctionCode::kTableLoad, {bytes.begin(), bytes.end()});
  }
  hal::CommandPacket load(const ParameterTable& table) { return load(to_bytes(table)); }
  hal::CommandPacket named(FunctionCode function, std::uint32_t crc32) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, crc32);
    return command(function, arguments);
  }
  hal::CommandPacket validate(const ParameterTable& table) {
    return named(FunctionCode::kTableValidate, crc32_of(table));
  }
  hal::CommandPacket activate(const ParameterTable& table) {
    return named(FunctionCode::kTableActivate, crc32_of(table));
  }
  hal::CommandPacket set(std::size_t field, std::uint32_t value) {
    std::vector<std::uint8_t> arguments{static_cast<std::uint8_t>(field)};
    append_u32(arguments, value);
    return command(FunctionCode::kSetParameter, arguments);
  }
  const ParameterTable& active() { return AppMemory::state(*app).table; }
  std::vector<std::uint8_t> dump(hal::DumpedMemory memory) {
    step_commands({command(FunctionCode::kMemoryDump,
                           {static_cast<std::uint8_t>(memory), 0, 0, 0, 0, 0, kTableBytes})});
    EXPECT_TRUE(out->has_dump);
    return {out->dump.bytes.begin(), out->dump.bytes.begin() + kTableBytes};
  }
  // The detail of the only refusal of the cycle.
  std::int32_t refused() const { return argument(EventId::kCommandWrongArgument, 2); }

  hal::fake::FakePersistentStore kept;
};

// Every field has another value than after init().
ParameterTable another_table() {
  ParameterTable table = kInitialTable;
  for (std::size_t field = 0; field < kParameters; ++field) table.fields[field] -= 1;
  for (const config::FaultRule& rule : config::kFaultRules) {
    if (rule.can_be_disabled) table.fields[field_of(rule.fault)] += 1U << 8;
  }
  return table;
}

TEST_F(Tables, LoadedValidatedAndActivatedItIsInUseAndCanBeDumped) {
  const ParameterTable table = another_table();
  ASSERT_EQ(first_wrong_field(table), kTableFields);
  const TableBytes before = to_bytes(kInitialTable), bytes = to_bytes(table);
  step_commands({load(table)});
  EXPECT_EQ(out->telemetry.table_status, TableStatus::kLoaded);
  EXPECT_EQ(out->telemetry.table_crc32, crc32_of(active())) << "of the table in use";
  EXPECT_EQ(dump(hal::DumpedMemory::kLoadedTable), std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  step_commands({validate(table)});
  EXPECT_EQ(out->telemetry.table_status, TableStatus::kValidated);
  EXPECT_EQ(active()[Parameter::kScrubBlocks], initial(Parameter::kScrubBlocks));
  step_commands({activate(table)});
  EXPECT_EQ(active().fields, table.fields);
  EXPECT_EQ(out->telemetry.table_status, TableStatus::kEmpty);
  EXPECT_EQ(out->telemetry.table_crc32, crc32_of(table));
  EXPECT_EQ(dump(hal::DumpedMemory::kActiveTable), std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  step_commands({activate(table)});
  EXPECT_EQ(refused(), -3) << "it is active by now";
  EXPECT_NE(before, bytes);
}

TEST_F(Tables, OtherFormatWrongCrcOrAnotherNameIsRefused) {
  const ParameterTable table = another_table();
  step_commands({validate(table)});
  EXPECT_EQ(refused(), -3) << "nothing was loaded";
  TableBytes bytes = to_bytes(table);
  step_commands({command(FunctionCode::kTableLoad, {bytes.begin(), bytes.end() - 1})});
  EXPECT_EQ(refused(), -1);
  bytes[1] = 2;
  step_commands({load(bytes)});
  EXPECT_EQ(refused(), -1);
  bytes[1] = 1;
  bytes.back() ^= 1;
  step_commands({load(bytes)});
  EXPECT_EQ(refused(), -2);
  EXPECT_EQ(out->telemetry.table_status, TableStatus::kEmpty);
  step_commands({load(table)});
  step_commands({activate(table)});
  EXPECT_EQ(refused(), -3) << "it was not validated";
  step_commands({named(FunctionCode::kTableValidate, crc32_of(table) + 1)});
  EXPECT_EQ(refused(), -3);
  step_commands({validate(table), named(FunctionCode::kTableActivate, crc32_of(table) + 1)});
  EXPECT_EQ(refused(), -3);
  EXPECT_EQ(out->telemetry.table_crc32, crc32_of(active()));
}

TEST_F(Tables, FieldThatIsNotAllowedIsNamedAndTheTableNotActivated) {
  for (std::size_t field = 0; field < kTableFields; ++field) {
    init_with_model();
    ParameterTable table = kInitialTable;
    table.fields[field] = UINT32_MAX;
    step_commands({load(table), validate(table)});
    EXPECT_EQ(refused(), static_cast<std::int32_t>(field));
    step_commands({activate(table)});
    EXPECT_EQ(refused(), -3);
    EXPECT_TRUE(is_accepted(field, active().fields[field]));
  }
}

TEST_F(Tables, TableThatIsHitAfterItsValidationIsNotActivated) {
  const ParameterTable table = another_table();
  step_commands({load(table), validate(table)});
  AppMemory::state(*app).loaded_table.table.fields[3] ^= 1;
  AppMemory::commit(*app);
  step_commands({activate(table)});
  EXPECT_EQ(refused(), -3);
}

// Verifies TS-CMD-140.
TEST_F(Tables, OneFieldIsSetWithinItsRangeOnly) {
  for (std::size_t field = 0; field < kTableFields; ++field) {
    init_with_model();
    const std::uint32_t value = another_table().fields[field];
    step_commands({set(field, value), set(field, UINT32_MAX)});
    EXPECT_EQ(active().fields[field], value);
    EXPECT_EQ(refused(), static_cast<std::int32_t>(field));
  }
  step_commands({set(kTableFields, 1)});
  EXPECT_EQ(refused(), static_cast<std::int32_t>(kTableFields));
}

// Verifies TS-RST-010.
TEST_F(Tables, ActiveTableStaysThroughAReset) {
  const ParameterTable table = another_table();
  step_commands({load(table), validate(table), activate(table)});
  init(store);
  step(StepInputs{});
  EXPECT_EQ(out->telemetry.table_crc32, crc32_of(table));
  EXPECT_EQ(active().fields, table.fields);
}

// Of a platform that keeps tables itself.
TEST_F(Tables, GivenTableIsUsedAndStoredUnlessAFieldIsNotAllowed) {
  step_good();
  ParameterTable table = another_table();
  ASSERT_TRUE(app->use(table));
  step_good();
  EXPECT_EQ(active().fields, table.fields);
  table[Parameter::kScrubBlocks] = 17;
  EXPECT_FALSE(app->use(table));
  init(store);
  step(StepInputs{});
  EXPECT_EQ(active().fields, another_table().fields) << "from the store";
}

// Memory may need some time after power-on: what is read later is older than the table that was given.
TEST_F(Tables, GivenTableIsNotReplacedByAStoredOneThatIsReadLate) {
  step_commands({set(static_cast<std::size_t>(Parameter::kScrubBlocks), 5)});
  kept.unreadable = {true, true};
  init(store);
  const ParameterTable table = another_table();
  ASSERT_TRUE(app->use(table));
  kept.unreadable = {};
  step(StepInputs{});
  EXPECT_EQ(active().fields, table.fields);
}

TEST_F(Tables, BitFlipsThatAreFoundWhenATableIsGivenAreReported) {
  step_good();
  AppMemory::redundant_state(*app).flip(8 * sizeof(AppState) + 3);  // in the second copy
  ASSERT_TRUE(app->use(another_table()));
  step_good();
  EXPECT_EQ(argument(EventId::kMemoryCorrected, 0), 1);
  EXPECT_EQ(out->telemetry.memory_corrections, 1U);
  step_good();
  EXPECT_EQ(events(EventId::kMemoryCorrected), 0);
}

TEST_F(Tables, AgesTolerancesAndCoastAreThoseOfTheTable) {
  step_good();
  step_commands({set(static_cast<std::size_t>(Parameter::kMaxFrameAge_ms), 500)});
  gnc::RangeImage late = next_frame();
  late.exposure_time_ns -= 600'000'000;
  EXPECT_EQ(app->judge(late, next_time_ns()), gnc::FrameVerdict::kStale);
  late.exposure_time_ns += 200'000'000;
  EXPECT_EQ(app->judge(late, next_time_ns()), gnc::FrameVerdict::kPass);
  late.exposure_time_ns = next_time_ns() + 5'000'000;
  EXPECT_EQ(app->judge(late, next_time_ns()), gnc::FrameVerdict::kFromFuture);
  step_commands({set(static_cast<std::size_t>(Parameter::kFutureTolerance_us), 6'000)});
  late.exposure_time_ns = next_time_ns() + 5'000'000;
  EXPECT_EQ(app->judge(late, next_time_ns()), gnc::FrameVerdict::kPass);
  step_good();
  step_commands({set(static_cast<std::size_t>(Parameter::kLongestCoast_ms), 3'000)});
  step_good();
  EXPECT_EQ(events(EventId::kEstimatorResetByGap), 1) << "two periods after the last frame";
}

TEST_F(Tables, FaultRulesAreThoseOfTheTable) {
  step_good();
  step_commands({set(field_of(Fault::kOutage), rule_field(2, 3, 1, Response::kSafe))});
  EXPECT_EQ(app->mode(), Mode::kRun);
  step(StepInputs{});
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.safe_fault, Fault::kOutage);
}

TEST_F(Tables, IgnoredFaultIsOnlyShown) {
  step_good();
  step_commands({set(field_of(Fault::kOutage), rule_field(2, 3, 1, Response::kIgnore))});
  step(StepInputs{});
  EXPECT_NE(out->telemetry.faults_persisting & bit_of(Fault::kOutage), 0U);
  EXPECT_EQ(events(EventId::kFaultPersists), 0);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

TEST_F(Tables, EventsOfAKindAndTheirWindowAreThoseOfTheTable) {
  step_commands({set(static_cast<std::size_t>(Parameter::kEventsOfAKind), 2),
                 set(static_cast<std::size_t>(Parameter::kEventWindow_cycles), 1)});
  step_commands({set_mode(Mode::kSafe), set_mode(Mode::kSafe), set_mode(Mode::kSafe), set_mode(Mode::kSafe)});
  EXPECT_EQ(events(EventId::kCommandAccepted), 2);
  EXPECT_EQ(argument(EventId::kEventsSuppressed, 1), 2);
}

}  // namespace
}  // namespace tumblesight::fsw
