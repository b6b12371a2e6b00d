#include "sim/operations/function_names.hpp"

#include <cctype>

namespace tumblesight::sim {
namespace {

// "SET_MODE" of "SetMode".
std::string upper_case(const char* name) {
  std::string text;
  for (const char* c = name; *c != '\0'; ++c) {
    if (std::isupper(*c) != 0 && !text.empty()) text += '_';
    text += static_cast<char>(std::toupper(*c));
  }
  return text;
}

}  // namespace

std::string name_of(hal::FunctionCode function) {
  switch (function) {
#define TUMBLESIGHT_TELECOMMAND(code, name, modes, ...) \
  case hal::FunctionCode::k##name:                      \
    return upper_case(#name);
#include "hal/messages/telecommands.inc"
#undef TUMBLESIGHT_TELECOMMAND
  }
  return "FUNCTION " + std::to_string(static_cast<int>(function));
}

}  // namespace tumblesight::sim
