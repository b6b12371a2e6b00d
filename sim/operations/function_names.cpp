#include "sim/operations/function_names.hpp"

#include <array>
#include <cstddef>

namespace tumblesight::sim {

std::string name_of(hal::FunctionCode function) {
  constexpr std::array<const char*, 16> kNames{
      "NOOP",          "RESET_COUNTERS",  "SET_MODE",         "RESET_SEQUENCE",
      "MODEL_LOAD",    "MODEL_VALIDATE",  "MODEL_ACTIVATE",   "MEMORY_DUMP",
      "SET_PARAMETER", "ENABLE_RESPONSE", "DISABLE_RESPONSE", "KEY_ACTIVATE",
      "MODEL_BEGIN",   "TABLE_LOAD",      "TABLE_VALIDATE",   "TABLE_ACTIVATE"};
  const auto index = static_cast<std::size_t>(function) - 1;  // 0 wraps
  return index < kNames.size() ? kNames[index] : "FUNCTION " + std::to_string(static_cast<int>(function));
}

}  // namespace tumblesight::sim
