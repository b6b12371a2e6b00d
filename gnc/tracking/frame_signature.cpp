#include "gnc/tracking/frame_signature.hpp"

#include <cstddef>

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

FrameSignature signature_of(const RangeImage& frame) {
  constexpr std::uint32_t kIsReturn = 0x80;
  constexpr std::size_t kMask = kSignatureSide - 1;
  FrameSignature signature{};
  const auto rays = static_cast<std::size_t>(min<int>(frame.rays, RangeImage::kMaxRays));
  for (std::size_t row = 0; row < rays; ++row) {
    const std::uint16_t* const ranges = &frame.ranges[row * rays];
    std::uint8_t* const cells = &signature[(row & kMask) * kSignatureSide];
    for (std::size_t column = 0; column < rays; ++column) {
      // Masks instead of branches: ~0 for a return, and for a cell without one.
      const std::uint32_t range = ranges[column], cell = cells[column & kMask];
      const std::uint32_t is_return = 0U - ((0U - range) >> 31);
      const std::uint32_t is_free = (cell >> 7) - 1U;
      cells[column & kMask] =
          static_cast<std::uint8_t>(cell | ((range | kIsReturn) & is_return & is_free & 0xFFU));
    }
  }
  return signature;
}

bool FrameHistory::contains(const FrameSignature& signature) const {
  bool found = false;
  for (const FrameSignature& used : signatures_) found |= is_repetition(used, signature);
  return found;
}

void FrameHistory::add(const FrameSignature& signature) {
  signatures_[next_ % kFrames] = signature;
  next_ = (next_ + 1) % kFrames;
}

bool is_repetition(const FrameSignature& a, const FrameSignature& b) {
  std::uint32_t returns = 0, equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto is_return = static_cast<std::uint32_t>(a[i] | b[i]) >> 7;
    const auto difference = static_cast<std::uint32_t>(a[i] ^ b[i]);
    returns += is_return;
    equal += is_return & ((difference - 1U) >> 31);
  }
  return returns > 0 && 4 * equal >= 3 * returns;
}

bool is_repetition(const RangeImage& a, const RangeImage& b) {
  if (a.rays != b.rays || a.rays > RangeImage::kMaxRays) return false;
  constexpr std::uint32_t kMostPairs = 512;
  const int rays = a.rays * a.rays;
  std::uint32_t returns = 0, equal = 0;
  for (int i = kFirstOfPair; i + 1 < rays && returns < kMostPairs; i += 2) {
    const std::uint32_t pair_a = pair_at(a, i), pair_b = pair_at(b, i);
    if ((pair_a | pair_b) == 0) continue;
    ++returns;
    if (pair_a == pair_b) ++equal;
  }
  return returns > 0 && 2 * equal >= returns;
}

}  // namespace tumblesight::gnc
