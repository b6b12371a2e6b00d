#include "fsw/app/stored_state.hpp"

#include <cstring>

#include "gnc/numerics/crc.hpp"
#include "hal/messages/command_key.hpp"
#include "hal/model_store.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kMagic = 0x54535354;  // TSST
constexpr std::uint8_t kVersion = 2;
constexpr std::size_t kCrcOffset = hal::kStoredBytes - 4;
constexpr std::size_t kTableOffset = 22;
static_assert(kTableOffset + kTableBytes <= kCrcOffset, "the table does not fit into the record");

class RecordWriter {
 public:
  explicit RecordWriter(hal::StoredBytes& bytes) : bytes_(bytes) {}
  void u8(std::uint32_t value) { bytes_[at_++] = static_cast<std::uint8_t>(value); }
  void u32(std::uint32_t value) {
    u8(value >> 24);
    u8(value >> 16);
    u8(value >> 8);
    u8(value);
  }

 private:
  hal::StoredBytes& bytes_;
  std::size_t at_ = 0;
};

class RecordReader {
 public:
  explicit RecordReader(const hal::StoredBytes& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
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

bool has_known_places(const StoredState& state) {
  return state.key_slot < hal::kCommandKeySlots && state.bank < hal::kModelBanks;
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
  writer.u32(generation);
  writer.u32(state.command_counter);
  writer.u8(state.key_slot);
  writer.u8(state.bank);
  writer.u8(static_cast<std::uint32_t>(state.mode));
  writer.u8(static_cast<std::uint32_t>(state.safe_cause));
  writer.u8(static_cast<std::uint32_t>(state.safe_fault));
  writer.u32(state.responses_disabled);
  const TableBytes table = to_bytes(state.table);
  std::memcpy(bytes.data() + kTableOffset, table.data(), table.size());
  const std::uint32_t crc = gnc::crc32(bytes.data(), kCrcOffset);
  for (std::size_t i = 0; i < 4; ++i) bytes[kCrcOffset + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  return bytes;
}

StoreStatus from_record(const hal::StoredBytes& bytes, StoredState& state, std::uint32_t& generation) {
  if (RecordReader(bytes, kCrcOffset).u32() != gnc::crc32(bytes.data(), kCrcOffset))
    return StoreStatus::kDamaged;
  RecordReader reader(bytes);
  const bool known_magic = reader.u32() == kMagic, known_version = reader.u8() == kVersion;
  if (!known_magic || !known_version) return StoreStatus::kDamaged;
  const std::uint32_t read_generation = reader.u32();
  StoredState read;
  read.command_counter = reader.u32();
  read.key_slot = reader.u8();
  read.bank = reader.u8();
  read.mode = static_cast<Mode>(reader.u8());
  read.safe_cause = static_cast<Cause>(reader.u8());
  read.safe_fault = static_cast<Fault>(reader.u8());
  read.responses_disabled = reader.u32();
  const TableFormat format = from_bytes(bytes.data() + kTableOffset, kTableBytes, read.table);
  if (format != TableFormat::kOk) return StoreStatus::kDamaged;
  const bool allowed_fields = first_wrong_field(read.table) == kTableFields;
  if (!has_known_mode(read) || !has_known_places(read) || !allowed_fields) return StoreStatus::kDamaged;
  state = read;
  generation = read_generation;
  return StoreStatus::kOk;
}

}  // namespace tumblesight::fsw
