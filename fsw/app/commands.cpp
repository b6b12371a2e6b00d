// The telecommands: what each of them does, except those of models (model_commands.cpp), and the table of all
// of them at the end.
#include <array>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "fsw/app/command_table.hpp"
#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint8_t kInStandby = 1U << static_cast<int>(Mode::kStandby);
constexpr std::uint8_t kInRun = 1U << static_cast<int>(Mode::kRun);
constexpr std::uint8_t kInSafe = 1U << static_cast<int>(Mode::kSafe);
constexpr std::uint8_t kAlways = kInStandby | kInRun | kInSafe;

bool noop(const Telecommand&, const CommandContext&, Refusal&) {
  return true;
}

// Keeps the fields that are not statistics: the authentication counter of the last command and the cause of
// the last SAFE. Events that are still waiting count as raised after the reset.
bool reset_counters(const Telecommand&, const CommandContext& context, Refusal&) {
  hal::Telemetry& counters = context.state.counters;
  const hal::Telemetry before = counters;
  counters = hal::Telemetry{};
  counters.command_counter = before.command_counter;
  counters.safe_cause = before.safe_cause;
  counters.safe_fault = before.safe_fault;
  counters.events = context.events.waiting();
  return true;
}

bool set_mode(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const std::uint8_t mode = command.u8_at(0);
  Cause cause = Cause::kNone;
  if (mode == static_cast<std::uint8_t>(Mode::kStandby)) cause = Cause::kCommandStandby;
  if (mode == static_cast<std::uint8_t>(Mode::kRun)) cause = Cause::kCommandRun;
  if (mode == static_cast<std::uint8_t>(Mode::kSafe)) cause = Cause::kCommandSafe;
  if (cause == Cause::kNone) return refuse(refusal, CommandRefusal::kWrongArgument);
  Mode to = context.state.mode;
  if (!next_mode(context.state.mode, cause, to)) return refuse(refusal, CommandRefusal::kWrongMode);
  if (cause == Cause::kCommandRun && !context.state.has_model())
    return refuse(refusal, CommandRefusal::kNoModel);
  return context.modes.enter(cause);
}

bool reset_sequence(const Telecommand&, const CommandContext& context, Refusal&) {
  context.modes.reset_estimator();
  return true;
}

// Memory that MEMORY_DUMP reads.
struct DumpedRegion {
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
};

// `table`: room for a table as it is dumped.
DumpedRegion region_of(hal::DumpedMemory memory, const AppState& state, TableBytes& table) {
  switch (memory) {
    case hal::DumpedMemory::kBank0:
    case hal::DumpedMemory::kBank1: {
      const hal::ModelBank bank = state.platform.models->bank(static_cast<int>(memory));
      return {bank.data, bank.data == nullptr ? 0 : bank.capacity};
    }
    case hal::DumpedMemory::kMissingSegments:
      return {state.banks.missing.data(), state.banks.missing.size()};
    case hal::DumpedMemory::kActiveTable:
    case hal::DumpedMemory::kLoadedTable:
      break;
  }
  const bool is_active = memory == hal::DumpedMemory::kActiveTable;
  table = to_bytes(is_active ? state.table : state.loaded_table.table);
  return {table.data(), table.size()};
}

bool dump_memory(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const auto memory = static_cast<hal::DumpedMemory>(command.u8_at(0));
  const std::uint32_t offset = command.u32_at(1), size = command.u16_at(5);
  if (memory > hal::DumpedMemory::kLoadedTable || size < 1 || size > hal::MemoryDump::kMaxBytes)
    return refuse(refusal, CommandRefusal::kWrongArgument);
  TableBytes table;
  const DumpedRegion region = region_of(memory, context.state, table);
  if (size > region.bytes || offset > region.bytes - size)
    return refuse(refusal, CommandRefusal::kWrongArgument);
  const bool is_bank = memory <= hal::DumpedMemory::kBank1;
  if (is_bank && !is_readable(command.u8_at(0), context, refusal)) return false;
  if (context.outputs.has_dump) return refuse(refusal, CommandRefusal::kBusy);
  context.outputs.has_dump = true;
  hal::MemoryDump& dump = context.outputs.dump;
  dump.time_ns = context.state.now_ns;
  dump.memory = memory;
  dump.offset = offset;
  dump.size = static_cast<std::uint16_t>(size);
  dump.bytes = {};
  std::memcpy(dump.bytes.data(), region.data + offset, size);
  return true;
}

