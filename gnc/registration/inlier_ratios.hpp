// InlierRatios: how much of a depth image lies on the target at an attitude, and how much of the target shows
// in it, as the shares that do not. An independent check of the network: it knows the shape of the target
// only, and no training. Specification: docs/numerics.md.
//
// The surface points that face the sensor are drawn into a grid of 50 x 50 cells over the swath, the nearest
// one in front. The drawing is moved across the view to where it fits best, since the depth image shows the
// target relative to the centroid of its returns. Then both are compared cell by cell.
//
// Limits: it tells another object, or an attitude with another silhouette; it does not tell alternatives of a
// nearly symmetric target whose silhouettes differ by less than a cell. A hidden part of the target counts as
// missing, so that a frame which shows less than about half of the target may count as unexplained.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_noise.hpp"
#include "gnc/surface/surface_model.hpp"

namespace tumblesight::gnc {

// Ratios in Q0.16: 65536 is 1.
inline constexpr std::uint32_t kWholeShare = 65536;

struct InlierRatios {
  bool is_known = false;           // false: the model image has no surface, and the ratios are 0
  std::uint32_t outliers = 0;      // of the cells with returns: more than a cell from the target's silhouette
  std::uint32_t missing = 0;       // of the target's cells: more than a cell from any return
  std::uint32_t depth_misfit = 0;  // of the cells of both: mean difference of the depths, 1 at 2.5 sigma
};

// One figure of merit: 0 for a perfect fit, and where nothing is known. The weights are those of the logistic
// regression of "more than 20 degrees off" on the three ratios, over the paper's conditions and the effects
// on body and surface.
inline std::uint32_t misfit_of(const InlierRatios& ratios) {
  return ratios.outliers + 5 * ratios.missing / 8 + ratios.depth_misfit / 2;
}

// Working memory. The caller holds it, so that nothing large is on the stack; it need not be initialized.
struct InlierRatiosScratch {
  static constexpr int kSide = 50;              // cells per side; each is 2 x 2 of the depth image
  static constexpr int kBorder = 4;             // rows and columns by which the drawing is moved at most
  static constexpr int kDrawnSide = kSide + 2;  // with a border for what falls outside
  static constexpr int kRows = kSide + 2 * kBorder;
  // A depth is in units of the target's radius / 32767, away from the sensor.
  static constexpr std::int16_t kEmpty = 0x7FFF;  // depth of an empty cell
  using Cells = std::array<std::int16_t, kSide * kSide>;
  // Bit kFirstBit + column of a row is set where the cell is not empty.
  static constexpr int kFirstBit = 7;
  using Rows = std::array<std::uint64_t, kRows>;

  std::array<std::int16_t, kDrawnSide * kDrawnSide> drawn;  // relative to the TRF's origin
  Cells seen, expected;
  Rows seen_rows, near_seen_rows, expected_rows, near_expected_rows;
  std::array<std::uint16_t, 256> histogram;
};

// `r_lrf_trf`: a rotation; anything else gives ratios without a meaning. The instruction count is the same
// for every image, attitude and surface.
[[nodiscard]] InlierRatios inlier_ratios(const DepthImage& image, const DepthProjection& projection,
                                         const RangeNoise& noise, const Matrix3<Fixed>& r_lrf_trf,
                                         const SurfaceModel& surface, InlierRatiosScratch& scratch);

}  // namespace tumblesight::gnc
