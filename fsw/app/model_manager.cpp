#include "fsw/app/model_manager.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

void ModelManager::boot(std::uint32_t preferred) {
  state_.banks.in_use = preferred;
  boot_bank(preferred);
  boot_bank(1 - preferred);
}

void ModelManager::boot_bank(std::uint32_t bank) {
  const hal::ModelBank memory = state_.platform.models->bank(static_cast<int>(bank));
  BankDescriptor& descriptor = state_.banks.descriptor[bank];
  descriptor.size_bytes = static_cast<std::uint32_t>(memory.size < UINT32_MAX ? memory.size : UINT32_MAX);
  gnc::ModelStatus& status = state_.boot_status[bank];
  if (!state_.has_model()) {
    status = activate(bank);
    return;
  }
  status = estimator_.check(memory.data, memory.size, state_.expected_target.name());
  if (status != gnc::ModelStatus::kOk) return;
  descriptor.set(BankStatus::kGood);
  descriptor.crc32 = gnc::model_image_crc32(memory.data);
  scrubber_.bank_is_good(bank, state_);
}

void ModelManager::report_boot() {
  if (!state_.boot_to_report) return;
  state_.boot_to_report = false;
  for (std::uint32_t bank = 0; bank < hal::kModelBanks; ++bank) {
    const auto size_bytes = clamp_to_int32(state_.banks.descriptor[bank].size_bytes);
    const gnc::ModelStatus status = state_.boot_status[bank];
    // An empty second bank is no error if the first bank is good.
    const bool needed = bank == 0 || size_bytes > 0, good = status == gnc::ModelStatus::kOk;
    if (good && bank == state_.banks.in_use) {
      report_(EventId::kModelActivated, size_bytes, static_cast<std::int32_t>(bank));
    } else if (!good && needed) {
      report_(EventId::kModelRefused, static_cast<std::int32_t>(status), size_bytes,
              static_cast<std::int32_t>(bank));
    }
  }
  if (state_.mode == Mode::kSafe) {
    report_(EventId::kSafeEntered, static_cast<std::int32_t>(state_.counters.safe_cause), -1);
  }
}

gnc::ModelStatus ModelManager::validate(std::uint32_t size_bytes, std::uint32_t crc32) {
  const std::uint32_t bank = state_.banks.other();
  const std::uint8_t* const image = state_.platform.models->bank(static_cast<int>(bank)).data;
  gnc::ModelStatus status = estimator_.check(image, size_bytes, state_.expected_target.name());
  if (status == gnc::ModelStatus::kOk && gnc::model_image_crc32(image) != crc32)
    status = gnc::ModelStatus::kBadHeaderCrc;
  if (status == gnc::ModelStatus::kOk) {
    state_.banks.descriptor[bank] = {size_bytes, crc32, static_cast<std::uint32_t>(BankStatus::kGood)};
    scrubber_.bank_is_good(bank, state_);
  }
  return status;
}

gnc::ModelStatus ModelManager::activate(std::uint32_t bank) {
  BankDescriptor& descriptor = state_.banks.descriptor[bank];
  const std::uint8_t* const image = state_.platform.models->bank(static_cast<int>(bank)).data;
  const gnc::ModelStatus status =
      estimator_.load(image, descriptor.size_bytes, state_.expected_target.name());
  if (status != gnc::ModelStatus::kOk) {
    descriptor.set(BankStatus::kEmpty);
    return status;
  }
  descriptor.set(BankStatus::kGood);
  descriptor.crc32 = estimator_.model().crc32;
  state_.banks.in_use = bank;
  state_.tracking.forget_track();
  scrubber_.model_activated(estimator_, state_);
  return status;
}

void ModelManager::continue_copy() {
  ModelBanksState& banks = state_.banks;
  if (!state_.has_model()) return;
  const std::int32_t missing = clamp_to_int32(banks.segments_missing);
  if (ModelBanks::continue_copy(*state_.platform.models, banks) != hal::WriteStatus::kFailed) return;
  report_(EventId::kUploadFailed, static_cast<std::int32_t>(banks.other()), missing);
}

Response ModelManager::switch_bank(Fault fault, ModeManager& modes) {
  const std::uint32_t before = state_.banks.in_use, other = state_.banks.other();
  if (state_.banks.status(other) == BankStatus::kGood && activate(other) == gnc::ModelStatus::kOk) {
    count(state_.counters.bank_switches);
    report_(EventId::kBankSwitched, static_cast<std::int32_t>(before), static_cast<std::int32_t>(other));
    return Response::kSwitchBank;
  }
  modes.go_safe(fault);
  return Response::kSafe;
}

}  // namespace tumblesight::fsw