bool set_parameter(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const std::uint8_t field = command.u8_at(0);
  const std::uint32_t value = command.u32_at(1);
  if (field >= kTableFields) return refuse(refusal, CommandRefusal::kWrongArgument, field);
  ParameterTable table = context.state.table;
  table.fields[field] = value;
  if (first_wrong_field(table) < kTableFields) return refuse(refusal, CommandRefusal::kWrongArgument, field);
  context.state.table = table;
  return true;
}

// Details of a refused table. A field that is not allowed is named by its number.
constexpr std::int32_t kOtherTableFormat = -1, kWrongTableCrc = -2, kNoSuchTable = -3;

bool load_table(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  LoadedTable& loaded = context.state.loaded_table;
  const auto bytes = static_cast<std::size_t>(command.argument_bytes);
  const TableFormat format = from_bytes(command.arguments, bytes, loaded.table);
  if (format != TableFormat::kOk) {
    const std::int32_t detail = format == TableFormat::kOther ? kOtherTableFormat : kWrongTableCrc;
    return refuse(refusal, CommandRefusal::kWrongArgument, detail);
  }
  loaded.status = TableStatus::kLoaded;
  return true;
}

// Whether the command names the table that was uplinked, and it has come as far as `least`.
bool is_named(const Telecommand& command, const LoadedTable& loaded, TableStatus least) {
  return loaded.status >= least && crc32_of(loaded.table) == command.u32_at(0);
}

bool validate_table(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  LoadedTable& loaded = context.state.loaded_table;
  if (!is_named(command, loaded, TableStatus::kLoaded))
    return refuse(refusal, CommandRefusal::kWrongArgument, kNoSuchTable);
  const std::size_t wrong = first_wrong_field(loaded.table);
  if (wrong < kTableFields)
    return refuse(refusal, CommandRefusal::kWrongArgument, static_cast<std::int32_t>(wrong));
  loaded.status = TableStatus::kValidated;
  return true;
}

bool activate_table(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  LoadedTable& loaded = context.state.loaded_table;
  if (!is_named(command, loaded, TableStatus::kValidated))
    return refuse(refusal, CommandRefusal::kWrongArgument, kNoSuchTable);
  context.state.table = loaded.table;
  loaded.status = TableStatus::kEmpty;
  return true;
}

bool set_response(const Telecommand& command, const CommandContext& context, bool enabled, Refusal& refusal) {
  const std::uint8_t fault = command.u8_at(0);
  const bool known = context.state.faults.enable(fault, enabled);
  return known ? true : refuse(refusal, CommandRefusal::kWrongArgument, fault);
}

bool enable_response(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  return set_response(command, context, true, refusal);
}

bool disable_response(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  return set_response(command, context, false, refusal);
}

// The proof shows that the ground holds the key of the new slot before the old one becomes invalid.
bool activate_key(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  CommandAuthority& authority = context.state.authority;
  const std::uint8_t slot = command.u8_at(0);
  if (!authority.has_key(slot)) return refuse(refusal, CommandRefusal::kWrongArgument, slot);
  const gnc::Sha256Digest proof = authority.proof_of_key(slot, context.state.counters.command_counter);
  if (!gnc::equal_in_constant_time(proof.data(), command.arguments + 1, hal::kCommandMacBytes))
    return refuse(refusal, CommandRefusal::kWrongArgument, slot);
  const std::uint32_t before = authority.slot();
  (void)authority.use(slot);
  // Otherwise the old key would be valid again after a reset. So it is if the store was given up, which
  // StateKeeper reports: after the loss of the stored counter too, only another key ends replays.
  if (!context.keeper.store_now()) {
    (void)authority.use(before);
    return refuse(refusal, CommandRefusal::kNotStored, slot);
  }
  context.report(EventId::kKeyActivated, static_cast<std::int32_t>(before), slot);
  return true;
}

