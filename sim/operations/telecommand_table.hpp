// The telecommands and their arguments as a user writes them: names and numbers instead of bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hal/messages/function_code.hpp"
#include "sim/operations/signed_telecommand.hpp"

namespace tumblesight::sim {

struct ArgumentField {
  std::string name;
  int bytes;                  // 1, 2 or 4: a number; 0: bytes as hexadecimal digits
  std::uint32_t least, most;  // of the number, or of the number of bytes
  std::string meaning;        // "1 STANDBY, 2 RUN, 3 SAFE"
};
struct TelecommandRow {
  hal::FunctionCode function;
  std::vector<ArgumentField> fields;
};

// In the order of their codes.
const std::vector<TelecommandRow>& telecommand_table();

// `values`: by the names of the fields, as text. Throws std::invalid_argument that names function, field,
// value and limit.
Telecommand telecommand_of(const std::string& function, const std::map<std::string, std::string>& values);

// Pairs of hexadecimal digits. Throws std::invalid_argument for anything else.
std::vector<std::uint8_t> bytes_of_hex(const std::string& text);

}  // namespace tumblesight::sim
