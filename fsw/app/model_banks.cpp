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

std::uint32_t ModelBanks::table_crc32() const {
  gnc::Crc32 crc;
  for (const std::uint32_t block : block_crc32_) crc.add_u32(block);
  return crc.value();
}

void ModelBanks::make_table(hal::ModelStore& store, ModelBanksState& state) {
  const std::uint8_t* const data = store.bank(static_cast<int>(state.in_use)).data;
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    block_crc32_[block] = gnc::crc32(data + block * kBlockBytes, bytes_of_block(block));
  }
  state.next_block = 0;
  state.table_crc32 = table_crc32();
}

bool ModelBanks::table_is_sound(const ModelBanksState& state) const {
  return table_crc32() == state.table_crc32;
}

BlockCheck ModelBanks::check_block(hal::ModelStore& store, ModelBanksState& state) {
  using Result = BlockCheck::Result;
  const std::uint32_t block = state.next_block;
  state.next_block = block + 1 < kBlocks ? block + 1 : 0;

  const hal::ModelBank used = store.bank(static_cast<int>(state.in_use));
  const hal::ModelBank copy = store.bank(static_cast<int>(state.other()));
  const std::uint32_t offset = block * kBlockBytes, bytes = bytes_of_block(block);
  const std::uint32_t expected = block_crc32_[block];
  const bool good = gnc::crc32(used.data + offset, bytes) == expected;
  if (!state.has_second_copy()) return {good ? Result::kGood : Result::kLost, state.in_use, block};
  // A bank that is being written cannot be read; it is checked in the next pass.
  if (store.activity(static_cast<int>(state.other())) != hal::BankActivity::kReady)
    return {good ? Result::kGood : Result::kLost, state.in_use, block};
  const bool copy_good = gnc::crc32(copy.data + offset, bytes) == expected;

  if (good) {
    if (copy_good || !writes(store, state.other(), offset, used.data, bytes))
      return {Result::kGood, state.in_use, block};
    return {Result::kRepaired, state.other(), block};
  }
  // The image in use must stay readable, so only a bank that is written at once can be repaired.
  const bool repaired = copy_good && used.writing == hal::BankWriting::kAtOnce &&
                        writes(store, state.in_use, offset, copy.data, bytes);
  if (!repaired) return {Result::kLost, state.in_use, block};
  return {Result::kRepaired, state.in_use, block};
}

}  // namespace tumblesight::fsw
