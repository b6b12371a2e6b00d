#include "gnc/lidar/depth_image.hpp"

#include <algorithm>

namespace tumblesight::gnc {
namespace {

constexpr int kMinRays = 16;
constexpr int kCountsPerMetre = 128;
constexpr std::uint16_t kMinRangeCounts = kMinRange_m * kCountsPerMetre;
constexpr std::uint16_t kMaxRangeCounts = kMaxRange_m * kCountsPerMetre;
constexpr int kDepthPerMetre = 512;  // depths are counted finer than ranges, so that rounding them costs nothing
constexpr std::uint16_t kMostReturns = 255;  // of a cell that count; no sensor in its limits comes near

constexpr std::int64_t kOne30 = std::int64_t{1} << 30;

constexpr std::int64_t rounded_shift(std::int64_t value, int shift) {
  return (value + (std::int64_t{1} << (shift - 1))) >> shift;
}
std::int64_t product30(std::int64_t a, std::int64_t b) {
  return rounded_shift(a * b, 30);
}
// To the nearest, halves up; divisor > 0.
std::int64_t rounded_division(std::int64_t dividend, std::int64_t divisor) {
  const std::int64_t twice = 2 * dividend + divisor;
  const std::int64_t truncated = twice / (2 * divisor);
  return truncated - (truncated * 2 * divisor > twice ? 1 : 0);
}

bool usable(std::uint16_t range) {
  return range >= kMinRangeCounts && range <= kMaxRangeCounts;
}

// tan(fov / 2), 30 bits behind the point: its series to the 11th power, within 1e-8.
std::int64_t tan_half_fov30(std::uint32_t fov_urad) {
  const std::int64_t x = rounded_division(std::int64_t{fov_urad} * kOne30, 2'000'000);
  const std::int64_t s = product30(x, x);
  constexpr std::int64_t kSeries[] = {357913941, 143165577, 57948660, 23481185, 9516822};  // 1/3, 2/15, 17/315, ...
  std::int64_t sum = 0;
  for (int k = 4; k >= 0; --k) sum = kSeries[k] + product30(s, sum);
  return x + product30(x, product30(s, sum));
}

// Slopes of the rays of one column (or, negated, of one row) against the boresight, 30 bits behind the point, and
// their squares, 16 bits.
struct Slopes {
  std::array<std::int32_t, RangeImage::kMaxRays> slope30;
  std::array<std::int32_t, RangeImage::kMaxRays> square16;
};
void make_slopes(const RangeImage& frame, Slopes& slopes) {
  const std::int64_t tan30 = tan_half_fov30(frame.fov_urad);
  for (int i = 0; i < frame.rays; ++i) {
    const std::int64_t slope = rounded_division(tan30 * (2 * i + 1 - frame.rays), frame.rays);
    slopes.slope30[i] = static_cast<std::int32_t>(slope);
    slopes.square16[i] = static_cast<std::int32_t>(rounded_shift(slope * slope, 44));
  }
}

// Depths of one row of rays along the boresight [1/512 m]; 0 where there is no usable return. Range over
// sqrt(1 + s), s = u^2 + v^2 < 0.2662, as a polynomial within 2e-5.
void row_depths(const std::uint16_t* ranges, const Slopes& slopes, int row, int rays,
                std::uint32_t* __restrict depths) {
  const std::int32_t v_square = slopes.square16[row];
  for (int column = 0; column < rays; ++column) {
    const std::int32_t s = slopes.square16[column] + v_square;  // 16 bits behind the point
    const std::int32_t p3 = -9761 + ((s * 5777) >> 16);         // 15 bits behind the point
    const std::int32_t p2 = 12263 + ((s * p3) >> 16);
    const std::int32_t p1 = -16384 + ((s * p2) >> 16);
    const std::int32_t inverse = 65535 + ((s * p1 + (1 << 14)) >> 15);
    const std::uint32_t range = usable(ranges[column]) ? ranges[column] : 0U;
    depths[column] = (range * static_cast<std::uint32_t>(inverse) + (1U << 13)) >> 14;
  }
}

struct Returns {
  int count = 0;
  std::uint16_t nearest = 0xFFFF;
  std::uint16_t farthest = 0;
};

Returns survey(const RangeImage& frame) {
  Returns returns;
  const int rays_total = frame.rays * frame.rays;
  for (int i = 0; i < rays_total; ++i) {
    const std::uint16_t range = frame.ranges[i];
    const bool good = usable(range);
    returns.count += good ? 1 : 0;
    returns.nearest = std::min(returns.nearest, good ? range : std::uint16_t{0xFFFF});
    returns.farthest = std::max(returns.farthest, good ? range : std::uint16_t{0});
  }
  return returns;
}

// Where the centroid of the usable returns lies: along (u, 1, v), and how far, 1/512 m with eight more bits.
struct Centroid {
  Vector3<Fixed> direction;  // unit
  std::int64_t distance17;
};
Centroid centroid_of(const RangeImage& frame, const Slopes& slopes, int returns) {
  std::array<std::uint32_t, RangeImage::kMaxRays> depths;
  std::array<std::uint32_t, RangeImage::kMaxRays> column_sums{};
  std::int64_t depth = 0;
  std::int64_t across30 = 0;
  std::int64_t up30 = 0;
  for (int row = 0; row < frame.rays; ++row) {
    row_depths(frame.ranges.data() + row * frame.rays, slopes, row, frame.rays, depths.data());
    std::uint32_t row_sum = 0;
    for (int column = 0; column < frame.rays; ++column) {
      row_sum += depths[column];
      column_sums[column] += depths[column];
    }
    depth += row_sum;
    up30 -= std::int64_t{row_sum} * slopes.slope30[row];
  }
  for (int column = 0; column < frame.rays; ++column) {
    across30 += std::int64_t{column_sums[column]} * slopes.slope30[column];
  }
  const auto slope = [depth](std::int64_t sum30) {
    return Fixed::from_raw(rounded_division(rounded_shift(sum30, 30 - Fixed::kFractionBits), depth));
  };
  const Vector3<Fixed> direction = normalised(Vector3<Fixed>(slope(across30), Fixed(1.0), slope(up30)));
  const std::int64_t along17 = rounded_division(depth * 256, returns);
  return {direction, rounded_division(along17 * (1 << Fixed::kFractionBits), direction.y().raw())};
}

// The shortest turn of +y into `direction` (unit, within 90 degrees of +y).
Matrix3<Fixed> turn_of_y_to(const Vector3<Fixed>& direction) {
  constexpr Fixed kOne(1.0);
  const Fixed x = direction.x();
  const Fixed y = direction.y();
  const Fixed z = direction.z();
  const Fixed s = kOne / (kOne + y);
  Matrix3<Fixed> turn;
  turn << kOne - s * x * x, x, -(s * x * z),  //
      -x, y, -z,                              //
      -(s * x * z), z, kOne - s * z * z;
  return turn;
}

// A coordinate in the view of a point at depth 1 on the ray of a column and a row: the sum of both parts, 30 bits
// behind the point.
struct Coordinate {
  std::array<std::int32_t, RangeImage::kMaxRays> of_column;
  std::array<std::int32_t, RangeImage::kMaxRays> of_row;
};
// `axis` in the LRF; 1 is `unit` (numerator over denominator) of what the coordinate is counted in.
void make_coordinate(const Vector3<Fixed>& axis, const Slopes& slopes, int rays, std::int64_t numerator,
                     std::int64_t denominator, Coordinate& coordinate) {
  const auto part = [&](Fixed along, std::int64_t slope30) {
    const std::int64_t product = rounded_shift(std::int64_t{along.raw()} * slope30, Fixed::kFractionBits);
    return static_cast<std::int32_t>(rounded_division(product * numerator, denominator));
  };
  for (int i = 0; i < rays; ++i) {
    coordinate.of_column[i] = part(axis.x(), slopes.slope30[i]);
    coordinate.of_row[i] = part(axis.y(), kOne30) + part(axis.z(), -slopes.slope30[i]);
  }
}

struct View {
  Coordinate x, depth, down;  // x and down in cells
};

// Sums depths and counts returns cell by cell, in the view.
void accumulate(const RangeImage& frame, const Slopes& slopes, const View& view, DepthImageScratch& scratch) {
  constexpr std::int32_t kSide = DepthImage::kSide;
  constexpr std::int64_t kMiddle30 = kSide / 2 * kOne30;
  std::array<std::uint32_t, RangeImage::kMaxRays> depths;
  std::array<std::int32_t, RangeImage::kMaxRays> cells;
  std::array<std::uint32_t, RangeImage::kMaxRays> depths_in_view;
  scratch.depth_sum.fill(0);
  scratch.returns.fill(0);
  const int rays = frame.rays;
  for (int row = 0; row < rays; ++row) {
    row_depths(frame.ranges.data() + row * rays, slopes, row, rays, depths.data());
    const std::int32_t row_x = view.x.of_row[row], row_down = view.down.of_row[row], row_depth = view.depth.of_row[row];
    for (int column = 0; column < rays; ++column) {
      const auto depth = static_cast<std::int32_t>(depths[column]);
      const std::int32_t x30 = view.x.of_column[column] + row_x;
      const std::int32_t down30 = view.down.of_column[column] + row_down;
      const std::int32_t depth30 = view.depth.of_column[column] + row_depth;
      const auto x = static_cast<std::int32_t>((std::int64_t{depth} * x30 + kMiddle30) >> 30);
      const auto down = static_cast<std::int32_t>((std::int64_t{depth} * down30 + kMiddle30) >> 30);
      const bool inside = depth > 0 && x >= 0 && x < kSide && down >= 0 && down < kSide;
      cells[column] = inside ? down * kSide + x : DepthImage::kCells + column % DepthImageScratch::kOutside;
      depths_in_view[column] = static_cast<std::uint32_t>((std::int64_t{depth} * depth30 + (kOne30 >> 1)) >> 30);
    }
    for (int column = 0; column < rays; ++column) {
      const int cell = cells[column];
      const bool full = scratch.returns[cell] >= kMostReturns;
      scratch.depth_sum[cell] += full ? 0U : depths_in_view[column];
      scratch.returns[cell] = static_cast<std::uint16_t>(scratch.returns[cell] + (full ? 0 : 1));
    }
  }
}

// 2^24 / count, to the nearest.
constexpr std::array<std::int32_t, kMostReturns + 1> make_reciprocals() {
  std::array<std::int32_t, kMostReturns + 1> table{};
  for (int count = 1; count <= kMostReturns; ++count) table[count] = ((2 << 24) / count + 1) / 2;
  return table;
}
constexpr std::array<std::int32_t, kMostReturns + 1> kReciprocals24 = make_reciprocals();

// 0.5 + 0.5 (centroid - mean depth) / radius in every cell.
void encode_centroid_relative(const DepthImageScratch& scratch, std::int64_t centroid17,
                              std::uint32_t target_radius_mm, DepthImage& image) {
  // From 1/512 m with eight more bits to half a radius, 16 and 16 more bits behind the point.
  const std::int64_t scale = rounded_division((std::int64_t{1000} << (15 + 16 - 8)) / kDepthPerMetre, target_radius_mm);
  const auto centroid = static_cast<std::int32_t>(rounded_shift(centroid17, 8));
  for (int i = 0; i < DepthImage::kCells; ++i) {
    const std::int32_t count = scratch.returns[i];
    const std::int32_t before = centroid * count - static_cast<std::int32_t>(scratch.depth_sum[i]);
    const std::int64_t mean17 = (std::int64_t{before} * kReciprocals24[count]) >> 16;
    const std::int64_t value = 32768 + rounded_shift(mean17 * scale, 16);
    const std::int64_t bounded = std::min<std::int64_t>(DepthImage::kLargest, std::max<std::int64_t>(DepthImage::kSmallest, value));
    image.depth[i] = static_cast<std::uint16_t>(count > 0 ? bounded : 0);
  }
}

std::int64_t mean17_of(const DepthImageScratch& scratch, int cell) {
  return (std::int64_t{scratch.depth_sum[cell]} * kReciprocals24[scratch.returns[cell]]) >> 16;
}

void encode_paper_maximum(const DepthImageScratch& scratch, DepthImage& image) {
  std::int64_t largest17 = 1;
  for (int i = 0; i < DepthImage::kCells; ++i) largest17 = std::max(largest17, mean17_of(scratch, i));
  const std::int64_t scale = (std::int64_t{DepthImage::kLargest} << 28) / largest17;
  for (int i = 0; i < DepthImage::kCells; ++i) {
    image.depth[i] = static_cast<std::uint16_t>((mean17_of(scratch, i) * scale + (1 << 27)) >> 28);
  }
}

FrameStatus validate(const RangeImage& frame, int& returns) {
  if (frame.rays < kMinRays || frame.rays > RangeImage::kMaxRays) return FrameStatus::kBadRayCount;
  if (frame.fov_urad < kMinFov_urad || frame.fov_urad > kMaxFov_urad) return FrameStatus::kBadFov;
  const Returns found = survey(frame);
  if (found.count < kMinReturns) return FrameStatus::kEmpty;
  if (found.nearest == found.farthest) return FrameStatus::kFlat;
  returns = found.count;
  return FrameStatus::kOk;
}

}  // namespace

bool is_possible(const DepthProjection& projection) {
  const auto is_length = [](std::uint32_t mm) { return mm >= kMinProjection_mm && mm <= kMaxProjection_mm; };
  return is_length(projection.swath_mm) && is_length(projection.target_radius_mm) &&
         projection.encoding <= DepthEncoding::kPaperMaximum;
}

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image) {
  int returns = 0;
  const FrameStatus status = validate(frame, returns);
  if (status != FrameStatus::kOk) return status;
  const bool centred = projection.encoding == DepthEncoding::kCentroidRelative;
  Slopes slopes;
  make_slopes(frame, slopes);
  const Centroid centroid = centroid_of(frame, slopes, returns);
  image.r_lrf_view = centred ? turn_of_y_to(centroid.direction) : Matrix3<Fixed>::Identity();

  // 1/512 m in cells: 100 cells over the swath.
  constexpr std::int64_t kCellsPerSwath = std::int64_t{DepthImage::kSide} * 1000;
  const std::int64_t swath = std::int64_t{projection.swath_mm} * kDepthPerMetre;
  View view;
  make_coordinate(image.r_lrf_view.col(0), slopes, frame.rays, kCellsPerSwath, swath, view.x);
  make_coordinate(-image.r_lrf_view.col(2), slopes, frame.rays, kCellsPerSwath, swath, view.down);
  make_coordinate(image.r_lrf_view.col(1), slopes, frame.rays, 1, 1, view.depth);
  accumulate(frame, slopes, view, scratch);
  if (centred) {
    encode_centroid_relative(scratch, centroid.distance17, projection.target_radius_mm, image);
  } else {
    encode_paper_maximum(scratch, image);
  }
  return FrameStatus::kOk;
}

}  // namespace tumblesight::gnc
