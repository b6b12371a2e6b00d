#include "gnc/registration/inlier_ratios.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"

namespace tumblesight::gnc {
namespace {

using Scratch = InlierRatiosScratch;
constexpr int kSide = Scratch::kSide;
constexpr int kBorder = Scratch::kBorder;
constexpr std::int16_t kEmpty = Scratch::kEmpty;
static_assert(2 * kSide == DepthImage::kSide);

// less_mask() and clamp() of numbers whose difference fits into 31 bits.
constexpr std::int32_t below_mask(std::int32_t a, std::int32_t b) {
  return sign_mask(a - b);
}
constexpr std::int32_t clamp_small(std::int32_t value, std::int32_t low, std::int32_t high) {
  return min_small(high, max_small(low, value));
}

// The attitude in the units of the drawing.
struct Drawing {
  std::array<std::int32_t, 3> right, down;  // row vectors: position to cells in Q8, after >> 16
  std::array<std::int32_t, 3> away;         // position to depth and normal to Q8, Q1.14
  std::int32_t distance_q4;                 // of the centroid, in radii
};

// Three products of a position with a row vector stay within 32 bits up to this element.
constexpr std::int32_t kMostCellsPerRadius = 21'800;
// Least cosine of the incidence at which a point is drawn, times 127 * 256.
constexpr std::int32_t kLeastFacing = 3251;  // 0.1

Drawing make_drawing(const DepthImage& image, const DepthProjection& projection,
                     const Matrix3<Fixed>& r_lrf_trf) {
  const Matrix3<Fixed> r_view_trf = transpose_product<Fixed>(image.r_lrf_view, r_lrf_trf);
  // Cells per radius in Q24, over 32767.
  const std::int64_t scale =
      divide((std::int64_t{projection.target_radius_mm} * kSide) << 24,
             std::int64_t{max<std::uint32_t>(projection.swath_mm, 1)} * SurfaceModel::kRadius);
  const auto cells = [scale](Fixed element) {
    const std::int64_t scaled = (std::int64_t{element.raw()} * scale) >> 24;
    return static_cast<std::int32_t>(clamp<std::int64_t>(scaled, -kMostCellsPerRadius, kMostCellsPerRadius));
  };
  Drawing drawing;
  for (int i = 0; i < 3; ++i) {
    drawing.right[i] = cells(r_view_trf(0, i));
    drawing.down[i] = cells(-r_view_trf(2, i));
    const std::int64_t away = r_view_trf(1, i).raw();
    drawing.away[i] = static_cast<std::int32_t>(clamp<std::int64_t>((away + 512) >> 10, -16384, 16384));
  }
  const std::int64_t distance = divide(std::int64_t{max(image.centroid_distance_mm, 0)} * 16,
                                       max<std::uint32_t>(projection.target_radius_mm, 1));
  drawing.distance_q4 = static_cast<std::int32_t>(clamp<std::int64_t>(distance, 1, 4095));
  return drawing;
}

template <class Number>
std::int32_t product(const std::array<Number, 3>& a, const std::array<std::int32_t, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Whether the first of two rows or columns and the one after it are in the drawing.
std::int32_t in_drawing_mask(std::int32_t first) {
  return below_mask(-1, first) & below_mask(first, kSide + 1);
}
std::int32_t in_image_mask(std::int32_t index) {
  return below_mask(-1, index) & below_mask(index, kSide);
}

// Draws the points that face the sensor, each into the 2 x 2 cells around it; the nearest one stays.
void draw(const Drawing& drawing, const SurfaceModel& surface, Scratch& scratch) {
  scratch.drawn.fill(kEmpty);
  for (int i = 0; i < SurfaceModel::kMaxPoints; ++i) {
    const SurfacePoint point = surface.point(i);
    const auto& [x, y, z] = point.position;
    // Cosine of the incidence times the distance, by the direction from the sensor to the point.
    const std::int32_t from_origin = (x * point.normal[0] + y * point.normal[1] + z * point.normal[2]) >> 7;
    const std::int32_t away = product(point.normal, drawing.away) >> 6;
    const std::int32_t faces = below_mask(16 * from_origin + drawing.distance_q4 * (away + kLeastFacing), 0);
    const std::int32_t depth = clamp_small(product(point.position, drawing.away) >> 14, -kEmpty, kEmpty - 1);
    // The first of the two rows and columns, counted from the border.
    const std::int32_t column =
        ((product(point.position, drawing.right) >> 16) + 256 * (kSide / 2) + 128) >> 8;
    const std::int32_t row = ((product(point.position, drawing.down) >> 16) + 256 * (kSide / 2) + 128) >> 8;
    const auto shown = static_cast<std::int16_t>(
        kEmpty ^ ((kEmpty ^ depth) & faces & in_drawing_mask(row) & in_drawing_mask(column)));
    const std::int32_t first =
        clamp_small(row, 0, kSide) * Scratch::kDrawnSide + clamp_small(column, 0, kSide);
    for (const std::int32_t cell :
         {first, first + 1, first + Scratch::kDrawnSide, first + Scratch::kDrawnSide + 1}) {
      std::int16_t& there = scratch.drawn[cell];
      there = min(there, shown);
    }
  }
}

// Mean depth of the cells with returns in each 2 x 2 cells of the image.
void reduce(const DepthImage& image, Scratch::Cells& seen) {
  constexpr std::array<std::int32_t, 5> kInverse{0, 65536, 32768, 21845, 16384};
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const std::uint16_t* at = &image.depth[2 * row * DepthImage::kSide + 2 * column];
      std::int32_t sum = 0;
      std::uint32_t count = 0;
      for (const std::uint16_t value : {at[0], at[1], at[DepthImage::kSide], at[DepthImage::kSide + 1]}) {
        const auto filled = sign_mask(-std::int32_t{value});
        sum += (32768 - value) & filled;
        count += static_cast<std::uint32_t>(filled & 1);
      }
      const auto mean = static_cast<std::int32_t>((std::int64_t{sum} * kInverse[count]) >> 16);
      seen[row * kSide + column] = static_cast<std::int16_t>(
          select(is_less<std::uint32_t>(0, count), clamp_small(mean, -kEmpty, kEmpty - 1), kEmpty));
    }
  }
}

// The middle of the drawn cells, as a number of cells from the middle of the image.
struct Offset {
  std::int32_t right, down;
};
Offset middle_of(const Scratch& scratch) {
  std::int32_t count = 0, right = 0, down = 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const std::int16_t depth = scratch.drawn[(row + 1) * Scratch::kDrawnSide + column + 1];
      const std::int32_t filled = sign_mask(depth - kEmpty);
      count -= filled;
      right += (2 * column + 1 - kSide) & filled;
      down += (2 * row + 1 - kSide) & filled;
    }
  }
  const std::int64_t divisor = 2 * max(count, 1);
  // To the nearest, halves up.
  const auto cells = [divisor](std::int32_t sum) {
    const std::int64_t positive = std::int64_t{sum} + divisor / 2 + kSide * divisor;
    return static_cast<std::int32_t>(divide(positive, divisor)) - kSide;
  };
  return {cells(right), cells(down)};
}

