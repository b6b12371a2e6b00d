#include "gnc/registration/placement.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

using Blocks = PlacementScratch::Blocks;
constexpr int kBlocks = PlacementScratch::kBlocks, kBlockRays = PlacementScratch::kBlockRays;
// Of the search [blocks]: first every third shift, then those around the best.
constexpr int kReach = 9, kStride = 3;
// A shift has to explain this share more of the returns than the middles do.
constexpr std::int32_t kMoreOfDenominator = 16;
constexpr std::int32_t kPlateauOfDenominator = 64;  // shifts that explain nearly as many as the best one

// Sums over rays: their place and the mean inverse depth of the blocks that they are in.
struct Middle {
  std::int64_t rays = 0, columns = 0, rows = 0, inverse_depth = 0;
  void add(int row, int column, int count, std::int32_t value) {
    rays += count;
    columns += std::int64_t{count} * column;
    rows += std::int64_t{count} * row;
    inverse_depth += std::int64_t{count} * value;
  }
  std::int64_t mean_q8(std::int64_t sum) const { return divide(sum * 256, max<std::int64_t>(rays, 1)); }
};

// A shift of the drawn target on the screen.
struct Shift {
  int columns = 0, rows = 0;
};

void count_blocks(const RayMask& mask, Blocks& blocks) {
  constexpr int kBlocksPerWord = RayMask::kColumnsPerWord / kBlockRays;
  blocks = {};
  for (int row = 0; row < RangeImage::kMaxRays; ++row) {
    for (int column = 0; column < kBlocks; ++column) {
      const std::uint32_t word =
          mask.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column / kBlocksPerWord)];
      const std::uint32_t bits = (word >> (28 - kBlockRays * (column % kBlocksPerWord))) & 0xF;
      constexpr std::array<std::uint8_t, 16> kOnes{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
      std::uint8_t& sum =
          blocks[static_cast<std::size_t>(row / kBlockRays)][static_cast<std::size_t>(column)];
      sum = static_cast<std::uint8_t>(sum + kOnes[bits]);
    }
  }
}

std::int64_t rays_of(const Blocks& blocks) {
  std::int64_t sum = 0;
  for (const auto& row : blocks)
    for (const std::uint8_t rays : row) sum += rays;
  return sum;
}

bool is_clearly_more(std::int32_t explained, std::int32_t by_middles) {
  return (explained - by_middles) * kMoreOfDenominator > by_middles;
}

// Returns that the drawn target explains after a shift of whole blocks.
std::int32_t explained(const PlacementScratch& scratch, Shift shift) {
  std::int32_t sum = 0;
  const int first_row = max(0, shift.rows), end_row = min(kBlocks, kBlocks + shift.rows);
  const int first = max(0, shift.columns), end = min(kBlocks, kBlocks + shift.columns);
  for (int row = first_row; row < end_row; ++row) {
    const auto& seen = scratch.seen[static_cast<std::size_t>(row)];
    const auto& drawn = scratch.drawn[static_cast<std::size_t>(row - shift.rows)];
    for (int column = first; column < end; ++column)
      sum += min_small(seen[static_cast<std::size_t>(column)],
                       drawn[static_cast<std::size_t>(column - shift.columns)]);
  }
  return sum;
}

// The shift that explains the most returns; of a plateau its middle, in rays.
struct Found {
  std::int32_t most = 0;
  Shift shift;
};
void try_around(const PlacementScratch& scratch, Shift middle, int reach, int stride, Found& found) {
  for (int rows = -reach; rows <= reach; rows += stride) {
    for (int columns = -reach; columns <= reach; columns += stride) {
      const Shift shift{middle.columns + columns, middle.rows + rows};
      const std::int32_t here = explained(scratch, shift);
      if (here > found.most) found = {here, shift};
    }
  }
}
Shift middle_of_plateau(const PlacementScratch& scratch, const Found& found) {
  int columns = 0, rows = 0, count = 0;
  for (int down = -kStride; down <= kStride; ++down) {
    for (int right = -kStride; right <= kStride; ++right) {
      const Shift shift{found.shift.columns + right, found.shift.rows + down};
      if (found.most - explained(scratch, shift) > found.most / kPlateauOfDenominator) continue;
      columns += shift.columns;
      rows += shift.rows;
      ++count;
    }
  }
  const int divisor = max(1, count);
  return {kBlockRays * columns / divisor, kBlockRays * rows / divisor};
}

