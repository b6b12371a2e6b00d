#include "gnc/registration/range_fit.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/reciprocal.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kMargin = 2;                   // rays between the silhouette and what is well inside
constexpr std::int32_t kSteepest_q8 = 1250;  // tangent of the largest incidence that is used: 78 degrees

struct Block {
  std::int32_t inverse_depth;              // mean of the rendered rays
  std::int32_t per_column_x2, per_row_x2;  // change per ray, doubled
  std::int32_t difference;                 // measured minus rendered, sum over `rays`
  std::int32_t rays;
};

// `row`, `column`: of the upper left one of four rays that are filled. False if they do not lie on one plane
// or none returned.
bool take_block(const FrameView& view, const RenderedSurface& surface, int row, int column, Block& block) {
  const std::int16_t* const upper = &surface.inverse_depth[row * surface.rays + column];
  const std::int16_t* const lower = upper + surface.rays;
  const std::int32_t a = upper[0], b = upper[1], c = lower[0], d = lower[1];
  block = {(a + b + c + d) >> 2, (b - a) + (d - c), (c - a) + (d - b), 0, 0};
  // On a plane the opposite corners have the same sum.
  if (abs(a + d - b - c) > 16 + ((abs(block.per_column_x2) + abs(block.per_row_x2)) >> 4)) return false;
  const std::uint32_t upper_pair = view.returned.pair(row, column);
  const std::uint32_t lower_pair = view.returned.pair(row + 1, column);
  const std::int32_t expected = select(upper_pair >= 2, a, 0) + select((upper_pair & 1U) != 0, b, 0) +
                                select(lower_pair >= 2, c, 0) + select((lower_pair & 1U) != 0, d, 0);
  block.rays = rays_of_pair(upper_pair) + rays_of_pair(lower_pair);
  block.difference = block.rays * view.inverse_depth_of_block(row / 2, column / 2) - expected;
  return block.rays > 0;
}

// (a b) / 2^shift of numbers whose product may exceed 32 bits.
std::int32_t product(std::int32_t a, std::int32_t b, int shift) {
  return static_cast<std::int32_t>((std::int64_t{a} * b) >> shift);
}

class RangeRows {
 public:
  RangeRows(const FrameView& view, const Pose& pose) : view_(view) {
    slope_per_half_ray_q24_ = static_cast<std::int32_t>(divide(view.tan_half_fov_q30, view.rays) >> 6);
    for (std::size_t i = 0; i < 3; ++i)
      origin_q14_[i] = static_cast<std::int32_t>(
          divide(pose.origin_lrf_um[i] * (std::int64_t{1} << 14), view.target_radius_um));
    reference_q17_ = static_cast<std::int32_t>(
        divide(std::int64_t{view.reference_depth_um} * (1 << 17), view.target_radius_um));
    const std::int64_t per_count_q16 = divide(std::int64_t{1} << 32, view.noise_q8);
    for (int rays = 1; rays <= 4; ++rays)
      per_count_q16_[static_cast<std::size_t>(rays)] =
          static_cast<std::int32_t>(min<std::int64_t>(divide(per_count_q16, rays), (1 << 28) - 1));
  }

  // The slope to the right of the left edge of a column, Q14; for rows its opposite.
  std::int32_t slope_q14(int column) const {
    return ((2 * column - view_.rays) * slope_per_half_ray_q24_) >> 10;
  }

