#include "sim/operations/telecommand_table.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <stdexcept>

#include "hal/messages/command_packet.hpp"
#include "hal/messages/fault.hpp"
#include "hal/messages/memory_dump.hpp"
#include "sim/host/text.hpp"
#include "sim/operations/fault_names.hpp"
#include "sim/operations/function_names.hpp"

namespace tumblesight::sim {
namespace {

using hal::FunctionCode;

constexpr std::uint32_t kAny32 = 0xFFFF'FFFF;

ArgumentField crc32_of(const std::string& what) {
  return {"crc32", 4, 0, kAny32, "CRC-32 " + what};
}
ArgumentField fault() {
  std::string names;
  for (int i = 0; i < hal::kFaults; ++i)
    names += (i == 0 ? "" : ", ") + std::to_string(i) + " " + name_of(static_cast<hal::Fault>(i));
  return {"fault", 1, 0, hal::kFaults - 1, names};
}

std::vector<TelecommandRow> make_table() {
  const ArgumentField offset{"offset", 4, 0, kAny32, "in bytes"};
  constexpr auto kLastMemory = static_cast<std::uint32_t>(hal::DumpedMemory::kLoadedTable);
  constexpr std::uint32_t kLastField = 20;  // docs/icd.md; a test compares it with flight
  constexpr auto kSegment = static_cast<std::uint32_t>(hal::kMaxModelSegmentBytes);
  constexpr auto kMost = static_cast<std::uint32_t>(hal::kMaxCommandArgumentBytes);
  return {
      {FunctionCode::kNoop, {}},
      {FunctionCode::kResetCounters, {}},
      {FunctionCode::kSetMode, {{"mode", 1, 1, 3, "1 STANDBY, 2 RUN, 3 SAFE"}}},
      {FunctionCode::kResetSequence, {}},
      {FunctionCode::kModelLoad, {offset, {"segment", 0, 1, kSegment, "of the image that was begun"}}},
      {FunctionCode::kModelValidate,
       {{"size", 4, 0, kAny32, "in bytes"}, crc32_of("in the header of the loaded image")}},
      {FunctionCode::kModelActivate, {crc32_of("in the header of the validated image")}},
      {FunctionCode::kMemoryDump,
       {{"memory", 1, 0, kLastMemory,
         "0 bank 0, 1 bank 1, 2 missing segments, 3 active table, 4 loaded table"},
        offset,
        {"size", 2, 1, hal::MemoryDump::kMaxBytes, "in bytes"}}},
      {FunctionCode::kSetParameter,
       {{"field", 1, 0, kLastField, "of the active table"}, {"value", 4, 0, kAny32, "new value"}}},
      {FunctionCode::kEnableResponse, {fault()}},
      {FunctionCode::kDisableResponse, {fault()}},
      {FunctionCode::kKeyActivate,
       {{"slot", 1, 0, 3, "0 to 3"}, {"proof", 0, 16, 16, "that the sender holds the key of the slot"}}},
      {FunctionCode::kModelBegin,
       {{"base", 1, 0, 2, "0 nothing, 1 the bank in use, 2 what the bank to be loaded holds"}}},
      {FunctionCode::kTableLoad, {{"table", 0, 1, kMost, "a whole table"}}},
      {FunctionCode::kTableValidate, {crc32_of("at the end of the table that was loaded")}},
      {FunctionCode::kTableActivate, {crc32_of("at the end of the table that was validated")}},
  };
}

// "it takes mode"
std::string arguments_of(const TelecommandRow& row) {
  if (row.fields.empty()) return "it takes none";
  std::string names;
  for (const ArgumentField& field : row.fields) names += (names.empty() ? "" : ", ") + field.name;
  return "it takes " + names;
}

[[noreturn]] void refuse(const TelecommandRow& row, const ArgumentField& field, const std::string& value,
                         const std::string& limit) {
  throw std::invalid_argument(name_of(row.function) + ": " + field.name + " '" + value + "' must be " +
                              limit);
}

// Decimal, or hexadecimal after 0x.
std::uint32_t number_of(const TelecommandRow& row, const ArgumentField& field, const std::string& value) {
  const bool is_hexadecimal = value.rfind("0x", 0) == 0;
  const char* const begin = value.data() + (is_hexadecimal ? 2 : 0);
  const char* const end = value.data() + value.size();
  std::uint32_t number = 0;
  const auto [last, error] = std::from_chars(begin, end, number, is_hexadecimal ? 16 : 10);
  if (begin == end || last != end || error != std::errc() || number < field.least || number > field.most)
    refuse(row, field, value,
           "a whole number from " + std::to_string(field.least) + " to " + std::to_string(field.most));
  return number;
}

void add_bytes(const TelecommandRow& row, const ArgumentField& field, const std::string& value,
               Telecommand& command) {
  const std::string limit =
      std::to_string(field.least) + " to " + std::to_string(field.most) + " bytes in hexadecimal digits";
  std::vector<std::uint8_t> bytes;
  try {
    bytes = bytes_of_hex(value);
  } catch (const std::invalid_argument&) {
    refuse(row, field, value.substr(0, 40), limit);
  }
  if (bytes.size() < field.least || bytes.size() > field.most) refuse(row, field, value.substr(0, 40), limit);
  command.arguments.insert(command.arguments.end(), bytes.begin(), bytes.end());
}

}  // namespace

const std::vector<TelecommandRow>& telecommand_table() {
  static const std::vector<TelecommandRow> table = make_table();
  return table;
}

Telecommand telecommand_of(const std::string& function, const std::map<std::string, std::string>& values) {
  const auto& table = telecommand_table();
  const auto row = std::find_if(table.begin(), table.end(), [&function](const TelecommandRow& candidate) {
    return name_of(candidate.function) == function;
  });
  if (row == table.end())
    throw std::invalid_argument("there is no telecommand '" + shortened(function) + "'");
  for (const auto& [name, value] : values) {
    const auto is_it = [&name = name](const ArgumentField& field) { return field.name == name; };
    if (std::none_of(row->fields.begin(), row->fields.end(), is_it))
      throw std::invalid_argument(function + ": there is no argument '" + shortened(name) + "'; " +
                                  arguments_of(*row));
  }
  Telecommand command{row->function, {}};
  for (const ArgumentField& field : row->fields) {
    const auto value = values.find(field.name);
    if (value == values.end()) throw std::invalid_argument(function + ": " + field.name + " is missing");
    if (field.bytes == 0) {
      add_bytes(*row, field, value->second, command);
      continue;
    }
    const std::uint32_t number = number_of(*row, field, value->second);
    for (int i = field.bytes - 1; i >= 0; --i)
      command.arguments.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  }
  return command;
}

std::vector<std::uint8_t> bytes_of_hex(const std::string& text) {
  if (text.size() % 2 != 0) throw std::invalid_argument("an odd number of hexadecimal digits");
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    std::uint8_t byte = 0;
    const char* const end = text.data() + i + 2;
    const auto [last, error] = std::from_chars(text.data() + i, end, byte, 16);
    if (last != end || error != std::errc()) throw std::invalid_argument("not hexadecimal digits");
    bytes.push_back(byte);
  }
  return bytes;
}

}  // namespace tumblesight::sim