// The drawing with its middle in the middle of the image.
void take_centred(const Offset& middle, Scratch& scratch) {
  for (int row = 0; row < kSide; ++row) {
    const std::int32_t from_row = clamp_small(row + middle.down, -1, kSide) + 1;
    for (int column = 0; column < kSide; ++column) {
      const std::int32_t from_column = clamp_small(column + middle.right, -1, kSide) + 1;
      const std::int16_t depth = scratch.drawn[from_row * Scratch::kDrawnSide + from_column];
      const std::int32_t inside = in_image_mask(row + middle.down) & in_image_mask(column + middle.right);
      scratch.expected[row * kSide + column] =
          static_cast<std::int16_t>(kEmpty ^ ((kEmpty ^ depth) & inside));
    }
  }
}

void make_rows(const Scratch::Cells& cells, Scratch::Rows& rows, Scratch::Rows& near_rows) {
  rows.fill(0);
  for (int row = 0; row < kSide; ++row) {
    // In two halves, which fit into a register of 32 bits each.
    std::array<std::uint32_t, 2> half{};
    for (int column = 0; column < kSide; ++column) {
      const std::uint32_t bit =
          static_cast<std::uint32_t>(sign_mask(cells[row * kSide + column] - kEmpty) & 1);
      half[column / (kSide / 2)] |= bit << (column % (kSide / 2));
    }
    rows[row + kBorder] = (std::uint64_t{half[0]} << Scratch::kFirstBit) |
                          (std::uint64_t{half[1]} << (Scratch::kFirstBit + kSide / 2));
  }
  for (int row = 0; row < Scratch::kRows; ++row) {
    const auto at = row;
    const std::uint64_t above = row > 0 ? rows[at - 1] : 0,
                        below = row + 1 < Scratch::kRows ? rows[at + 1] : 0;
    near_rows[at] = rows[at] | (rows[at] << 1) | (rows[at] >> 1) | above | below;
  }
}

