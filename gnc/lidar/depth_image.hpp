// DepthImage: the input of the network, and the projection of a RangeImage onto it. The projection uses
// integers only, for both numerics of the network. Specification: docs/numerics.md.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "gnc/lidar/target_selection.hpp"
#include "gnc/lidar/target_window.hpp"
#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

struct DepthLoops;  // the inner loops for one instruction set: depth_loops.hpp

// Depth of the target along the +y axis of the view frame. Row 0 is the top (+z), column 0 the left (-x).
// Unsigned Q0.16: 0 is an empty cell, otherwise 0.5 + 0.5 (centroid depth - depth) / target radius, from
// 1/256 to 1, so that nearer points are brighter.
//
// The view frame is the LRF turned by the shortest rotation that points its +y axis at the centroid of the
// returns. A target off the boresight therefore looks as it would on the boresight, and what the network
// learned there holds across the field of view.
struct DepthImage {
  static constexpr int kSide = 100;  // cells per side
  static constexpr int kCells = kSide * kSide;
  static constexpr int kLargest = 65535;
  static constexpr int kSmallest = 256;  // of a cell with returns, so that it differs from an empty one
  std::array<std::uint16_t, kCells> depth{};
  Matrix3<Fixed> r_lrf_view = Matrix3<Fixed>::Identity();  // v_lrf = r_lrf_view v_view
  std::int32_t centroid_distance_mm = 0;                   // along the +y axis of the view frame
};

// How a frame is projected. Part of the model image, since the network is trained for it.
struct DepthProjection {
  std::uint32_t swath_mm = 0;          // side of the square across the view axis that the image covers
  std::uint32_t target_radius_mm = 0;  // scale of the depth
};
inline constexpr std::uint32_t kMinProjection_mm = 100;
inline constexpr std::uint32_t kMaxSwath_mm = 100'000;
// A deeper target would fill so many slices of the ranges that it passes for clutter (target_selection.hpp).
inline constexpr std::uint32_t kMaxTargetRadius_mm = 50'000;
// Whether both lengths are within these limits.
bool is_possible(const DepthProjection& projection);

enum class FrameStatus : std::uint8_t {
  kOk = 0,
  kBadRayCount,  // rays outside 16..128
  kBadFov,       // field of view outside 1..40 degrees
  kEmpty,        // fewer than kMinReturns usable returns
  kFlat,         // all usable returns have the same range: a stuck sensor, since real ranges are noisy
};

// Working memory of the projection. The caller holds it, so that nothing large is on the stack.
struct DepthImageScratch {
  // Rays that fall into no cell are added to these extra cells in turn. With a single extra cell, each
  // addition would wait for the previous one.
  static constexpr int kSpareCells = 16;
  using Cells = std::array<std::uint32_t, DepthImage::kCells + kSpareCells>;
  union {  // the target is selected before the first return is added to a cell
    TargetSelectionScratch selection;
    Cells cells;
  };
  RayMask mask;
  TargetWindow window;

  // The rays of the frame, then those of the window. Depths are counted in 2^-(6 + range_shift) m, so that
  // the farthest one fills 15 bits.
  struct Rays {
    int count;  // per side
    int range_shift;
    std::array<std::int32_t, RangeImage::kMaxRays> right_q30, down_q30;  // slopes: u of a column, -v of a row
    std::array<std::int16_t, RangeImage::kMaxRays> right_square_q16, down_square_q16;  // of the slopes
    std::array<std::uint32_t, RangeImage::kMaxRays> row_sum, column_sum;               // of the depths
  } rays;

  // The view frame. A coordinate of the point at depth 1 on a ray is the sum of a term of the ray's column
  // and a term of its row.
  template <class Number>
  struct Coordinate {
    std::array<Number, RangeImage::kMaxRays> column, row;
  };
  struct View {
    // In cells; the high half of the product with a depth has 2 to 6 fraction bits. Near the edge of a wide
    // field of view, only the sum of the terms fits into 16 bits, and only where the ray meets the image.
    Coordinate<std::int32_t> x, down;
    Coordinate<std::int16_t> depth;  // minus 1, Q0.15
    std::int16_t cells;           // the high half of the product with a coordinate is a whole number of cells
    std::int16_t middle;          // of the image, as a coordinate
    std::int16_t centroid;        // its depth in the view
    std::int16_t radius;          // of the target, in the unit of depth
    std::int16_t radius_scale;    // power of two that scales the radius to 15 bits
    std::int16_t inverse_radius;  // 0.25 / scaled radius, Q0.15
  } view;
};

inline constexpr std::uint32_t kMinFov_urad = 17'453;   // 1 degree
inline constexpr std::uint32_t kMaxFov_urad = 698'132;  // 40 degrees

// The status that make_depth_image() returns for this frame if all its returns are the target's. (It also
// refuses a frame in which too few are.) Reads no more of the frame than it must.
[[nodiscard]] FrameStatus check_frame(const RangeImage& frame);

// Selects the target's returns (target_selection.hpp), resamples them if the target covers few rays
// (target_window.hpp), projects them onto the plane across the view axis (x right, z up, axis in the middle)
// and averages the depths within each cell, of at most 255 returns. A depth is limited to one target radius
// from the centroid. Returns outside the swath are ignored. The instruction count is the same for every frame
// with the same ray count that is resampled, and for every one that is not.
//
// frame       any content; it is checked here
// projection  must satisfy is_possible()
// scratch     need not be initialized
// image       unspecified unless the result is kOk
// loops       inner loops to use; the overload without it takes the fastest ones of this processor
[[nodiscard]] FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                                           DepthImageScratch& scratch, DepthImage& image);
[[nodiscard]] FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                                           DepthImageScratch& scratch, DepthImage& image,
                                           const DepthLoops& loops);

}  // namespace tumblesight::gnc
