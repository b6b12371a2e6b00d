// Console and exit by semihosting, for QEMU or a debugger. A real board uses a UART and a reset.
#include "hal/board.hpp"

namespace tumblesight::hal::board {
namespace {

std::uint32_t semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("svc 0x123456" : "+r"(r0) : "r"(r1) : "memory", "lr");
  return r0;
}
constexpr std::uint32_t kWrite0 = 0x04, kExitExtended = 0x20, kApplicationExit = 0x20026;

}  // namespace

void write(const char* text) {
  semihosting(kWrite0, text);
}

// The cycle counter: a cycle takes 1 ns in QEMU. Must be called at least every 4.2 s, the period of the
// counter.
std::uint64_t now_ns() {
  static std::uint64_t total = 0;
  static std::uint32_t last = 0;
  std::uint32_t cycles;
  asm volatile("mrc p15, 0, %0, c9, c13, 0" : "=r"(cycles));
  total += cycles - last;
  last = cycles;
  return total;
}

void end(int status) {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  semihosting(kExitExtended, block);
  for (;;) {
  }
}

}  // namespace tumblesight::hal::board
