#include "fsw/app/model_banks.hpp"

#include "gnc/numerics/crc.hpp"
#include "hal/messages/memory_dump.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kBlockBytes = config::kModelBlockBytes;
constexpr std::uint32_t kSegmentsPerWrite = hal::kMaxModelWriteBytes / kSegmentBytes;
static_assert(sizeof(ModelBanksState::missing) <= hal::MemoryDump::kMaxBytes, "one dump shows all of it");

std::uint32_t bytes_of_block(std::uint32_t block) {
  const std::uint32_t rest = kModelImageBytes - block * kBlockBytes;
  return rest < kBlockBytes ? rest : kBlockBytes;
}

std::uint32_t bytes_of_segment(std::uint32_t segment) {
  const std::uint32_t rest = kModelImageBytes - segment * kSegmentBytes;
  return rest < kSegmentBytes ? rest : kSegmentBytes;
}

constexpr std::uint8_t mask_of(std::uint32_t segment) {
  return static_cast<std::uint8_t>(0x80U >> segment % 8);
}

bool is_missing(const ModelBanksState& state, std::uint32_t segment) {
  return (state.missing[segment / 8] & mask_of(segment)) != 0;
}

// Writes `count` bytes from the beginning of segment `first` on. The segments are no longer missing.
hal::WriteStatus write_segments(hal::ModelStore& store, ModelBanksState& state, std::uint32_t first,
                                const std::uint8_t* bytes, std::uint32_t count) {
  const std::uint32_t bank = state.other();
  const auto index = static_cast<int>(bank);
  const bool spoilt =
      state.segments_missing < kModelSegments && store.activity(index) == hal::BankActivity::kFailed;
  const hal::WriteStatus written =
      spoilt ? hal::WriteStatus::kFailed : store.write(index, first * kSegmentBytes, bytes, count);
  if (written == hal::WriteStatus::kFailed) state.void_upload();
  if (written != hal::WriteStatus::kAccepted) return written;
  for (std::uint32_t segment = first; segment * kSegmentBytes < first * kSegmentBytes + count; ++segment) {
    if (!is_missing(state, segment)) continue;
    state.missing[segment / 8] ^= mask_of(segment);
    --state.segments_missing;
  }
  return written;
}

// Copies a block of `image` into a bank. True: accepted.
bool writes(hal::ModelStore& store, std::uint32_t bank, std::uint32_t offset, const std::uint8_t* image,
            std::uint32_t bytes) {
  return store.write(static_cast<int>(bank), offset, image + offset, bytes) == hal::WriteStatus::kAccepted;
}
static_assert(kBlockBytes <= hal::kMaxModelWriteBytes);

}  // namespace

void ModelBanksState::void_upload() {
  descriptor[other()] = {};
  next_copied = kModelSegments;
  segments_missing = 0;
  missing = {};
}

bool ModelBanks::begin(hal::ModelStore& store, ModelBanksState& state, UploadBase base) {
  const std::uint32_t bank = state.other();
  const hal::ModelBank memory = store.bank(static_cast<int>(bank));
  if (memory.writing == hal::BankWriting::kReadOnly) return false;
  if (memory.capacity < kModelImageBytes) return false;
  state.void_upload();
  state.descriptor[bank].set(BankStatus::kLoading);
  if (base == UploadBase::kSameBank) return true;
  for (std::uint32_t segment = 0; segment < kModelSegments; ++segment)
    state.missing[segment / 8] |= mask_of(segment);
  state.segments_missing = kModelSegments;
  if (base == UploadBase::kBankInUse) state.next_copied = 0;
  return true;
}

hal::WriteStatus ModelBanks::load(hal::ModelStore& store, ModelBanksState& state, std::uint32_t offset,
                                  const std::uint8_t* bytes, std::uint32_t count) {
  if (offset % kSegmentBytes != 0 || offset >= kModelImageBytes) return hal::WriteStatus::kRefused;
  const std::uint32_t segment = offset / kSegmentBytes;
  if (count != bytes_of_segment(segment)) return hal::WriteStatus::kRefused;
  return write_segments(store, state, segment, bytes, count);
}

hal::WriteStatus ModelBanks::continue_copy(hal::ModelStore& store, ModelBanksState& state) {
  const std::uint8_t* const image = store.bank(static_cast<int>(state.in_use)).data;
  std::uint32_t copied = 0;
  while (copied < config::kCopiedSegmentsPerCycle && state.next_copied < kModelSegments) {
    const std::uint32_t first = state.next_copied;
    if (!is_missing(state, first)) {
      ++state.next_copied;
      continue;
    }
    // Flash erases a whole sector for each write, so segments that lie together are written together.
    std::uint32_t count = 0, end = first;
    do {
      count += bytes_of_segment(end++);
    } while (end % kSegmentsPerWrite != 0 && end < kModelSegments && is_missing(state, end));
    const hal::WriteStatus written =
        write_segments(store, state, first, image + first * kSegmentBytes, count);
    if (written != hal::WriteStatus::kAccepted) return written;
    state.next_copied = end;
    copied += end - first;
  }
  return hal::WriteStatus::kAccepted;
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
