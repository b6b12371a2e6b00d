#include "gnc/tracking/frame_signature.hpp"

#include <cstddef>

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

namespace {

constexpr std::uint32_t kIsReturn = 0x80;
constexpr std::size_t kMask = kSignatureSide - 1;

std::size_t rays_of(const RangeImage& frame) {
  return static_cast<std::size_t>(min<int>(frame.rays, RangeImage::kMaxRays));
}

// Most rays meet nothing.
constexpr std::size_t kRaysAtOnce = 8;
bool has_no_return(const RangeImage& frame, int first) {
  const std::uint32_t half = pair_at(frame, first) | pair_at(frame, first + 2);
  return (half | pair_at(frame, first + 4) | pair_at(frame, first + 6)) == 0;
}

void add_ray(const RangeImage& frame, std::size_t ray, std::size_t rays, SignatureStart& start) {
  const std::uint32_t range = frame.ranges[ray];
  if (range == 0) return;
  const std::size_t place = (ray / rays & kMask) * kSignatureSide + (ray % rays & kMask);
  if (start.cells[place] != 0) return;
  start.cells[place] = static_cast<std::uint8_t>((range | kIsReturn) & 0xFFU);
  start.places[start.filled++] = static_cast<std::uint8_t>(place);
}

}  // namespace

FrameSignature signature_of(const RangeImage& frame) {
  FrameSignature signature{};
  const std::size_t rays = rays_of(frame);
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

SignatureStart start_of(const RangeImage& frame) {
  SignatureStart start;
  const std::size_t rays = rays_of(frame);
  const std::size_t count = rays * rays;
  std::size_t ray = 0;
  for (; ray < min<std::size_t>(kFirstOfPair, count); ++ray) add_ray(frame, ray, rays, start);
  for (; ray + kRaysAtOnce <= count; ray += kRaysAtOnce) {
    if (has_no_return(frame, static_cast<int>(ray))) continue;
    for (std::size_t i = 0; i < kRaysAtOnce; ++i) add_ray(frame, ray + i, rays, start);
    if (start.filled >= SignatureStart::kMost) return start;
  }
  for (; ray < count; ++ray) add_ray(frame, ray, rays, start);
  return start;
}

bool FrameHistory::contains(const FrameSignature& signature) const {
  bool found = false;
  for (const FrameSignature& used : signatures_) found |= is_repetition(used, signature);
  return found;
}

bool FrameHistory::contains(const SignatureStart& start) const {
  bool found = false;
  for (const FrameSignature& used : signatures_) found |= is_repetition(used, start);
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

bool is_repetition(const FrameSignature& earlier, const SignatureStart& later) {
  const std::uint32_t compared = min(later.filled, SignatureStart::kCompared);
  std::uint32_t equal = 0;
  for (std::uint32_t i = 0; i < compared; ++i) {
    const std::size_t place = later.places[i];
    const auto difference = static_cast<std::uint32_t>(earlier[place] ^ later.cells[place]);
    equal += (difference - 1U) >> 31;
  }
  return compared > 0 && 4 * equal >= 3 * compared;
}

}  // namespace tumblesight::gnc