using Handler = bool (*)(const Telecommand&, const CommandContext&, Refusal&);

// No default: a telecommand without a handler does not compile.
constexpr Handler handler_of(FunctionCode function) {
  switch (function) {
    case FunctionCode::kNoop:
      return noop;
    case FunctionCode::kResetCounters:
      return reset_counters;
    case FunctionCode::kSetMode:
      return set_mode;
    case FunctionCode::kResetSequence:
      return reset_sequence;
    case FunctionCode::kModelLoad:
      return load_model;
    case FunctionCode::kModelValidate:
      return validate_model;
    case FunctionCode::kModelActivate:
      return activate_model;
    case FunctionCode::kMemoryDump:
      return dump_memory;
    case FunctionCode::kSetParameter:
      return set_parameter;
    case FunctionCode::kEnableResponse:
      return enable_response;
    case FunctionCode::kDisableResponse:
      return disable_response;
    case FunctionCode::kKeyActivate:
      return activate_key;
    case FunctionCode::kModelBegin:
      return begin_model;
    case FunctionCode::kTableLoad:
      return load_table;
    case FunctionCode::kTableValidate:
      return validate_table;
    case FunctionCode::kTableActivate:
      return activate_table;
  }
  return nullptr;
}

struct ArgumentBytes {
  int least, most;
};

constexpr CommandRule rule_of(FunctionCode function, std::uint8_t modes,
                              std::initializer_list<ArgumentBytes> arguments) {
  CommandRule rule{function, 0, 0, modes};
  for (const ArgumentBytes& argument : arguments) {
    rule.min_argument_bytes += argument.least;
    rule.max_argument_bytes += argument.most;
  }
  return rule;
}

#define TUMBLESIGHT_NUMBER(name, bytes, least, most, meaning) \
  ArgumentBytes {                                             \
    bytes, bytes                                              \
  }
#define TUMBLESIGHT_ENUMERATOR(name, enumeration, least, most, meaning) \
  ArgumentBytes {                                                       \
    1, 1                                                                \
  }
#define TUMBLESIGHT_BYTES(name, least, most, meaning) \
  ArgumentBytes {                                     \
    least, most                                       \
  }
#define TUMBLESIGHT_TELECOMMAND(code, name, modes, ...) rule_of(FunctionCode::k##name, modes, {__VA_ARGS__}),
constexpr std::array kRules{
#include "hal/messages/telecommands.inc"
};
#undef TUMBLESIGHT_NUMBER
#undef TUMBLESIGHT_ENUMERATOR
#undef TUMBLESIGHT_BYTES
#undef TUMBLESIGHT_TELECOMMAND

constexpr bool every_function_has_one_row() {
  int largest = 0;
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (kRules[i].function == kRules[j].function) return false;
    }
    largest = gnc::max<int>(largest, kRules[i].max_argument_bytes);
  }
  return largest == hal::kMaxCommandArgumentBytes;
}
static_assert(every_function_has_one_row(),
              "a function code stands in two rows, or the longest arguments do not fill the largest packet");

// The handler is a constant, so this is a direct call: the analysis of the worst-case stack follows no
// pointers.
template <std::size_t kRow>
bool call(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  constexpr Handler kHandler = handler_of(kRules[kRow].function);
  return kHandler(command, context, refusal);
}

// One comparison per row.
template <std::size_t... kRow>
bool dispatch(std::index_sequence<kRow...>, const Telecommand& command, const CommandContext& context,
              Refusal& refusal) {
  bool done = false;
  ((kRules[kRow].function == command.function
        ? static_cast<void>(done = call<kRow>(command, context, refusal))
        : static_cast<void>(0)),
   ...);
  return done;
}

}  // namespace

const CommandRule* find_command(std::uint8_t function) {
  for (const CommandRule& rule : kRules) {
    if (static_cast<std::uint8_t>(rule.function) == function) return &rule;
  }
  return nullptr;
}

bool carry_out(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  return dispatch(std::make_index_sequence<kRules.size()>{}, command, context, refusal);
}

}  // namespace tumblesight::fsw
