// FrameSignature: what is kept of a frame to see that the sensor repeats it, also if some of its ranges
// change. The noise of a working sensor changes almost every range from frame to frame.
//
// The rays are folded into 16 x 16 cells: row and column modulo 16. A cell keeps the low bits of the first
// return among its rays. So a target fills the cells however small it is in the frame, and a range that
// changes affects at most one cell.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::gnc {

inline constexpr int kSignatureSide = 16;
using FrameSignature = std::array<std::uint8_t, kSignatureSide * kSignatureSide>;  // 0: no return

// The instruction count depends on the number of rays only.
FrameSignature signature_of(const RangeImage& frame);

// Whether at least three quarters of the cells in which one of both frames has a return are equal. Of two
// different frames of one scene fewer than a half are equal if the noise is at least half a count of the
// range (4 mm). False if no cell has a return.
bool is_repetition(const FrameSignature& a, const FrameSignature& b);

}  // namespace tumblesight::gnc