// Counts the bits of many words: one number per byte, at most 31 words.
class BitCounter {
 public:
  void add(std::uint64_t word) {
    word -= (word >> 1) & 0x5555555555555555;
    word = (word & 0x3333333333333333) + ((word >> 2) & 0x3333333333333333);
    bytes_ += (word + (word >> 4)) & 0x0F0F0F0F0F0F0F0F;
  }
  std::int32_t value() const {
    const std::uint64_t pairs = (bytes_ & 0x00FF00FF00FF00FF) + ((bytes_ >> 8) & 0x00FF00FF00FF00FF);
    const auto low = static_cast<std::uint32_t>(pairs), high = static_cast<std::uint32_t>(pairs >> 32);
    const std::uint32_t sums = low + high;
    return static_cast<std::int32_t>((sums & 0xFFFF) + (sums >> 16));
  }

 private:
  std::uint64_t bytes_ = 0;
};

constexpr std::uint64_t kImageBits = ((std::uint64_t{1} << kSide) - 1) << Scratch::kFirstBit;

// Number of bits that are set in `a` and not in `b`, with `b` moved down by `down` rows, within the image.
std::int32_t count_without(const Scratch::Rows& a, int a_down, const Scratch::Rows& b, int b_down) {
  std::int32_t sum = 0;
  for (int first = 0; first < kSide; first += kSide / 2) {
    BitCounter counter;
    for (int row = first; row < first + kSide / 2; ++row) {
      counter.add(a[row + kBorder - a_down] & ~b[row + kBorder - b_down] & kImageBits);
    }
    sum += counter.value();
  }
  return sum;
}

// Where the drawing fits best, and the cells that do not fit there.
struct Fit {
  std::int32_t cost = 0x7FFFFFFF;
  std::int32_t right = 0, down = 0;  // by which the drawing is moved
  std::int32_t outliers = 0, missing = 0;
};

// Moves of the drawing: `count` to each side of (right, down), `step` cells apart.
struct Moves {
  std::int32_t right, down, count, step;
};

// Moves all rows by -columns, by a shift of each bit of the number on its own: a processor with registers of
// 32 bits has a branch in a 64-bit shift by a variable.
template <int kBits>
void move_left(std::int32_t columns, Scratch::Rows& rows) {
  for (std::uint64_t& row : rows) {
    for (int bit = 0; bit < kBits; ++bit) {
      const auto moves = static_cast<std::uint32_t>(-((columns >> bit) & 1));
      const std::uint64_t mask = (std::uint64_t{moves} << 32) | moves;
      row ^= (row ^ (row >> (1 << bit))) & mask;
    }
  }
}

