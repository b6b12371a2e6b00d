#include "fsw/app/model_banks.hpp"

#include "gnc/numerics/crc32.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kBlockBytes = config::kModelBlockBytes;

std::uint32_t bytes_of_block(std::uint32_t block) {
  const std::uint32_t rest = static_cast<std::uint32_t>(gnc::kModelImageSize<Numerics>) - block * kBlockBytes;
  return rest < kBlockBytes ? rest : kBlockBytes;
}

// Copies a block of `image` into a bank. True: accepted.
bool writes(hal::ModelStore& store, std::uint32_t bank, std::uint32_t offset, const std::uint8_t* image,
            std::uint32_t bytes) {
  return store.write(static_cast<int>(bank), offset, image + offset, bytes) == hal::WriteStatus::kAccepted;
}
static_assert(kBlockBytes <= hal::kMaxModelWriteBytes);

}  // namespace

hal::WriteStatus ModelBanks::load(hal::ModelStore& store, ModelBanksState& state, std::uint32_t offset,
                                  const std::uint8_t* bytes, std::uint32_t count) {
  const std::uint32_t bank = state.other();
  BankDescriptor& descriptor = state.descriptor[bank];
  const bool in_order =
      offset == 0 || (state.status(bank) == BankStatus::kLoading && offset == state.loaded_bytes);
  if (!in_order) return hal::WriteStatus::kRefused;
  const auto index = static_cast<int>(bank);
  const bool spoilt = offset > 0 && store.activity(index) == hal::BankActivity::kFailed;
  const hal::WriteStatus written =
      spoilt ? hal::WriteStatus::kFailed : store.write(index, offset, bytes, count);
  if (written == hal::WriteStatus::kFailed) {
    descriptor = {};
    state.loaded_bytes = 0;
  }
  if (written != hal::WriteStatus::kAccepted) return written;
  if (offset == 0) {
    descriptor = {};
    descriptor.set(BankStatus::kLoading);
  }
  state.loaded_bytes = offset + count;
  return written;
}

std::uint32_t ModelBanks::crc32_of(const Table& table) {
  gnc::Crc32 crc;
  for (const std::uint32_t block : table) crc.add_u32(block);
  return crc.value();
}

void ModelBanks::make_table(std::uint32_t bank, hal::ModelStore& store, ModelBanksState& state) {
  const std::uint8_t* const data = store.bank(static_cast<int>(bank)).data;
  Table& table = block_crc32_[bank];
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    table[block] = gnc::crc32(data + block * kBlockBytes, bytes_of_block(block));
  }
  state.next_block = 0;
  state.table_crc32[bank] = crc32_of(table);
}

bool ModelBanks::restore_table(std::uint32_t bank, const ModelBanksState& state) {
  if (!state.has_second_copy()) return false;
  block_crc32_[bank] = block_crc32_[1 - bank];
  return table_is_sound(bank, state);
}

bool ModelBanks::table_is_sound(std::uint32_t bank, const ModelBanksState& state) const {
  return crc32_of(block_crc32_[bank]) == state.table_crc32[bank];
}

BlockCheck ModelBanks::check_block(hal::ModelStore& store, ModelBanksState& state) {
  using Result = BlockCheck::Result;
  const std::uint32_t block = state.next_block;
  state.next_block = block + 1 < kBlocks ? block + 1 : 0;

  const std::uint32_t in_use = state.in_use, other = state.other();
  const hal::ModelBank used = store.bank(static_cast<int>(in_use));
  const hal::ModelBank spare = store.bank(static_cast<int>(other));
  const std::uint32_t offset = block * kBlockBytes, bytes = bytes_of_block(block);
  const bool good = gnc::crc32(used.data + offset, bytes) == block_crc32_[in_use][block];
  const hal::BankActivity activity = store.activity(static_cast<int>(other));
  if (state.status(other) != BankStatus::kGood) return {good ? Result::kGood : Result::kLost, in_use, block};
  // A bank that is being written cannot be read; it is checked in the next pass.
  if (activity == hal::BankActivity::kErasing || activity == hal::BankActivity::kWriting)
    return {good ? Result::kGood : Result::kLost, in_use, block};
  const bool spare_good = activity == hal::BankActivity::kReady &&
                          gnc::crc32(spare.data + offset, bytes) == block_crc32_[other][block];
  if (good && spare_good) return {Result::kGood, in_use, block};

  const bool can_copy = state.has_second_copy();
  if (good) {
    const bool repaired = can_copy && writes(store, other, offset, used.data, bytes);
    return {repaired ? Result::kRepaired : Result::kFallbackLost, other, block};
  }
  // The image in use must stay readable, so only a bank that is written at once can be repaired.
  const bool repaired = can_copy && spare_good && used.writing == hal::BankWriting::kAtOnce &&
                        writes(store, in_use, offset, spare.data, bytes);
  return {repaired ? Result::kRepaired : Result::kLost, in_use, block};
}

}  // namespace tumblesight::fsw
