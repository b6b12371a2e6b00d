// The key of telecommands, out of a file.
#pragma once

#include "hal/command_key.hpp"

namespace tumblesight::hal::dds {

// The file holds 64 hexadecimal digits and white space. False: `key` is untouched, and the reason has gone to
// the standard error stream. An empty path gives the development key.
[[nodiscard]] bool read_command_key(const char* path, CommandKey& key);

}  // namespace tumblesight::hal::dds