// `seen`, `expected`: numbers of cells. The rows of the drawing are moved to the first of the moves already,
// and are moved beyond the last one.
void try_moves(const Moves& moves, std::int32_t seen, std::int32_t expected, Scratch& scratch, Fit& best) {
  for (int i = -moves.count; i <= moves.count; ++i) {
    const std::int32_t right = moves.right + i * moves.step;
    for (int k = -moves.count; k <= moves.count; ++k) {
      const std::int32_t down = moves.down + k * moves.step;
      const std::int32_t outliers = count_without(scratch.seen_rows, 0, scratch.near_expected_rows, down);
      const std::int32_t missing = count_without(scratch.expected_rows, down, scratch.near_seen_rows, 0);
      const std::int32_t cost = 16 * outliers * expected + 5 * missing * seen + abs(right) + abs(down);
      const std::int32_t better = below_mask(cost, best.cost);
      const auto take = [better](std::int32_t now, std::int32_t& kept) { kept ^= (kept ^ now) & better; };
      take(cost, best.cost);
      take(right, best.right);
      take(down, best.down);
      take(outliers, best.outliers);
      take(missing, best.missing);
    }
    for (int row = 0; row < Scratch::kRows; ++row) {
      scratch.expected_rows[row] <<= moves.step;
      scratch.near_expected_rows[row] <<= moves.step;
    }
  }
}

// The best of every second move, then the best of it and those around it.
Fit find_fit(std::int32_t seen, std::int32_t expected, Scratch& scratch) {
  constexpr Moves kCoarse{0, 0, kBorder / 2, 2};
  constexpr int kBeyond = kBorder + 2;  // where the rows are after the coarse moves
  static_assert(Scratch::kFirstBit + kSide + kBeyond < 64);
  Fit best;
  for (Scratch::Rows* rows : {&scratch.expected_rows, &scratch.near_expected_rows}) {
    for (std::uint64_t& row : *rows) row >>= kBorder;
  }
  try_moves(kCoarse, seen, expected, scratch, best);
  const Moves fine{clamp_small(best.right, 1 - kBorder, kBorder - 1),
                   clamp_small(best.down, 1 - kBorder, kBorder - 1), 1, 1};
  move_left<4>(kBeyond - (fine.right - 1), scratch.expected_rows);
  move_left<4>(kBeyond - (fine.right - 1), scratch.near_expected_rows);
  try_moves(fine, seen, expected, scratch, best);
  return best;
}

// Calls visit(difference of the depths, all bits set if both cells have one) for each cell.
template <class Visitor>
void for_each_cell(const Fit& fit, const Scratch& scratch, Visitor&& visit) {
  for (int row = 0; row < kSide; ++row) {
    const std::int32_t from_row = row - fit.down;
    for (int column = 0; column < kSide; ++column) {
      const std::int32_t from_column = column - fit.right;
      const std::int32_t inside = in_image_mask(from_row) & in_image_mask(from_column);
      const std::int32_t from =
          clamp_small(from_row, 0, kSide - 1) * kSide + clamp_small(from_column, 0, kSide - 1);
      const std::int32_t seen = scratch.seen[row * kSide + column];
      const std::int32_t expected = scratch.expected[from];
      visit(seen - expected, inside & below_mask(seen, kEmpty) & below_mask(expected, kEmpty));
    }
  }
}

