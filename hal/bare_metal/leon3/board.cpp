// APB UART 1 and GPTIMER 1. The program ends in the processor's error mode, where QEMU stops. QEMU reports no
// status, so end() writes it to the console.
#include "hal/board.hpp"

namespace tumblesight::hal::board {
namespace {

struct Uart {
  volatile std::uint32_t data, status, control;
};
struct Timer {
  volatile std::uint32_t scaler, scaler_reload, configuration, unused, counter, reload, control;
};
Uart& uart() {
  return *reinterpret_cast<Uart*>(0x80000100);
}
Timer& timer() {
  return *reinterpret_cast<Timer*>(0x80000300);
}
constexpr std::uint32_t kTransmitterEmpty = 4, kTransmitAndReceive = 3;
constexpr std::uint32_t kCyclesToTick = 50, kTick_ns = 1000;  // 50 MHz
constexpr std::uint32_t kEnableRestartLoad = 7;

}  // namespace

void write(const char* text) {
  uart().control = kTransmitAndReceive;
  for (; *text != '\0'; ++text) {
    while ((uart().status & kTransmitterEmpty) == 0) {
    }
    uart().data = static_cast<std::uint8_t>(*text);
  }
}

// Must be called at least every 71 minutes, the period of the counter.
std::uint64_t now_ns() {
  static std::uint64_t ticks = 0;
  static std::uint32_t last = 0;
  static bool running = false;
  if (!running) {
    timer().scaler_reload = kCyclesToTick - 1;
    timer().scaler = kCyclesToTick - 1;
    timer().reload = 0xFFFFFFFF;
    timer().control = kEnableRestartLoad;
    running = true;
  }
  const std::uint32_t passed = ~timer().counter;
  ticks += passed - last;
  last = passed;
  return ticks * kTick_ns;
}

void end(int status) {
  write(status == 0 ? "ended: success\n" : "ended: failure\n");
  // A trap while traps are disabled leads to error mode.
  asm volatile("wr %%g0, 0x1fc0, %%psr\n nop\n nop\n nop\n ta 0" ::: "memory");
  for (;;) {
  }
}

}  // namespace tumblesight::hal::board
