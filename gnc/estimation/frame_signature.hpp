// FrameSignature: what is kept of a frame to see that the sensor repeats it, also if some of its ranges
// change. The noise of a working sensor changes almost every range from frame to frame.
//
// The rays are folded into 16 x 16 cells: row and column modulo 16. A cell keeps the low bits of the first
// return among its rays, from 10 to 500 m. So a target fills the cells however small it is in the frame, and
// a range that changes affects at most one cell.
//
// Limits: sensors with a resolution of 0.5 m or coarser repeat too many low bits. Stuck pixels within the
// range gate that fill half of the cells before the target does make every frame a repetition.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::gnc {

inline constexpr int kSignatureSide = 16;
using FrameSignature = std::array<std::uint8_t, kSignatureSide * kSignatureSide>;  // 0: no return

// The instruction count depends on the number of rays only.
FrameSignature signature_of(const RangeImage& frame);

// The first cells of a frame's signature that its rays fill, in their order: a fraction of the cost of a
// signature. It chooses which frames are compared in full. It misses a repetition whose first rows have stray
// returns, and it finds frames alike that differ below stuck rows. The instruction count depends on the
// ranges. It is bounded by that of a frame with few returns.
struct SignatureStart {
  static constexpr std::uint32_t kCompared = 64;
  // Where one of two frames lacks some returns, the start of the other one reaches farther.
  static constexpr std::uint32_t kMost = 96;
  FrameSignature cells{};
  std::array<std::uint8_t, kMost + 7> places{};  // of the filled cells; eight rays are added at once
  std::uint32_t filled = 0;
};
SignatureStart start_of(const RangeImage& frame);

// The last frames that were used. Buffers of a frozen sensor that are delivered in turn are seen as long as
// all of them are here: drivers have two to four, frame grabbers up to eight.
class FrameHistory {
 public:
  static constexpr std::size_t kFrames = 8;
  bool contains(const FrameSignature& signature) const;    // is_repetition() of one of them
  bool contains_alike(const SignatureStart& start) const;  // is_alike() to one of them
  void add(const FrameSignature& signature);               // replaces the oldest
  const std::array<FrameSignature, kFrames>& signatures() const { return signatures_; }
  std::uint32_t next() const { return next_; }

 private:
  std::array<FrameSignature, kFrames> signatures_{};
  std::uint32_t next_ = 0;  // the place of the oldest
};

// Whether at least half of the cells in which one of both frames has a return are equal. Of two different
// frames of a scene that stands still fewer are equal if the noise is at least a count of the range (8 mm);
// with the paper's noise it is one in twenty-five. False if no cell has a return.
bool is_repetition(const FrameSignature& a, const FrameSignature& b);
// Whether at least a quarter of the first kCompared cells of `later` are equal to those of `earlier`. False
// if no cell has a return.
bool is_alike(const FrameSignature& earlier, const SignatureStart& later);

}  // namespace tumblesight::gnc
