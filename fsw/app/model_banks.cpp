#include "fsw/app/model_banks.hpp"

#include <cstring>

#include "gnc/numerics/crc32.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kBlockBytes = config::kModelBlockBytes;

template <class N>
std::uint32_t bytes_of_block(std::uint32_t block) {
  const std::uint32_t rest = static_cast<std::uint32_t>(gnc::kModelImageSize<N>) - block * kBlockBytes;
  return rest < kBlockBytes ? rest : kBlockBytes;
}

}  // namespace

template <class N>
bool ModelBanks<N>::load(hal::ModelStore& store, ModelBanksState& state, std::uint32_t offset,
                         const std::uint8_t* bytes, std::uint32_t count) {
  const std::uint32_t bank = state.other();
  const hal::ModelBank memory = store.bank(static_cast<int>(bank));
  ModelBankRecord& record = state.record[bank];
  const bool in_order =
      offset == 0 || (state.status(bank) == BankStatus::kLoading && offset == state.loaded_bytes);
  if (!in_order || memory.writable == nullptr || count > memory.capacity || offset > memory.capacity - count)
    return false;
  if (offset == 0) {
    record = {};
    record.status = static_cast<std::uint32_t>(BankStatus::kLoading);
  }
  std::memcpy(memory.writable + offset, bytes, count);
  state.loaded_bytes = offset + count;
  return true;
}

template <class N>
std::uint32_t ModelBanks<N>::table_crc32() const {
  gnc::Crc32 crc;
  for (const std::uint32_t block : block_crc32_) crc.add_u32(block);
  return crc.value();
}

template <class N>
void ModelBanks<N>::make_table(hal::ModelStore& store, ModelBanksState& state) {
  const std::uint8_t* const data = store.bank(static_cast<int>(state.in_use)).data;
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    block_crc32_[block] = gnc::crc32(data + block * kBlockBytes, bytes_of_block<N>(block));
  }
  state.next_block = 0;
  state.table_crc32 = table_crc32();
}

template <class N>
bool ModelBanks<N>::table_is_sound(const ModelBanksState& state) const {
  return table_crc32() == state.table_crc32;
}

template <class N>
BlockCheck ModelBanks<N>::check_block(hal::ModelStore& store, ModelBanksState& state) {
  using Result = BlockCheck::Result;
  const std::uint32_t block = state.next_block;
  state.next_block = block + 1 < kBlocks ? block + 1 : 0;

  const hal::ModelBank used = store.bank(static_cast<int>(state.in_use));
  const hal::ModelBank copy = store.bank(static_cast<int>(state.other()));
  const std::uint32_t offset = block * kBlockBytes, bytes = bytes_of_block<N>(block);
  const std::uint32_t expected = block_crc32_[block];
  const bool good = gnc::crc32(used.data + offset, bytes) == expected;
  if (!state.has_second_copy()) return {good ? Result::kGood : Result::kLost, state.in_use, block};
  const bool copy_good = gnc::crc32(copy.data + offset, bytes) == expected;

  if (good) {
    if (copy_good || copy.writable == nullptr) return {Result::kGood, state.in_use, block};
    std::memcpy(copy.writable + offset, used.data + offset, bytes);
    return {Result::kRepaired, state.other(), block};
  }
  if (!copy_good || used.writable == nullptr) return {Result::kLost, state.in_use, block};
  std::memcpy(used.writable + offset, copy.data + offset, bytes);
  return {Result::kRepaired, state.in_use, block};
}

template class ModelBanks<gnc::FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class ModelBanks<gnc::Float32>;
#endif

}  // namespace tumblesight::fsw
