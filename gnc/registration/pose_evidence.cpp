#include "gnc/registration/pose_evidence.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

// Costs of a ray [nats, Q8]. A return beside the target is less likely than one that is missing, and at the
// silhouette the mesh and the pose may be off by a part of a ray.
constexpr std::int32_t kMissingCost_q8 = 590, kUnexplainedCost_q8 = 1280, kSilhouetteCost_q8 = 256;
// That a surface is dark, and of a return from one.
constexpr std::int32_t kDarkSurfaceCost_q8 = 1280, kDarkReturnCost_q8 = 512;

// Limits of what fits.
constexpr std::int32_t kLargestMeanSquare_q8 = 410;
constexpr std::uint32_t kMostUnexplained_ppm = 30'000, kMostMissing_ppm = 690'000;
constexpr std::int64_t kSilhouetteRaysPerWrongOne = 8;

using Row = RayMask::Row;

// The rays of a row and their neighbours to the left and right.
Row widened(const Row& row) {
  Row wide = row;
  for (std::size_t i = 0; i < row.size(); ++i) {
    wide[i] |= (row[i] >> 1) | (row[i] << 1);
    if (i > 0) wide[i] |= row[i - 1] << (RayMask::kColumnsPerWord - 1);
    if (i + 1 < row.size()) wide[i] |= row[i + 1] >> (RayMask::kColumnsPerWord - 1);
  }
  return wide;
}

// Rays of the screen that are not drawn; those beside the screen count as such.
Row empty_of(const RenderedSurface& surface, int row) {
  Row empty{};
  for (std::size_t i = 0; i < empty.size(); ++i)
    empty[i] = row < 0 || row >= surface.rays ? ~0U : ~surface.filled.rows[static_cast<std::size_t>(row)][i];
  return empty;
}
Row drawn_of(const RenderedSurface& surface, int row) {
  return row < 0 || row >= surface.rays ? Row{} : surface.filled.rows[static_cast<std::size_t>(row)];
}

// Rays next to a drawn and to an empty one, or themselves such.
Row silhouette_of(const RenderedSurface& surface, int row) {
  Row drawn{}, empty{};
  for (int at = row - 1; at <= row + 1; ++at) {
    const Row wide_drawn = widened(drawn_of(surface, at)), wide_empty = widened(empty_of(surface, at));
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      drawn[i] |= wide_drawn[i];
      empty[i] |= wide_empty[i];
    }
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i] &= empty[i];
  return drawn;
}

std::uint32_t share_ppm(std::int32_t part, std::int32_t whole) {
  return static_cast<std::uint32_t>(divide(std::int64_t{part} * 1'000'000, max<std::int64_t>(whole, 1)));
}

}  // namespace

std::int32_t PoseEvidence::mean_square_q8() const {
  return static_cast<std::int32_t>(divide(squares_q8, max<std::int64_t>(blocks, 1)));
}

std::uint32_t PoseEvidence::unexplained_ppm() const {
  return share_ppm(unexplained, returned);
}

std::uint32_t PoseEvidence::missing_ppm() const {
  return share_ppm(missing + dark, drawn + dark);
}

std::int32_t PoseEvidence::cost_q8() const {
  const std::int64_t ranges_q8 = (squares_q8 - std::int64_t{blocks} * 256) / 2;
  return static_cast<std::int32_t>(ranges_q8) + missing * kMissingCost_q8 +
         unexplained * kUnexplainedCost_q8 + silhouette * kSilhouetteCost_q8 +
         dark_surfaces * kDarkSurfaceCost_q8 + dark_returned * kDarkReturnCost_q8;
}

bool PoseEvidence::fits_ranges() const {
  return blocks > 0 && mean_square_q8() <= kLargestMeanSquare_q8;
}

bool PoseEvidence::fits_returns() const {
  return unexplained_ppm() <= kMostUnexplained_ppm && missing_ppm() <= kMostMissing_ppm;
}

bool PoseEvidence::fits_silhouette(int halves) const {
  const std::int64_t rays = silhouette_rays, drawn_rays = max(1, drawn);
  return 2 * kSilhouetteRaysPerWrongOne * drawn_rays * silhouette <=
         halves * rays * (drawn_rays + kSilhouetteRaysPerWrongOne / 2 * missing);
}

PoseEvidence evidence_of(const FrameView& view, const RenderedSurface& surface, const RangeFit& ranges,
                         std::int32_t dark_surfaces) {
  PoseEvidence evidence;
  for (int row = 0; row < view.rays; ++row) {
    const Row& drawn_row = surface.filled.rows[static_cast<std::size_t>(row)];
    const Row& returned_row = view.returned.rows[static_cast<std::size_t>(row)];
    const Row& hidden_row = view.hidden.rows[static_cast<std::size_t>(row)];
    const Row& dark_row = surface.dark.rows[static_cast<std::size_t>(row)];
    const Row silhouette_row = silhouette_of(surface, row);
    for (std::size_t i = 0; i < silhouette_row.size(); ++i) {
      const std::uint32_t drawn = drawn_row[i], returned = returned_row[i], dark = dark_row[i];
      const std::uint32_t inside = ~hidden_row[i] & ~silhouette_row[i];
      evidence.drawn += count_ones(drawn & inside);
      evidence.missing += count_ones(drawn & ~returned & inside);
      evidence.returned += count_ones(returned);
      evidence.unexplained += count_ones(returned & ~drawn & ~dark & inside);
      evidence.dark += count_ones(dark & ~hidden_row[i]);
      evidence.dark_returned += count_ones(dark & returned & inside);
      evidence.silhouette_rays += count_ones(~hidden_row[i] & silhouette_row[i]);
      evidence.silhouette += count_ones((returned ^ drawn) & ~hidden_row[i] & silhouette_row[i]);
    }
  }
  evidence.dark_surfaces = surface.has_dark ? dark_surfaces : 0;
  evidence.blocks = ranges.blocks;
  evidence.squares_q8 = ranges.squares_q8;
  return evidence;
}

}  // namespace tumblesight::gnc
