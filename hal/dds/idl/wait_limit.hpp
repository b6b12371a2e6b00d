// WaitLimit: a limit on a wait for the other side, without the time in which this process itself was paused
// by Ctrl-Z, a debugger or a frozen container. A waiting program checks many times a second. If a check comes
// later than kLongestLook_ns, the program was paused, and the time counts as kLongestLook_ns.
#pragma once

#include <cstdint>

namespace tumblesight::hal::dds {

class WaitLimit {
 public:
  static constexpr std::uint64_t kLongestLook_ns = 1'000'000'000;

  WaitLimit() = default;
  WaitLimit(std::uint64_t now_ns, std::uint64_t limit_ns) : last_look_ns_(now_ns), limit_ns_(limit_ns) {}

  bool is_over(std::uint64_t now_ns) {
    const std::uint64_t since_ns = now_ns - last_look_ns_;
    last_look_ns_ = now_ns;
    waited_ns_ += since_ns < kLongestLook_ns ? since_ns : kLongestLook_ns;
    return waited_ns_ > limit_ns_;
  }

 private:
  std::uint64_t last_look_ns_ = 0;
  std::uint64_t limit_ns_ = 0;
  std::uint64_t waited_ns_ = 0;
};

}  // namespace tumblesight::hal::dds
