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
inline std::int32_t elapsed_ms(std::int64_t earlier_ns, std::int64_t later_ns) {
  const bool forward = later_ns >= earlier_ns;
  const std::uint64_t apart_ns =
      forward ? static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns)
              : static_cast<std::uint64_t>(earlier_ns) - static_cast<std::uint64_t>(later_ns);
  const auto apart_ms = static_cast<std::int64_t>(apart_ns / 1'000'000U);
  return clamp_to_int32(forward ? apart_ms : -apart_ms);
}

// end - start in microseconds, clamped to 32 bits; 0 if the stopwatch runs backwards.
inline std::uint32_t elapsed_us(std::uint64_t start_ns, std::uint64_t end_ns) {
  const std::uint64_t elapsed = end_ns > start_ns ? (end_ns - start_ns) / 1000U : 0U;
  return elapsed < UINT32_MAX ? static_cast<std::uint32_t>(elapsed) : UINT32_MAX;
}

}  // namespace tumblesight::fsw
