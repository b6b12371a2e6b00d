#include "fsw/app/memory_guard.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

hal::ModelBank bank_in_use(const AppState& state) {
  return state.platform.models->bank(static_cast<int>(state.banks.in_use));
}

}  // namespace

void MemoryGuard::model_activated(const Estimator& estimator, AppState& state) {
  banks_.make_table(*state.platform.models, state.banks);
  state.constants_crc32 = estimator.constants_crc32();
}

void MemoryGuard::keep(const Estimator& estimator, AppState& state) {
  estimator.save(kept_);
  state.estimator_crc32 = estimator.state_crc32();
}

void MemoryGuard::check(Estimator& estimator, AppState& state, const Reporter& report) {
  check_state(estimator, state, report);
  if (!state.has_model()) return;
  check_table(estimator, state, report);
  for (std::uint32_t i = 0; i < state.limit(Limit::kScrubBlocks) && state.has_model(); ++i)
    check_block(state, report);
  if (state.has_model()) check_constants(estimator, state, report);
}

void MemoryGuard::check_state(Estimator& estimator, AppState& state, const Reporter& report) {
  if (estimator.state_crc32() == state.estimator_crc32) return;
  if (Estimator::crc32_of(kept_) == state.estimator_crc32) {
    estimator.restore(kept_);
    count(state.counters.states_restored);
    report(EventId::kStateRestored);
  } else {
    estimator.reset();
    count(state.counters.states_lost);
    state.faults_seen |= bit_of(Fault::kStateLost);
  }
}

// Reloads the constants from the bank, after a check of all its blocks.
void MemoryGuard::check_constants(Estimator& estimator, AppState& state, const Reporter& report) {
  if (estimator.constants_crc32() == state.constants_crc32) return;
  for (std::uint32_t i = 0; i < ModelBanks::kBlocks && state.has_model(); ++i) check_block(state, report);
  if (!state.has_model()) return;
  estimator.reload(bank_in_use(state).data);
  if (estimator.constants_crc32() == state.constants_crc32) {
    count(state.counters.constants_reloaded);
    report(EventId::kConstantsReloaded, static_cast<std::int32_t>(state.banks.in_use));
  } else {
    lose_model(state);  // the image is not the one that was activated
  }
}

void MemoryGuard::check_table(const Estimator& estimator, AppState& state, const Reporter& report) {
  if (banks_.table_is_sound(state.banks)) return;
  const BankDescriptor& descriptor = state.banks.descriptor[state.banks.in_use];
  if (estimator.check(bank_in_use(state).data, descriptor.size_bytes, state.expected_target) !=
      gnc::ModelStatus::kOk) {
    lose_model(state);
    return;
  }
  banks_.make_table(*state.platform.models, state.banks);
  count(state.counters.model_tables_rebuilt);
  report(EventId::kModelTableRebuilt, static_cast<std::int32_t>(state.banks.in_use));
}

void MemoryGuard::check_block(AppState& state, const Reporter& report) {
  const BlockCheck checked = banks_.check_block(*state.platform.models, state.banks);
  if (state.banks.next_block == 0) count(state.counters.model_passes);
  const auto bank = static_cast<std::int32_t>(checked.bank), block = static_cast<std::int32_t>(checked.block);
  switch (checked.result) {
    case BlockCheck::Result::kGood:
      break;
    case BlockCheck::Result::kRepaired:
      count(state.counters.model_blocks_repaired);
      report(EventId::kModelRepaired, bank, block);
      break;
    case BlockCheck::Result::kLost:
      count(state.counters.model_blocks_lost);
      report(EventId::kModelBlockLost, bank, block);
      lose_model(state);
      break;
  }
}

void MemoryGuard::lose_model(AppState& state) {
  state.banks.descriptor[state.banks.in_use].set(BankStatus::kEmpty);
  state.faults_seen |= bit_of(Fault::kModelCorrupted);
}

}  // namespace tumblesight::fsw
