#include "fsw/app/stored_state.hpp"

#include <cstring>

#include "gnc/numerics/crc.hpp"
#include "hal/model_store.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kMagic = 0x54535354;  // TSST
constexpr std::uint8_t kVersion = 3;
constexpr std::size_t kVersionOffset = 4;
constexpr std::size_t kHeadCrcOffset = kStoredHeadBytes - 4;
constexpr std::size_t kCrcOffset = hal::kStoredBytes - 4;
constexpr std::size_t kTableOffset = 28;
static_assert(kTableOffset + kTableBytes <= kCrcOffset, "the table does not fit into the record");

class RecordWriter {
 public:
  explicit RecordWriter(hal::StoredBytes& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
  void u8(std::uint32_t value) { bytes_[at_++] = static_cast<std::uint8_t>(value); }
  void u32(std::uint32_t value) {
    u8(value >> 24);
    u8(value >> 16);
    u8(value >> 8);
    u8(value);
  }

 private:
  hal::StoredBytes& bytes_;
  std::size_t at_;
};

class RecordReader {
 public:
  explicit RecordReader(const hal::StoredBytes& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
  void skip(std::size_t bytes) { at_ += bytes; }
  std::uint8_t u8() { return bytes_[at_++]; }
  std::uint32_t u32() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | u8();
    return value;
  }

 private:
  const hal::StoredBytes& bytes_;
  std::size_t at_;
};

bool has_known_mode(const StoredState& state) {
  return state.mode <= Mode::kSafe && state.safe_cause <= hal::kLastCause &&
         static_cast<int>(state.safe_fault) < kFaults;
}

// The checksum of everything before it.
void put_crc(hal::StoredBytes& bytes, std::size_t at) {
  RecordWriter(bytes, at).u32(gnc::crc32(bytes.data(), at));
}
bool has_good_crc(const hal::StoredBytes& bytes, std::size_t at) {
  return RecordReader(bytes, at).u32() == gnc::crc32(bytes.data(), at);
}

// The head is good.
StoreStatus read_body(const hal::StoredBytes& bytes, StoredState& state) {
  if (bytes[kVersionOffset] != kVersion) return StoreStatus::kOtherVersion;
  if (!has_good_crc(bytes, kCrcOffset)) return StoreStatus::kBodyDamaged;
  RecordReader reader(bytes, kStoredHeadBytes);
  StoredState read = state;
  read.bank = reader.u8();
  read.mode = static_cast<Mode>(reader.u8());
  read.safe_cause = static_cast<Cause>(reader.u8());
  read.safe_fault = static_cast<Fault>(reader.u8());
  read.responses_disabled = reader.u32();
  if (!has_known_mode(read) || read.bank >= hal::kModelBanks) return StoreStatus::kBodyDamaged;
  const TableFormat format = from_bytes(bytes.data() + kTableOffset, kTableBytes, read.table);
  state = read;
  if (format == TableFormat::kOk && first_wrong_field(read.table) == kTableFields) return StoreStatus::kOk;
  state.table = kInitialTable;
  return StoreStatus::kOtherTable;
}

}  // namespace

// The records of equal states with equal generations are equal.
bool StoredState::operator==(const StoredState& other) const {
  return to_record(*this, 0) == to_record(other, 0);
}

hal::StoredBytes to_record(const StoredState& state, std::uint32_t generation) {
  hal::StoredBytes bytes{};
  RecordWriter writer(bytes);
  writer.u32(kMagic);
  writer.u8(kVersion);
  writer.u8(state.key_slot);
  writer.u8(0);
  writer.u8(0);
  writer.u32(generation);
  writer.u32(state.command_counter);
  put_crc(bytes, kHeadCrcOffset);
  RecordWriter body(bytes, kStoredHeadBytes);
  body.u8(state.bank);
  body.u8(static_cast<std::uint32_t>(state.mode));
  body.u8(static_cast<std::uint32_t>(state.safe_cause));
  body.u8(static_cast<std::uint32_t>(state.safe_fault));
  body.u32(state.responses_disabled);
  const TableBytes table = to_bytes(state.table);
  std::memcpy(bytes.data() + kTableOffset, table.data(), table.size());
  put_crc(bytes, kCrcOffset);
  return bytes;
}

StoreStatus from_record(const hal::StoredBytes& bytes, StoredState& state, std::uint32_t& generation) {
  if (!has_good_crc(bytes, kHeadCrcOffset)) return StoreStatus::kDamaged;
  RecordReader reader(bytes);
  if (reader.u32() != kMagic) return StoreStatus::kDamaged;
  state = StoredState{};
  reader.skip(1);
  state.key_slot = reader.u8();
  reader.skip(2);
  generation = reader.u32();
  state.command_counter = reader.u32();
  return read_body(bytes, state);
}

}  // namespace tumblesight::fsw
