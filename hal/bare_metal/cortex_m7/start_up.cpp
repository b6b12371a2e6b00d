// The vector table, and the set-up of the core before C++ code runs.
#include <cstdint>

extern "C" {
extern std::uint32_t stack_top[];
[[noreturn]] void start_program();
[[noreturn]] void unexpected_trap();
[[noreturn]] void reset();
}

using Handler = void (*)();
struct VectorTable {
  std::uint32_t* stack;
  Handler handlers[15];
};
extern "C" [[gnu::section(".first"), gnu::used]] const VectorTable vector_table = {
    stack_top,
    {reset, unexpected_trap, unexpected_trap, unexpected_trap, unexpected_trap, unexpected_trap, nullptr,
     nullptr, nullptr, nullptr, unexpected_trap, unexpected_trap, nullptr, unexpected_trap, unexpected_trap}};

// Enables the floating-point unit first: compiled code may use its registers anywhere.
void reset() {
  auto* const coprocessor_access = reinterpret_cast<volatile std::uint32_t*>(0xE000ED88);
  *coprocessor_access = *coprocessor_access | (0xFU << 20);
  asm volatile("dsb\n isb" ::: "memory");
  start_program();
}
