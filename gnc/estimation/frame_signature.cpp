#include "gnc/estimation/frame_signature.hpp"

#include <cstddef>

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

namespace {

constexpr std::uint32_t kIsReturn = 0x80;
constexpr std::size_t kMask = kSignatureSide - 1;

// 0 for a range outside the gate, which is no return.
std::uint32_t usable(std::uint16_t range_counts) {
  const std::int32_t range = range_counts;
  return static_cast<std::uint32_t>(range & ~sign_mask(range - kMinRange_counts) &
                                    sign_mask(range - kMaxRange_counts - 1));
}

std::size_t rays_of(const RangeImage& frame) {
  return static_cast<std::size_t>(min<int>(frame.rays, RangeImage::kMaxRays));
}

// The cells of two neighbouring columns: 16 bits each, of which the low eight are used.
using CellPair = std::uint32_t;
constexpr std::size_t kPairs = kSignatureSide / 2;
// Adds a pair of ranges. Masks instead of branches, for both at once: the highest bit of each half says
// whether its range is at least the nearest, and beyond the farthest, of the gate.
void add_pair(CellPair ranges, CellPair& cells) {
  constexpr CellPair kOne = 0x0001'0001;
  constexpr CellPair kHalf = 0x8000;
  const CellPair low = ranges & (kHalf - 1) * kOne;
  const CellPair is_far_enough = ranges | (low + (kHalf - kMinRange_counts) * kOne);
  const CellPair is_beyond = ranges & (low + (2 * kHalf - kMaxRange_counts - 1) * kOne);
  const CellPair is_return = ((is_far_enough & ~is_beyond) >> 15) & kOne;
  const CellPair is_new = (is_return & ~(cells >> 7)) * 0xFFU;
  cells |= (ranges | kIsReturn * kOne) & is_new;
}

// Groups with returns that are looked at. Enough for kMost cells of a frame in which every ray has a return.
constexpr int kMostGroups = 100;
void add_rays(const RangeImage& frame, int first, int end, SignatureStart& start) {
  const int rays = static_cast<int>(rays_of(frame));
  int row = first / rays, column = first - row * rays;
  for (int ray = first; ray < end; ++ray) {
    const std::uint32_t range = usable(frame.ranges[static_cast<std::size_t>(ray)]);
    const std::size_t place = static_cast<std::size_t>(row) % kSignatureSide * kSignatureSide +
                              static_cast<std::size_t>(column) % kSignatureSide;
    if (range != 0 && start.cells[place] == 0) {
      start.cells[place] = static_cast<std::uint8_t>((range | kIsReturn) & 0xFFU);
      start.places[start.filled++] = static_cast<std::uint8_t>(place);
    }
    if (++column == rays) {
      column = 0;
      ++row;
    }
  }
}

}  // namespace

FrameSignature signature_of(const RangeImage& frame) {
  std::array<std::array<CellPair, kPairs>, kSignatureSide> pairs{};
  const std::size_t rays = rays_of(frame);
  for (std::size_t row = 0; row < rays; ++row) {
    const std::uint16_t* const ranges = &frame.ranges[row * rays];
    auto& cells = pairs[row & kMask];
    for (std::size_t first = 0; first < rays; first += kSignatureSide) {
      const std::size_t left = rays - first;
      const std::size_t columns = left < kSignatureSide ? left : kSignatureSide;
      for (std::size_t i = 0; i < columns / 2; ++i)
        add_pair(ranges[first + 2 * i] | CellPair{ranges[first + 2 * i + 1]} << 16, cells[i]);
      if (columns % 2 != 0) add_pair(ranges[rays - 1], cells[columns / 2]);
    }
  }
  FrameSignature signature{};
  for (std::size_t i = 0; i < signature.size(); ++i) {
    const CellPair pair = pairs[i / kSignatureSide][i % kSignatureSide / 2];
    signature[i] = static_cast<std::uint8_t>((pair >> (16 * (i % 2))) & 0xFFU);
  }
  return signature;
}

SignatureStart start_of(const RangeImage& frame) {
  SignatureStart start;
  const auto rays = static_cast<int>(rays_of(frame));
  const int count = rays * rays;
  if (count == 0) return start;
  int ray = min(kFirstOfPair, count);
  add_rays(frame, 0, ray, start);
  for (int groups = 0; groups < kMostGroups && start.filled < SignatureStart::kMost; ++groups) {
    ray = skip_empty(frame, ray, count);
    const int end = min(ray + kRaysOfGroup, count);
    add_rays(frame, ray, end, start);
    ray = end;
    if (ray == count) break;
  }
  return start;
}

bool FrameHistory::contains(const FrameSignature& signature) const {
  bool found = false;
  for (const FrameSignature& used : signatures_) found |= is_repetition(used, signature);
  return found;
}

bool FrameHistory::contains_alike(const SignatureStart& start) const {
  bool found = false;
  for (const FrameSignature& used : signatures_) found |= is_alike(used, start);
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
  return returns > 0 && 2 * equal >= returns;
}

bool is_alike(const FrameSignature& earlier, const SignatureStart& later) {
  const std::uint32_t compared = min(later.filled, SignatureStart::kCompared);
  std::uint32_t equal = 0;
  for (std::uint32_t i = 0; i < compared; ++i) {
    const std::size_t place = later.places[i];
    const auto difference = static_cast<std::uint32_t>(earlier[place] ^ later.cells[place]);
    equal += (difference - 1U) >> 31;
  }
  return compared > 0 && 4 * equal >= compared;
}

}  // namespace tumblesight::gnc
