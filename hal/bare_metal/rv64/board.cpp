// A 16550 UART, the core-local timer, and QEMU's test device for the exit.
#include "hal/board.hpp"

namespace tumblesight::hal::board {
namespace {

template <class T>
volatile T& device(std::uintptr_t address) {
  return *reinterpret_cast<volatile T*>(address);
}
constexpr std::uintptr_t kUart = 0x10000000, kTimer = 0x0200BFF8, kTest = 0x00100000;
constexpr std::uint64_t kTick_ns = 100;
constexpr std::uint32_t kPass = 0x5555, kFail = 0x3333;

}  // namespace

void write(const char* text) {
  for (; *text != '\0'; ++text) device<std::uint8_t>(kUart) = static_cast<std::uint8_t>(*text);
}

std::uint64_t now_ns() {
  return device<std::uint64_t>(kTimer) * kTick_ns;
}

void end(int status) {
  device<std::uint32_t>(kTest) = status == 0 ? kPass : static_cast<std::uint32_t>(status) << 16 | kFail;
  for (;;) {
  }
}

}  // namespace tumblesight::hal::board
