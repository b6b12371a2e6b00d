// What each telecommand does.
#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

static_assert(hal::Housekeeping::kRefusals == kCommandRefusals);
static_assert(hal::ModelDump::kMaxBytes == kMaxModelSegmentBytes);

template <class N>
void AttitudeInitApp<N>::run_commands(const StepInputs& inputs, StepOutputs& outputs,
                                      const Reporter& report) {
  hal::Housekeeping& counters = state_->counters;
  for (int i = 0; i < inputs.command_count; ++i) {
    const hal::CommandPacket& packet = inputs.commands[static_cast<std::size_t>(i)];
    const Mode before = state_->mode;
    Admission admission = judge(packet, state_->platform.command_key, counters.command_counter, before);
    if (admission.authentic) counters.command_counter = admission.counter;
    std::int32_t detail = 0;
    if (admission.admitted && carry_out(admission.command, outputs, admission.why, detail, report)) {
      count(state_->counters.commands_accepted);
      report(EventId::kCommandAccepted, admission.function, static_cast<std::int32_t>(before),
             static_cast<std::int32_t>(state_->mode));
      continue;
    }
    count(counters.commands_refused);
    count(counters.commands_refused_by[static_cast<std::size_t>(admission.why)]);
    report(event_of(admission.why), admission.function, packet.size, detail);
  }
}

// False: refused, `why` and perhaps `detail` say what for; nothing has been done.
template <class N>
bool AttitudeInitApp<N>::carry_out(const Telecommand& command, StepOutputs& outputs, CommandRefusal& why,
                                   std::int32_t& detail, const Reporter& report) {
  switch (command.function) {
    case FunctionCode::kNoop:
      return true;
    case FunctionCode::kResetCounters:
      reset_counters();
      return true;
    case FunctionCode::kSetMode:
      return set_mode(command.u8_at(0), why);
    case FunctionCode::kResetSequence:
      reset_estimator();
      return true;
    case FunctionCode::kModelLoad:
      return load_segment(command, why, detail);
    case FunctionCode::kModelValidate:
      return validate_model(command, why, detail, report);
    case FunctionCode::kModelActivate:
      return activate_model(command, why, detail, report);
    case FunctionCode::kModelDump:
      return dump_model(command, outputs, why);
    case FunctionCode::kSetLimit:
      return set_limit(command, why, detail);
    case FunctionCode::kEnableResponse:
    case FunctionCode::kDisableResponse:
      why = CommandRefusal::kWrongArgument;
      detail = command.u8_at(0);
      return state_->faults.enable(command.u8_at(0), command.function == FunctionCode::kEnableResponse);
  }
  return false;
}

// What is no count stays: the command counter, why the mode is SAFE. Events that still wait will be told,
// hence count anew.
template <class N>
void AttitudeInitApp<N>::reset_counters() {
  const hal::Housekeeping before = state_->counters;
  state_->counters = hal::Housekeeping{};
  state_->counters.command_counter = before.command_counter;
  state_->counters.safe_cause = before.safe_cause;
  state_->counters.safe_fault = before.safe_fault;
  state_->counters.events = events_.waiting();
}

template <class N>
bool AttitudeInitApp<N>::set_mode(std::uint8_t mode, CommandRefusal& why) {
  Cause cause = Cause::kNone;
  if (mode == static_cast<std::uint8_t>(Mode::kStandby)) cause = Cause::kCommandStandby;
  if (mode == static_cast<std::uint8_t>(Mode::kRun)) cause = Cause::kCommandRun;
  if (mode == static_cast<std::uint8_t>(Mode::kSafe)) cause = Cause::kCommandSafe;
  why = CommandRefusal::kWrongArgument;
  if (cause == Cause::kNone) return false;
  why = CommandRefusal::kWrongMode;
  Mode to = state_->mode;
  if (!next_mode(state_->mode, cause, to)) return false;
  why = CommandRefusal::kNoModel;
  if (cause == Cause::kCommandRun && !state_->has_model()) return false;
  return enter(cause);
}

template <class N>
bool AttitudeInitApp<N>::load_segment(const Telecommand& command, CommandRefusal& why, std::int32_t& detail) {
  constexpr int kOffsetBytes = 4;
  ModelBanksState& banks = state_->banks;
  why = CommandRefusal::kWrongArgument;
  detail = clamp_to_int32(banks.loaded_bytes);  // where the next segment belongs
  return ModelBanks<N>::load(*state_->platform.models, banks, command.u32_at(0),
                             command.arguments + kOffsetBytes,
                             static_cast<std::uint32_t>(command.argument_bytes - kOffsetBytes));
}

