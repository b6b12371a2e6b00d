// Board: what a program needs from a machine without an operating system. One implementation per board,
// chosen at link time.
#pragma once

#include <cstdint>

namespace tumblesight::hal::board {

// Writes NUL-terminated text to the console.
void write(const char* text);

// Monotonic time with an arbitrary origin.
std::uint64_t now_ns();

// Ends the program. `status` is passed on where the machine can return one; 0 is success.
[[noreturn]] void end(int status);

}  // namespace tumblesight::hal::board
