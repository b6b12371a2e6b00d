#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

std::int32_t elapsed_ms(std::int64_t earlier_ns, std::int64_t later_ns) {
  const bool forward = later_ns >= earlier_ns;
  const std::uint64_t apart_ns =
      forward ? static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns)
              : static_cast<std::uint64_t>(earlier_ns) - static_cast<std::uint64_t>(later_ns);
  const auto apart_ms = static_cast<std::int64_t>(apart_ns / 1'000'000U);
  return clamp_to_int32(forward ? apart_ms : -apart_ms);
}

std::uint32_t elapsed_us(std::uint64_t start_ns, std::uint64_t end_ns) {
  const std::uint64_t elapsed = end_ns > start_ns ? (end_ns - start_ns) / 1000U : 0U;
  return elapsed < UINT32_MAX ? static_cast<std::uint32_t>(elapsed) : UINT32_MAX;
}

}  // namespace tumblesight::fsw
