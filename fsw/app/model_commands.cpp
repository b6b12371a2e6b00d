// The telecommands that load, validate and activate a model image.
#include "fsw/app/command_table.hpp"
#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

// False: the bank cannot be read now, or the cycle has had its long task, and the command is refused.
bool begins_check(std::uint32_t bank, const CommandContext& context, Refusal& refusal) {
  if (!is_readable(bank, context, refusal)) return false;
  if (context.state.begin_long_task()) return true;
  return refuse(refusal, CommandRefusal::kBusy, static_cast<std::int32_t>(bank));
}

bool refuse_model(const CommandContext& context, gnc::ModelStatus status, std::uint32_t size_bytes,
                  std::uint32_t bank, Refusal& refusal) {
  const auto reason = static_cast<std::int32_t>(status);
  context.report(EventId::kModelRefused, reason, clamp_to_int32(size_bytes), static_cast<std::int32_t>(bank));
  return refuse(refusal, CommandRefusal::kNoModel, reason);
}

}  // namespace

bool is_readable(std::uint32_t bank, const CommandContext& context, Refusal& refusal) {
  const auto index = static_cast<int>(bank);
  const hal::BankActivity activity = context.state.platform.models->activity(index);
  if (activity == hal::BankActivity::kReady) return true;
  const bool failed = activity == hal::BankActivity::kFailed;
  return refuse(refusal, failed ? CommandRefusal::kStoreFailed : CommandRefusal::kBusy, index);
}

bool begin_model(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const std::uint8_t base = command.u8_at(0);
  if (base > static_cast<std::uint8_t>(UploadBase::kSameBank))
    return refuse(refusal, CommandRefusal::kWrongArgument, base);
  AppState& state = context.state;
  const auto known = static_cast<UploadBase>(base);
  if (known == UploadBase::kBankInUse && !state.has_model()) return refuse(refusal, CommandRefusal::kNoModel);
  const bool begun = ModelBanks::begin(*state.platform.models, state.banks, known);
  return begun ? true : refuse(refusal, CommandRefusal::kWrongArgument, base);
}

bool load_model(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  constexpr int kOffsetBytes = 4;
  ModelBanksState& banks = context.state.banks;
  if (!banks.is_loading()) return refuse(refusal, CommandRefusal::kNoModel);
  const std::uint32_t offset = command.u32_at(0);
  const auto bytes = static_cast<std::uint32_t>(command.argument_bytes - kOffsetBytes);
  const hal::WriteStatus written = ModelBanks::load(*context.state.platform.models, banks, offset,
                                                    command.arguments + kOffsetBytes, bytes);
  if (written == hal::WriteStatus::kAccepted) return true;
  CommandRefusal why = CommandRefusal::kWrongArgument;
  if (written == hal::WriteStatus::kBusy) why = CommandRefusal::kBusy;
  if (written == hal::WriteStatus::kFailed) why = CommandRefusal::kStoreFailed;
  return refuse(refusal, why, clamp_to_int32(offset));
}

bool validate_model(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const ModelBanksState& banks = context.state.banks;
  const std::uint32_t bank = banks.other(), size_bytes = command.u32_at(0);
  if (!banks.is_loading() || size_bytes != kModelImageBytes) return refuse(refusal, CommandRefusal::kNoModel);
  if (banks.segments_missing > 0)
    return refuse(refusal, CommandRefusal::kIncomplete, clamp_to_int32(banks.segments_missing));
  if (!begins_check(bank, context, refusal)) return false;
  const gnc::ModelStatus status = context.models.validate(size_bytes, command.u32_at(4));
  if (status != gnc::ModelStatus::kOk) return refuse_model(context, status, size_bytes, bank, refusal);
  return true;
}

bool activate_model(const Telecommand& command, const CommandContext& context, Refusal& refusal) {
  const ModelBanksState& banks = context.state.banks;
  const std::uint32_t bank = banks.other(), size_bytes = banks.descriptor[bank].size_bytes;
  if (banks.status(bank) != BankStatus::kGood || banks.descriptor[bank].crc32 != command.u32_at(0))
    return refuse(refusal, CommandRefusal::kNoModel);
  if (!begins_check(bank, context, refusal)) return false;
  const gnc::ModelStatus status = context.models.activate(bank);
  if (status != gnc::ModelStatus::kOk) return refuse_model(context, status, size_bytes, bank, refusal);
  context.report(EventId::kModelActivated, clamp_to_int32(size_bytes), static_cast<std::int32_t>(bank));
  return true;
}

}  // namespace tumblesight::fsw
