// Saturating counters, and conversions of times for events and telemetry.
#pragma once

#include <cstdint>
#include <limits>

namespace tumblesight::fsw {

// Saturates: a counter that wraps could look as if nothing had happened.
inline void count(std::uint32_t& counter, std::uint32_t by = 1) {
  const std::uint32_t room = std::numeric_limits<std::uint32_t>::max() - counter;
  counter += by < room ? by : room;
}

inline std::int32_t clamp_to_int32(std::int64_t value) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(value < kLowest ? kLowest : value > kHighest ? kHighest : value);
}

// later - earlier in milliseconds, for any two times, clamped to 32 bits. Negative if `later_ns` is earlier.
std::int32_t elapsed_ms(std::int64_t earlier_ns, std::int64_t later_ns);

// end - start in microseconds, clamped to 32 bits; 0 if the stopwatch runs backwards.
std::uint32_t elapsed_us(std::uint64_t start_ns, std::uint64_t end_ns);

}  // namespace tumblesight::fsw