  // The change of an inverse depth, in 1/256 standard deviation, by a motion of the target; false where the
  // surface is too steep. `right`, `up`: slopes of the middle of the block, Q14.
  bool row_of(const Block& block, std::int32_t right, std::int32_t up,
              std::array<std::int32_t, kUnknowns>& out) const {
    // Inverse depth + 2^shift = depth_term + right_term right + up_term up, times the radius over the
    // reference depth; 2^13 to 2^15.
    const std::int32_t right_term = product(block.per_column_x2, view_.rays_per_radius_q8, 9);
    const std::int32_t up_term = -product(block.per_row_x2, view_.rays_per_radius_q8, 9);
    constexpr std::int32_t kSteep = 1 << 17;
    if (abs(right_term) >= kSteep || abs(up_term) >= kSteep) return false;
    const std::int32_t whole = (1 << view_.shift) + block.inverse_depth;
    const std::int32_t whole_term = high_product(2 * whole, 2 * view_.radius_over_depth_q30);
    const std::int32_t depth_term =
        whole_term -
        static_cast<std::int32_t>((std::int64_t{right_term} * right + std::int64_t{up_term} * up) >> 14);
    if (is_steep(right_term, up_term, depth_term)) return false;
    // Reference depth over twice the depth.
    const std::int32_t half_q30 =
        clamp<std::int32_t>(whole, 1 << (view_.shift - 1), (1 << (view_.shift + 2)) - 1) *
        (1 << (29 - view_.shift));
    // Where the ray meets the surface, from the TRF's origin, in radii (Q14).
    const std::int32_t depth_q14 = high_product(reciprocal_q28(half_q30), reference_q17_);
    const std::array<std::int32_t, 3> arm{product(depth_q14, right, 14) - origin_q14_[0],
                                          depth_q14 - origin_q14_[1],
                                          product(depth_q14, up, 14) - origin_q14_[2]};
    // A motion by m changes the inverse depth by -(terms . m) depth / reference depth ...
    const std::int32_t scale_q16 = -high_product(per_count_q16_[1] * 8, half_q30);
    std::array<std::int32_t, 3> along{right_term, depth_term, up_term};
    constexpr std::int64_t kLargest = 1 << 18;
    for (std::int32_t& element : along)
      element =
          static_cast<std::int32_t>(clamp((std::int64_t{element} * scale_q16) >> 16, -kLargest, kLargest));
    const auto cross = [&](std::size_t i, std::size_t k) {
      return static_cast<std::int32_t>((std::int64_t{arm[i]} * along[k] - std::int64_t{arm[k]} * along[i]) >>
                                       14);
    };
    out = {cross(1, 2), cross(2, 0), cross(0, 1), along[0], along[1], along[2]};
    return true;
  }
  // In 1/256 standard deviation of one ray, limited to 16 of them: a larger difference pulls no more.
  std::int32_t mean_in_sigmas_q8(const Block& block) const {
    constexpr std::int64_t kLargest = 16 << 8;
    const std::int64_t mean_q24 =
        std::int64_t{block.difference} * per_count_q16_[static_cast<std::size_t>(block.rays)];
    return static_cast<std::int32_t>(clamp(mean_q24 >> 16, -kLargest, kLargest));
  }

 private:
  static bool is_steep(std::int32_t right_term, std::int32_t up_term, std::int32_t depth_term) {
    const std::int32_t right = right_term >> 2, up = up_term >> 2;
    constexpr std::int32_t kMost = 46'340;  // its square is the largest that 31 bits hold
    const std::int32_t limit = min_small(((abs(depth_term) >> 2) * kSteepest_q8) >> 8, kMost);
    return static_cast<std::uint32_t>(right * right) + static_cast<std::uint32_t>(up * up) >
           static_cast<std::uint32_t>(limit * limit);
  }

  const FrameView& view_;
  std::int32_t slope_per_half_ray_q24_;
  std::array<std::int32_t, 3> origin_q14_{};
  std::int32_t reference_q17_;  // reference depth in radii
  // 1/256 standard deviation per count of inverse depth, over the number of rays.
  std::array<std::int32_t, 5> per_count_q16_{};
};

// 1 / (1 + (x / 2.5)^2)^2 of x standard deviations, Q12, in steps of 1/16 of one up to 16 of them.
constexpr std::array<std::int16_t, 257> kRobustWeight_q12 = [] {
  std::array<std::int16_t, 257> weight{};
  for (std::int64_t i = 0; i < 257; ++i) {
    const std::int64_t root_q20 = (std::int64_t{1} << 36) / ((1 << 16) + i * i * 256 * 4 / 25);
    weight[static_cast<std::size_t>(i)] = static_cast<std::int16_t>((root_q20 * root_q20 + (1 << 27)) >> 28);
  }
  return weight;
}();
std::int32_t robust_weight_q12(std::int32_t x_q8) {
  return kRobustWeight_q12[static_cast<std::size_t>((abs(x_q8) + 8) >> 4)];
}

