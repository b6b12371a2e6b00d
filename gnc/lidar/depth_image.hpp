// DepthImage: what the network eats, and the projection of a RangeImage onto it. In integers, whatever the
// network's numerics; docs/numerics.md is the norm.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

struct DepthLoops;  // the inner loops, of one instruction set: depth_loops.hpp

// Depth of the target, seen along the view's +y, row 0 at the top (+z), column 0 at the left (-x). Unsigned,
// 16 bits behind the point. 0 = nothing there; otherwise 0.5 + 0.5 (centroid depth - depth) / target radius,
// from 1/256 to 1: nearer is brighter.
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

// How a frame becomes an image; part of the model image, since the network is trained for it.
struct DepthProjection {
  std::uint32_t swath_mm = 0;          // side of the square across the boresight that the image covers
  std::uint32_t target_radius_mm = 0;  // scale of the depth
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

// Working memory of the projection, held by the caller so that nothing large lies on the stack.
struct DepthImageScratch {
  // What falls into no cell goes to the last ones, in turn: one alone would have every ray wait for the one
  // before.
  static constexpr int kSpareCells = 16;
  std::array<std::uint32_t, DepthImage::kCells + kSpareCells> cells;

  // The rays of a frame. Depths of it are counted in 2^-(6 + range_shift) m, so that the farthest fills 15
  // bits.
  struct Rays {
    int range_shift;
    std::array<std::int32_t, RangeImage::kMaxRays>
        slope30;  // of a column, or negated of a row; 30 bits behind the point
    std::array<std::int16_t, RangeImage::kMaxRays> square16;              // its square, 16 bits
    std::array<std::uint32_t, RangeImage::kMaxRays> row_sum, column_sum;  // of depths
  } rays;

  // The view. A coordinate of a point at depth 1 on a ray is the sum of its column's and its row's part.
  struct Coordinate {
    std::array<std::int16_t, RangeImage::kMaxRays> of_column, of_row;
  };
  struct View {
    Coordinate x, down;            // high half of the product with a depth: of a cell 2^-6, or up to 2^-2
    Coordinate depth;              // less 1, with 15 bits behind the point
    std::int16_t cells;            // high half of the product with a coordinate: whole cells
    std::int16_t middle;           // of the image, as a coordinate
    std::int16_t centroid;         // its depth in the view
    std::int16_t radius;           // of the target
    std::int16_t radius_scale;     // power of two that fills 15 bits with it
    std::int16_t value_of_radius;  // 0.25 over the radius so scaled, 15 bits behind the point
  } view;
};

inline constexpr int kMinReturns = 16;
inline constexpr int kMinRange_m = 10;   // nearer is the chaser itself: an arm, a mast, a panel
inline constexpr int kMaxRange_m = 500;  // longer ranges count as no return (paper, sensor table)
inline constexpr std::uint32_t kMinFov_urad = 17'453;   // 1 degree
inline constexpr std::uint32_t kMaxFov_urad = 698'132;  // 40 degrees

// Projects the returns on the plane across the view's axis (x right, z up, axis in the middle) and averages
// the depths that fall in one cell, none counting for more than a radius from the centroid. Returns nearer
// than kMinRange_m, farther than kMaxRange_m or outside the swath are left out. The work done is the same for
// every frame of one ray count. On any status but kOk `image` is unspecified.
[[nodiscard]] FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                                           DepthImageScratch& scratch, DepthImage& image);
[[nodiscard]] FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                                           DepthImageScratch& scratch, DepthImage& image,
                                           const DepthLoops& loops);

}  // namespace tumblesight::gnc