template <class N>
bool AttitudeInitApp<N>::validate_model(const Telecommand& command, CommandRefusal& why, std::int32_t& detail,
                                        const Reporter& report) {
  ModelBanksState& banks = state_->banks;
  const std::uint32_t bank = banks.other(), size_bytes = command.u32_at(0), crc32 = command.u32_at(4);
  why = CommandRefusal::kNoModel;
  if (banks.status(bank) != BankStatus::kLoading || size_bytes != banks.loaded_bytes) return false;
  const std::uint8_t* const image = state_->platform.models->bank(static_cast<int>(bank)).data;
  gnc::ModelStatus status = estimator_.check(image, size_bytes, state_->expected_target);
  if (status == gnc::ModelStatus::kOk && gnc::model_image_crc32(image) != crc32)
    status = gnc::ModelStatus::kBadHeaderCrc;
  if (status != gnc::ModelStatus::kOk) {
    detail = static_cast<std::int32_t>(status);
    report(EventId::kModelRefused, detail, clamp_to_int32(size_bytes), static_cast<std::int32_t>(bank));
    return false;
  }
  banks.record[bank] = {size_bytes, crc32, static_cast<std::uint32_t>(BankStatus::kGood)};
  return true;
}

template <class N>
bool AttitudeInitApp<N>::activate_model(const Telecommand& command, CommandRefusal& why, std::int32_t& detail,
                                        const Reporter& report) {
  const std::uint32_t bank = state_->banks.other();
  const ModelBankRecord& record = state_->banks.record[bank];
  why = CommandRefusal::kNoModel;
  if (state_->banks.status(bank) != BankStatus::kGood || record.crc32 != command.u32_at(0)) return false;
  const std::int32_t size_bytes = clamp_to_int32(record.size_bytes);
  const gnc::ModelStatus status = activate(bank);
  if (status != gnc::ModelStatus::kOk) {
    detail = static_cast<std::int32_t>(status);
    report(EventId::kModelRefused, detail, size_bytes, static_cast<std::int32_t>(bank));
    return false;
  }
  report(EventId::kModelActivated, size_bytes, static_cast<std::int32_t>(bank));
  return true;
}

template <class N>
bool AttitudeInitApp<N>::dump_model(const Telecommand& command, StepOutputs& outputs,
                                    CommandRefusal& why) const {
  const std::uint8_t bank = command.u8_at(0);
  const std::uint32_t offset = command.u32_at(1), size = command.u16_at(5);
  why = CommandRefusal::kWrongArgument;
  if (bank >= hal::kModelBanks || size < 1 || size > hal::ModelDump::kMaxBytes) return false;
  const hal::ModelBank memory = state_->platform.models->bank(bank);
  if (memory.data == nullptr || size > memory.capacity || offset > memory.capacity - size) return false;
  why = CommandRefusal::kBusy;
  if (outputs.has_dump) return false;
  outputs.has_dump = true;
  outputs.dump.time_ns = state_->now_ns;
  outputs.dump.bank = bank;
  outputs.dump.offset = offset;
  outputs.dump.size = static_cast<std::uint16_t>(size);
  for (std::uint32_t i = 0; i < hal::ModelDump::kMaxBytes; ++i) {
    outputs.dump.bytes[i] = i < size ? memory.data[offset + i] : std::uint8_t{0};
  }
  return true;
}

template <class N>
bool AttitudeInitApp<N>::set_limit(const Telecommand& command, CommandRefusal& why, std::int32_t& detail) {
  const std::uint8_t which = command.u8_at(0);
  const std::uint32_t value = command.u32_at(1);
  why = CommandRefusal::kWrongArgument;
  detail = which;
  if (which >= kLimits) return false;
  const config::LimitRule& rule = config::kLimitRules[which];
  if (value < rule.lowest || value > rule.highest) return false;
  state_->limits[which] = value;
  return true;
}

#define TUMBLESIGHT_INSTANTIATE(N) \
  template void AttitudeInitApp<N>::run_commands(const StepInputs&, StepOutputs&, const Reporter&)

TUMBLESIGHT_INSTANTIATE(gnc::FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(gnc::Float32);
#endif

}  // namespace tumblesight::fsw