void add_block(const RangeRows& rows, const Block& block, std::int32_t right, std::int32_t up, int times,
               RangeFit& fit) {
  std::array<std::int32_t, kUnknowns> change{};
  if (!rows.row_of(block, right, up, change)) return;
  const std::int32_t mean_q8 = rows.mean_in_sigmas_q8(block);
  const std::int32_t weight = times * robust_weight_q12(mean_q8) * block.rays;
  fit.equations.add(change, weight, (weight * mean_q8) >> 8);
  // Of the mean of n rays, in its own standard deviations.
  fit.squares_q8 += min_small(mean_q8 * mean_q8 * block.rays, 9 << 16) >> 8;
  ++fit.blocks;
}

// The row's mask with column k + by in place of column k, in words of a mask.
std::uint32_t shifted(const RayMask::Row& row, int word, int by) {
  const auto word_at = [&row](int at) {
    return at < 0 || at >= RayMask::kWordsPerRow ? 0 : row[static_cast<std::size_t>(at)];
  };
  return by > 0 ? (word_at(word) << by) | (word_at(word + 1) >> (RayMask::kColumnsPerWord - by))
                : (word_at(word) >> -by) | (word_at(word - 1) << (RayMask::kColumnsPerWord + by));
}

}  // namespace

void fit_ranges(const FrameView& view, const Pose& pose, const RenderedSurface& surface, RangeFit& fit,
                WorkBudget& budget, int every) {
  fit = {};
  if (!budget.spend(work::kRanges)) return;
  const RangeRows rows(view, pose);
  for (int row = 0; row + 1 < view.rays; row += 2) {
    int looked_at = 0;  // blocks
    const std::int32_t compared_before = fit.blocks;
    const std::int32_t up = -rows.slope_q14(row + 1);
    const RayMask::Row& upper = surface.filled.rows[static_cast<std::size_t>(row)];
    const RayMask::Row& lower = surface.filled.rows[static_cast<std::size_t>(row) + 1];
    for (int word = 0; word < RayMask::kWordsPerRow; ++word) {
      const std::uint32_t both =
          upper[static_cast<std::size_t>(word)] & lower[static_cast<std::size_t>(word)];
      // Bit by bit from the left: pairs of columns that are filled. If every second one, in the pattern of a
      // chessboard.
      const std::uint32_t wanted = every == 1 ? 0xAAAA'AAAAU : (row & 2) == 0 ? 0x8888'8888U : 0x2222'2222U;
      std::uint32_t pairs = both & (both << 1) & wanted;
      for (int column = word * RayMask::kColumnsPerWord; pairs != 0; column += 2, pairs <<= 2) {
        if ((pairs >> 31) == 0) continue;
        ++looked_at;
        Block block{};
        if (!take_block(view, surface, row, column, block)) continue;
        add_block(rows, block, rows.slope_q14(column + 1), up, every, fit);
      }
    }
    if (!budget.spend(looked_at * work::kBlock + (fit.blocks - compared_before) * work::kCompared)) return;
  }
}

std::uint32_t fill_share(const FrameView& view, const RenderedSurface& surface) {
  std::int32_t inside = 0, returned = 0;
  for (int row = kMargin; row + kMargin < view.rays; ++row) {
    const auto filled_at = [&surface](int at) -> const RayMask::Row& {
      return surface.filled.rows[static_cast<std::size_t>(at)];
    };
    for (int word = 0; word < RayMask::kWordsPerRow; ++word) {
      const auto at = static_cast<std::size_t>(word);
      std::uint32_t well_inside = filled_at(row - kMargin)[at] & filled_at(row + kMargin)[at] &
                                  shifted(filled_at(row), word, kMargin) &
                                  shifted(filled_at(row), word, -kMargin);
      well_inside &= ~view.hidden.rows[static_cast<std::size_t>(row)][at];
      inside += count_ones(well_inside);
      returned += count_ones(well_inside & view.returned.rows[static_cast<std::size_t>(row)][at]);
    }
  }
  if (inside < 20) return 65536;
  return static_cast<std::uint32_t>(divide(std::int64_t{returned} << 16, inside));
}

}  // namespace tumblesight::gnc
