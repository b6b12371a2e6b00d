#include "fsw/app/memory_scrubber.hpp"

#include <cstring>

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

hal::ModelBank memory_of(std::uint32_t bank, const AppState& state) {
  return state.platform.models->bank(static_cast<int>(bank));
}

}  // namespace

void MemoryScrubber::bank_is_good(std::uint32_t bank, AppState& state) {
  banks_.make_table(bank, *state.platform.models, state.banks);
}

void MemoryScrubber::model_activated(const Estimator& estimator, AppState& state) {
  bank_is_good(state.banks.in_use, state);
  state.constants_crc32 = estimator.constants_crc32();
}

bool MemoryScrubber::bound(const Estimator& estimator, AppState& state) {
  ModelBanksState& banks = state.banks;
  bool sound = is_mode(state.mode);
  if (banks.in_use >= hal::kModelBanks) {
    banks.in_use = banks.descriptor[0].crc32 == estimator.model().crc32 ? 0 : 1;
    sound = false;
  }
  if (banks.next_block >= ModelBanks::kBlocks) {
    banks.next_block = 0;
    sound = false;
  }
  for (std::size_t i = 0; i < kTableFields; ++i) {
    const std::size_t wrong = first_wrong_field(state.table);
    if (wrong == kTableFields) break;
    state.table.fields[wrong] = kInitialTable.fields[wrong];
    sound = false;
  }
  return sound;
}

void MemoryScrubber::keep(const Estimator& estimator, AppState& state) {
  std::memset(static_cast<void*>(&kept_), 0, sizeof kept_);  // the padding, too, so that no flip stays in it
  estimator.save(kept_);
  state.estimator_crc32 = estimator.state_crc32();
}

void MemoryScrubber::check(Estimator& estimator, AppState& state, const Reporter& report) {
  check_state(estimator, state, report);
  if (!state.has_model()) return;
  if (!has_sound_table(state.banks.in_use, estimator, state, report)) return;
  const std::uint32_t other = state.banks.other();
  if (state.banks.status(other) == BankStatus::kGood && !has_sound_table(other, estimator, state, report))
    return;
  for (std::uint32_t i = 0; i < state.table[Parameter::kScrubBlocks] && state.has_model(); ++i)
    check_block(state, report);
  if (state.has_model()) check_constants(estimator, state, report);
}

void MemoryScrubber::check_state(Estimator& estimator, AppState& state, const Reporter& report) {
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
void MemoryScrubber::check_constants(Estimator& estimator, AppState& state, const Reporter& report) {
  if (estimator.constants_crc32() == state.constants_crc32) return;
  if (!state.begin_long_task()) return;
  for (std::uint32_t i = 0; i < ModelBanks::kBlocks && state.has_model(); ++i) check_block(state, report);
  if (!state.has_model()) return;
  estimator.reload(memory_of(state.banks.in_use, state).data);
  if (estimator.constants_crc32() == state.constants_crc32) {
    count(state.counters.constants_reloaded);
    report(EventId::kConstantsReloaded, static_cast<std::int32_t>(state.banks.in_use));
  } else {
    lose_model(state);  // the image is not the one that was activated
  }
}

bool MemoryScrubber::has_sound_table(std::uint32_t bank, const Estimator& estimator, AppState& state,
                                     const Reporter& report) {
  if (banks_.table_is_sound(bank, state.banks)) return true;
  const bool restored = banks_.restore_table(bank, state.banks);
  if (!restored && !state.begin_long_task()) return false;
  if (restored || rebuild_table(bank, estimator, state)) {
    count(state.counters.model_tables_rebuilt);
    report(EventId::kModelTableRebuilt, static_cast<std::int32_t>(bank));
    return true;
  }
  if (bank == state.banks.in_use) {
    lose_model(state);
  } else {
    lose_fallback(state, report);
  }
  return false;
}

bool MemoryScrubber::rebuild_table(std::uint32_t bank, const Estimator& estimator, AppState& state) {
  const std::uint32_t size_bytes = state.banks.descriptor[bank].size_bytes;
  const gnc::ModelStatus status =
      estimator.check(memory_of(bank, state).data, size_bytes, state.expected_target.name());
  if (status != gnc::ModelStatus::kOk) return false;
  bank_is_good(bank, state);
  return true;
}

void MemoryScrubber::check_block(AppState& state, const Reporter& report) {
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
    case BlockCheck::Result::kFallbackLost:
      count(state.counters.model_blocks_lost);
      report(EventId::kModelBlockLost, bank, block);
      lose_fallback(state, report);
      break;
  }
}

// The switch to the other bank is the long task of this cycle, whether or not an attempt of a repair was made
// before: both fit into half a period.
void MemoryScrubber::lose_model(AppState& state) {
  state.long_task = true;
  state.banks.descriptor[state.banks.in_use].set(BankStatus::kEmpty);
  state.faults_seen |= bit_of(Fault::kModelCorrupted);
}

void MemoryScrubber::lose_fallback(AppState& state, const Reporter& report) {
  const std::uint32_t bank = state.banks.other();
  state.banks.descriptor[bank].set(BankStatus::kEmpty);
  report(EventId::kFallbackLost, static_cast<std::int32_t>(bank));
}

}  // namespace tumblesight::fsw
