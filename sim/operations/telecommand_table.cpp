#include "sim/operations/telecommand_table.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "hal/messages/fault.hpp"
#include "sim/host/text.hpp"
#include "sim/operations/fault_names.hpp"
#include "sim/operations/function_names.hpp"

namespace tumblesight::sim {
namespace {

using hal::FunctionCode;

ArgumentField number(const char* name, int bytes, std::uint32_t least, std::uint32_t most,
                     const char* meaning) {
  return {name, bytes, least, most, meaning};
}

std::string names_of_faults() {
  std::string names;
  for (int i = 0; i < hal::kFaults; ++i)
    names += (i == 0 ? "" : ", ") + std::to_string(i) + " " + name_of(static_cast<hal::Fault>(i));
  return names;
}

#define TUMBLESIGHT_NUMBER(name, bytes, least, most, meaning) number(#name, bytes, least, most, meaning)
#define TUMBLESIGHT_ENUMERATOR(name, enumeration, least, most, meaning) number(#name, 1, least, most, meaning)
#define TUMBLESIGHT_BYTES(name, least, most, meaning) number(#name, 0, least, most, meaning)
#define TUMBLESIGHT_TELECOMMAND(code, name, modes, ...) {FunctionCode::k##name, {__VA_ARGS__}},
std::vector<TelecommandRow> make_telecommand_table() {
  std::vector<TelecommandRow> table{
#include "hal/messages/telecommands.inc"
  };
  for (TelecommandRow& row : table)
    for (ArgumentField& field : row.fields)
      if (field.name == "fault") field.meaning = names_of_faults();
  return table;
}
#undef TUMBLESIGHT_NUMBER
#undef TUMBLESIGHT_ENUMERATOR
#undef TUMBLESIGHT_BYTES
#undef TUMBLESIGHT_TELECOMMAND

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
  static const std::vector<TelecommandRow> table = make_telecommand_table();
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
