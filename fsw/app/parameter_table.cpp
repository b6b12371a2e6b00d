#include "fsw/app/parameter_table.hpp"

#include "gnc/numerics/crc.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t cycles_of(std::uint32_t field) {
  return field >> 24;
}
constexpr std::uint32_t window_of(std::uint32_t field) {
  return field >> 16 & 0xFF;
}
constexpr std::uint32_t good_cycles_of(std::uint32_t field) {
  return field >> 8 & 0xFF;
}
constexpr Response response_of(std::uint32_t field) {
  return static_cast<Response>(field & 0xFF);
}

constexpr bool is_possible_rule(std::uint32_t field) {
  if (cycles_of(field) < 1) return false;
  if (good_cycles_of(field) < 1) return false;
  if (cycles_of(field) > window_of(field)) return false;
  if (window_of(field) > config::kMaxFaultWindow_cycles) return false;
  return response_of(field) <= Response::kSafe;
}

constexpr bool are_initial_values_possible() {
  for (const config::FaultRule& rule : config::kFaultRules) {
    if (!is_possible_rule(to_field(rule))) return false;
  }
  for (const config::ParameterRule& rule : config::kParameterRules) {
    if (rule.initial < rule.lowest) return false;
    if (rule.initial > rule.highest) return false;
  }
  return true;
}
static_assert(are_initial_values_possible());

void put_u32(std::uint32_t value, std::uint8_t* at) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

std::uint32_t get_u32(const std::uint8_t* at) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | at[i];
  return value;
}

// Whether the field may have the value.
bool is_allowed(std::size_t field, std::uint32_t value) {
  if (field < kParameters) {
    const config::ParameterRule& rule = config::kParameterRules[field];
    return value >= rule.lowest && value <= rule.highest;
  }
  // No attitude can be trusted without the response to such a fault.
  const bool can_be_changed = config::kFaultRules[field - kParameters].can_be_disabled;
  if (!can_be_changed) return value == kInitialTable.fields[field];
  return is_possible_rule(value);
}

constexpr std::size_t kCrcOffset = kTableBytes - 4;
constexpr std::uint32_t kHead = std::uint32_t{kTableVersion} << 16 | kTableFields;

}  // namespace

config::FaultRule ParameterTable::rule_of(Fault fault) const {
  const auto index = static_cast<std::size_t>(fault);
  const std::uint32_t field = fields[kParameters + index];
  config::FaultRule rule = config::kFaultRules[index];
  rule.cycles = static_cast<std::uint8_t>(cycles_of(field));
  rule.window_cycles = static_cast<std::uint8_t>(window_of(field));
  rule.good_cycles = static_cast<std::uint8_t>(good_cycles_of(field));
  rule.response = response_of(field);
  return rule;
}

std::size_t first_wrong_field(const ParameterTable& table) {
  for (std::size_t field = 0; field < kTableFields; ++field) {
    if (!is_allowed(field, table.fields[field])) return field;
  }
  return kTableFields;
}

TableBytes to_bytes(const ParameterTable& table) {
  TableBytes bytes{};
  std::uint8_t* at = bytes.data();
  put_u32(kHead, at);
  for (const std::uint32_t field : table.fields) put_u32(field, at += 4);
  put_u32(gnc::crc32(bytes.data(), kCrcOffset), at + 4);
  return bytes;
}

std::uint32_t crc32_of(const ParameterTable& table) {
  return get_u32(to_bytes(table).data() + kCrcOffset);
}

TableFormat from_bytes(const std::uint8_t* bytes, std::size_t count, ParameterTable& table) {
  if (count != kTableBytes) return TableFormat::kOther;
  if (get_u32(bytes) != kHead) return TableFormat::kOther;
  if (get_u32(bytes + kCrcOffset) != gnc::crc32(bytes, kCrcOffset)) return TableFormat::kWrongCrc;
  for (std::size_t i = 0; i < kTableFields; ++i) table.fields[i] = get_u32(bytes + 4 + 4 * i);
  return TableFormat::kOk;
}

}  // namespace tumblesight::fsw
