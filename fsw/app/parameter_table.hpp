// ParameterTable: the values that the ground can change without new software. They are the parameters of
// fsw/config/parameters.inc and the fault rules. One table is active. Another one is uplinked as a whole,
// checked field by field, and activated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "fsw/config/fault_rules.hpp"
#include "fsw/config/parameters.hpp"
#include "hal/messages/table_status.hpp"

namespace tumblesight::fsw {

using hal::TableStatus;

// A field is a parameter, or the rule of a fault: its cycles, window cycles, good cycles and response, one
// byte each, the first one the most significant.
inline constexpr std::size_t kTableFields = kParameters + static_cast<std::size_t>(kFaults);

struct ParameterTable {
  std::array<std::uint32_t, kTableFields> fields{};

  std::uint32_t& operator[](Parameter parameter) { return fields[static_cast<std::size_t>(parameter)]; }
  std::uint32_t operator[](Parameter parameter) const { return fields[static_cast<std::size_t>(parameter)]; }
  config::FaultRule rule_of(Fault fault) const;
};

constexpr std::uint32_t to_field(const config::FaultRule& rule) {
  return std::uint32_t{rule.cycles} << 24 | std::uint32_t{rule.window_cycles} << 16 |
         std::uint32_t{rule.good_cycles} << 8 | static_cast<std::uint32_t>(rule.response);
}

constexpr ParameterTable make_initial_table() {
  ParameterTable table;
  for (std::size_t i = 0; i < kParameters; ++i) table.fields[i] = config::kParameterRules[i].initial;
  for (std::size_t i = 0; i < config::kFaultRules.size(); ++i)
    table.fields[kParameters + i] = to_field(config::kFaultRules[i]);
  return table;
}
// The table after init().
inline constexpr ParameterTable kInitialTable = make_initial_table();

// The first field that has a value which is not allowed; kTableFields: none.
std::size_t first_wrong_field(const ParameterTable& table);

// The table on the link and in dumps: all numbers are big-endian.
//
//   offset  bytes  field
//        0      2  format version, 1
//        2      2  number of fields, n
//        4    4 n  fields
//  4 + 4 n      4  CRC-32 of everything before it
inline constexpr std::uint16_t kTableVersion = 1;
inline constexpr std::size_t kTableBytes = 8 + 4 * kTableFields;
using TableBytes = std::array<std::uint8_t, kTableBytes>;

TableBytes to_bytes(const ParameterTable& table);
std::uint32_t crc32_of(const ParameterTable& table);

enum class TableFormat : std::uint8_t { kOk, kOther, kWrongCrc };
// kOther: another size, version or number of fields. The table is changed with kOk only.
[[nodiscard]] TableFormat from_bytes(const std::uint8_t* bytes, std::size_t count, ParameterTable& table);

// The table that was uplinked.
struct LoadedTable {
  ParameterTable table;
  TableStatus status = TableStatus::kEmpty;
};

}  // namespace tumblesight::fsw
