// Reads the key of the telecommands' authentication code from a file.
#pragma once

#include "hal/messages/command_key.hpp"

namespace tumblesight::fsw::desktop {

// The file holds 64 hexadecimal digits; white space between them is ignored. An empty path gives the public
// development key, with a note on the standard error stream. Returns false if the file cannot be read or
// holds anything else: the reason is written to the standard error stream and `key` stays unchanged.
[[nodiscard]] bool read_command_key(const char* path, hal::CommandKey& key);

}  // namespace tumblesight::fsw::desktop
