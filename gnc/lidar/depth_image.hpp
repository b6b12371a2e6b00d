// DepthImage: what the network eats, and the projection of a RangeImage onto it. In integers, whatever the
// network's numerics; docs/numerics.md is the norm.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

// Depth of the target, seen along the view's +y, row 0 at the top (+z), column 0 at the left (-x). Unsigned, 16
// bits behind the point. 0 = nothing there; otherwise from 1/256 to 1, nearer is brighter.
//
// The view is the LRF turned, by the shortest arc, so that its +y passes through the centroid of the returns.
// In it a target off the boresight looks as it would on the boresight: what is learnt there holds everywhere.
struct DepthImage {
  static constexpr int kSide = 100;
  static constexpr int kCells = kSide * kSide;
  static constexpr int kLargest = 65535;  // as near to 1 as 16 bits allow
  static constexpr int kSmallest = 256;   // of a return, which is never mistaken for an empty cell
  std::array<std::uint16_t, kCells> depth{};
  Matrix3<Fixed> r_lrf_view = Matrix3<Fixed>::Identity();  // v_lrf = r_lrf_view v_view
};

enum class DepthEncoding : std::uint8_t {
  kCentroidRelative = 0,  // 0.5 + 0.5 (centroid depth - depth) / target radius, clamped
  // depth / largest depth of the image (paper, "Image" in the data generation section); the view is the LRF
  kPaperMaximum = 1,
};

// How a frame becomes an image; part of the model image, since the network is trained for it.
struct DepthProjection {
  std::uint32_t swath_mm = 0;          // side of the square across the boresight that the image covers
  std::uint32_t target_radius_mm = 0;  // scale of the centroid-relative depth
  DepthEncoding encoding = DepthEncoding::kCentroidRelative;
};
inline constexpr std::uint32_t kMinProjection_mm = 100;
inline constexpr std::uint32_t kMaxProjection_mm = 100'000;
bool is_possible(const DepthProjection& projection);

enum class FrameStatus : std::uint8_t {
  kOk = 0,
  kBadRayCount,  // rays outside 16..128
  kBadFov,       // field of view outside 1..40 degrees
  kEmpty,        // fewer than kMinReturns usable returns
  kFlat,         // every usable return at one and the same range: a stuck sensor, since real frames are noisy
};

// Accumulators of the projection, held by the caller so that nothing large lies on the stack. The last places take
// what falls into no cell, in turn: one place alone would have every ray wait for the one before.
struct DepthImageScratch {
  static constexpr int kOutside = 16;
  std::array<std::uint32_t, DepthImage::kCells + kOutside> depth_sum;  // 1/512 m
  std::array<std::uint16_t, DepthImage::kCells + kOutside> returns;
};

inline constexpr int kMinReturns = 16;
inline constexpr int kMinRange_m = 10;   // nearer is the chaser itself: an arm, a mast, a panel
inline constexpr int kMaxRange_m = 500;  // longer ranges count as no return (paper, sensor table)
inline constexpr std::uint32_t kMinFov_urad = 17'453;   // 1 degree
inline constexpr std::uint32_t kMaxFov_urad = 698'132;  // 40 degrees

// Projects the returns on the plane across the view's axis (x right, z up, axis in the middle), averages the
// depths (along +y) that fall in one cell and encodes them. Returns nearer than kMinRange_m, farther than
// kMaxRange_m or outside the swath are left out. The work done is the same for every frame of one ray count.
// On any status but kOk `image` is unspecified.
[[nodiscard]] FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                                           DepthImageScratch& scratch, DepthImage& image);

}  // namespace tumblesight::gnc
