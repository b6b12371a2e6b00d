// The start-up common to all boards: initializes memory, runs constructors, calls main(). A board's start_up
// sets up the processor and the stack, then calls start_program().
#include <cstdint>
#include <cstring>

#include "hal/board.hpp"

// Addresses from the board's linker script.
extern "C" {
extern std::uint8_t data_start[], data_end[], data_load[], bss_start[], bss_end[];
using Constructor = void (*)();
extern const Constructor init_array_start[], init_array_end[];

int main(int argc, char** argv);
[[noreturn]] void start_program();
[[noreturn]] void unexpected_trap();
[[noreturn]] void __cxa_pure_virtual();
}

void start_program() {
  std::memcpy(data_start, data_load, static_cast<std::size_t>(data_end - data_start));
  std::memset(bss_start, 0, static_cast<std::size_t>(bss_end - bss_start));
  for (const Constructor* constructor = init_array_start; constructor != init_array_end; ++constructor)
    (*constructor)();
  tumblesight::hal::board::end(main(0, nullptr));  // no command line
}

// Any exception of the processor: none of them is expected.
void unexpected_trap() {
  tumblesight::hal::board::write("unexpected trap\n");
  tumblesight::hal::board::end(3);
}

void __cxa_pure_virtual() {
  unexpected_trap();
}