// Median of the differences, in steps of a 64th of the radius: the distance from the TRF's origin to the
// centroid of the returns, along the view axis.
std::int32_t median_difference(const Fit& fit, std::int32_t& count, Scratch& scratch) {
  constexpr int kBinBits = 9;
  scratch.histogram.fill(0);
  count = 0;
  for_each_cell(fit, scratch, [&](std::int32_t difference, std::int32_t both) {
    const std::int32_t bin = clamp_small((difference + 65536) >> kBinBits, 0, 255);
    scratch.histogram[bin] = static_cast<std::uint16_t>(scratch.histogram[bin] - both);
    count -= both;
  });
  std::int32_t below = 0, median = 0;
  for (int bin = 0; bin < 256; ++bin) {
    below += scratch.histogram[bin];
    median += sign_mask(2 * below - count) & 1;
  }
  return (median << kBinBits) + (1 << (kBinBits - 1)) - 65536;
}

// 2.5 standard deviations of the difference of two depths: the noise of a range, over the mean of the 6.5
// rays of a cell, and 3 % of the radius for the sampled surface.
std::int32_t depth_limit(const DepthImage& image, const DepthProjection& projection,
                         const RangeNoise& noise) {
  const std::int64_t distance_mm = max(image.centroid_distance_mm, 0);
  // Limited so that its square fits below; ranges are below 512 m.
  const std::int64_t sigma_mm =
      min<std::int64_t>(noise.constant_mm + divide(distance_mm * noise.share_1e5, 100'000), 1'000'000);
  const std::int64_t radius_mm = max<std::uint32_t>(projection.target_radius_mm, 1);
  const std::int64_t of_mean_q8 = sigma_mm * 100, of_surface_q8 = radius_mm * 8;  // mm / 256
  const std::uint32_t sigma_q8 =
      integer_sqrt(static_cast<std::uint64_t>(of_mean_q8 * of_mean_q8 + of_surface_q8 * of_surface_q8));
  const std::int64_t limit = divide(std::int64_t{sigma_q8} * 5 * SurfaceModel::kRadius, radius_mm * 512);
  return static_cast<std::int32_t>(clamp<std::int64_t>(limit, 1, 65535));
}

std::uint32_t ratio_of(std::int64_t part, std::int32_t whole) {
  return static_cast<std::uint32_t>(divide(part * kWholeShare, max(whole, 1)));
}

}  // namespace

InlierRatios inlier_ratios(const DepthImage& image, const DepthProjection& projection,
                           const RangeNoise& noise, const Matrix3<Fixed>& r_lrf_trf,
                           const SurfaceModel& surface, InlierRatiosScratch& scratch) {
  InlierRatios ratios;
  ratios.is_known = surface.is_known();
  if (!ratios.is_known) return ratios;
  draw(make_drawing(image, projection, r_lrf_trf), surface, scratch);
  reduce(image, scratch.seen);
  take_centred(middle_of(scratch), scratch);
  make_rows(scratch.seen, scratch.seen_rows, scratch.near_seen_rows);
  make_rows(scratch.expected, scratch.expected_rows, scratch.near_expected_rows);
  static constexpr Scratch::Rows kNone{};
  const std::int32_t seen = count_without(scratch.seen_rows, 0, kNone, 0);
  const std::int32_t expected = count_without(scratch.expected_rows, 0, kNone, 0);
  const Fit fit = find_fit(seen, expected, scratch);

  std::int32_t both = 0;
  const std::int32_t median = median_difference(fit, both, scratch);
  const std::int32_t limit = depth_limit(image, projection, noise);
  std::int64_t apart = 0;
  for_each_cell(fit, scratch, [&](std::int32_t difference, std::int32_t counts) {
    apart += min_small(abs(difference - median), limit) & counts;
  });
  ratios.outliers = ratio_of(fit.outliers, seen);
  ratios.missing = ratio_of(fit.missing, expected);
  // Without a cell in common nothing fits.
  const std::uint32_t depth_misfit = ratio_of(divide(apart * 256, limit), both * 256);
  ratios.depth_misfit =
      kWholeShare ^ ((kWholeShare ^ depth_misfit) & static_cast<std::uint32_t>(below_mask(0, both)));
  return ratios;
}

}  // namespace tumblesight::gnc
