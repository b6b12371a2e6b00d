// Board: what a flight program needs of the machine it runs on when there is no operating system to ask. One
// implementation a board, chosen at link time.
#pragma once

#include <cstdint>

namespace tumblesight::hal::board {

// To the console; `text` ends with a NUL.
void write(const char* text);

// Monotonic, arbitrary origin.
std::uint64_t now_ns();

// Ends the program and, where there is someone to tell, tells how: 0 is success.
[[noreturn]] void end(int status);

}  // namespace tumblesight::hal::board
