// Console and exit by semihosting, for QEMU or a debugger. A real board uses a UART and a reset.
#include "hal/board.hpp"

namespace tumblesight::hal::board {
namespace {

std::uint32_t semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
constexpr std::uint32_t kWrite0 = 0x04, kExitExtended = 0x20, kApplicationExit = 0x20026;

// CMSDK timer 0: counts down from 2^32 at 25 MHz.
struct Timer {
  volatile std::uint32_t control, value, reload;
};
Timer& timer() {
  return *reinterpret_cast<Timer*>(0x40000000);
}
constexpr std::uint64_t kTick_ns = 40;

}  // namespace

void write(const char* text) {
  semihosting(kWrite0, text);
}

// Must be called at least every 171 s, the period of the counter.
std::uint64_t now_ns() {
  static std::uint64_t ticks = 0;
  static std::uint32_t last = 0;
  if (timer().control == 0) {
    timer().reload = 0xFFFFFFFF;
    timer().value = 0xFFFFFFFF;
    timer().control = 1;
  }
  const std::uint32_t passed = ~timer().value;
  ticks += passed - last;
  last = passed;
  return ticks * kTick_ns;
}

void end(int status) {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  semihosting(kExitExtended, block);
  for (;;) {
  }
}

}  // namespace tumblesight::hal::board