// By how much nearer the returns are than the surface where it is drawn after the shift [inverse depth].
std::int32_t nearer_by(const FrameView& view, const RenderedSurface& surface, Shift shift) {
  std::int64_t sum = 0, rays = 0;
  for (int row = 0; row + 1 < view.rays; row += 2) {
    for (int column = 0; column + 1 < view.rays; column += 2) {
      const int returns =
          rays_of_pair(view.returned.pair(row, column)) + rays_of_pair(view.returned.pair(row + 1, column));
      if (returns == 0 || !surface.is_filled(row - shift.rows, column - shift.columns)) continue;
      sum += std::int64_t{returns} * (view.inverse_depth_of_block(row / 2, column / 2) -
                                      surface.at(row - shift.rows, column - shift.columns));
      rays += returns;
    }
  }
  return static_cast<std::int32_t>(divide(sum, max<std::int64_t>(rays, 1)));
}

}  // namespace

void place(const SurfaceMesh& mesh, const FrameView& view, RenderedSurface& surface,
           PlacementScratch& scratch, Pose& pose, WorkBudget& budget) {
  render(mesh, view, pose, surface, budget);
  if (!budget.spend(work::kPlacement)) return;
  Middle seen, drawn;
  for (int row = 0; row + 1 < view.rays; row += 2) {
    for (int column = 0; column + 1 < view.rays; column += 2) {
      const int returns =
          rays_of_pair(view.returned.pair(row, column)) + rays_of_pair(view.returned.pair(row + 1, column));
      seen.add(row, column, returns, view.inverse_depth_of_block(row / 2, column / 2));
      if (surface.is_filled(row, column)) drawn.add(row, column, 1, surface.at(row, column));
    }
  }
  if (seen.rays == 0 || drawn.rays == 0) return;
  std::int64_t right_q8 = seen.mean_q8(seen.columns) - drawn.mean_q8(drawn.columns);
  std::int64_t down_q8 = seen.mean_q8(seen.rows) - drawn.mean_q8(drawn.rows);
  std::int64_t nearer_q8 = seen.mean_q8(seen.inverse_depth) - drawn.mean_q8(drawn.inverse_depth);

  count_blocks(view.returned, scratch.seen);
  count_blocks(surface.filled, scratch.drawn);
  const auto blocks = [](std::int64_t rays_q8) {
    return static_cast<int>((rays_q8 + 128 * kBlockRays) >> 10);
  };
  const Shift of_middles{blocks(right_q8), blocks(down_q8)};
  const std::int32_t by_middles = explained(scratch, of_middles);
  Found found{by_middles, of_middles};
  // No shift explains more than all returns, or than there are rays of the target.
  const auto most = static_cast<std::int32_t>(min(seen.rays, rays_of(scratch.drawn)));
  if (is_clearly_more(most, by_middles)) {
    if (!budget.spend(work::kSearch)) return;
    try_around(scratch, of_middles, kReach, kStride, found);
    try_around(scratch, found.shift, kStride - 1, 1, found);
  }
  if (is_clearly_more(found.most, by_middles)) {
    const Shift shift = middle_of_plateau(scratch, found);
    right_q8 = shift.columns * 256;
    down_q8 = shift.rows * 256;
    nearer_q8 = std::int64_t{nearer_by(view, surface, shift)} * 256;
  }
  const auto um = [&view](std::int64_t rays_q8) {
    return static_cast<std::int32_t>(
        divide(rays_q8 * view.target_radius_um, max<std::int64_t>(view.rays_per_radius_q8, 1)));
  };
  pose.origin_lrf_um[0] += um(right_q8);
  pose.origin_lrf_um[2] -= um(down_q8);
  pose.origin_lrf_um[1] -=
      static_cast<std::int32_t>((nearer_q8 * view.reference_depth_um) >> (8 + view.shift));
}

}  // namespace tumblesight::gnc
