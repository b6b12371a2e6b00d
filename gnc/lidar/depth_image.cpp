#include "gnc/lidar/depth_image.hpp"

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kMinRays = 16;
constexpr int kMetre = 64;  // depths to a metre, times 2^range_shift

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
  const std::int64_t truncated = quotient_of(twice, 2 * divisor);
  return truncated + less_mask(twice, truncated * 2 * divisor);
}

// tan(fov / 2), 30 bits behind the point: its series to the 11th power, within 1e-8.
std::int64_t tan_half_fov30(std::uint32_t fov_urad) {
  const std::int64_t x = rounded_division(std::int64_t{fov_urad} * kOne30, 2'000'000);
  const std::int64_t s = product30(x, x);
  constexpr std::int64_t kSeries[] = {357913941, 143165577, 57948660, 23481185,
                                      9516822};  // 1/3, 2/15, 17/315, ...
  std::int64_t sum = 0;
  for (int k = 4; k >= 0; --k) sum = kSeries[k] + product30(s, sum);
  return x + product30(x, product30(s, sum));
}

void make_rays(const RangeImage& frame, std::uint16_t farthest, DepthImageScratch::Rays& rays) {
  rays.range_shift = 15 - highest_bit(farthest);
  const std::int64_t tan30 = tan_half_fov30(frame.fov_urad);
  for (int i = 0; i < frame.rays; ++i) {
    const std::int64_t slope = rounded_division(tan30 * (2 * i + 1 - frame.rays), frame.rays);
    rays.slope30[i] = static_cast<std::int32_t>(slope);
    rays.square16[i] = static_cast<std::int16_t>(rounded_shift(slope * slope, 44));
  }
}

// Where the centroid of the usable returns lies: along (u, 1, v), and how far, in the frame's unit.
struct Centroid {
  Vector3<Fixed> direction;  // unit
  std::int64_t distance;
};
Centroid centroid_of(const DepthImageScratch::Rays& rays, int count, int returns) {
  std::int64_t depth = 0;
  std::int64_t across30 = 0;
  std::int64_t up30 = 0;
  for (int i = 0; i < count; ++i) {
    depth += rays.row_sum[i];
    up30 -= std::int64_t{rays.row_sum[i]} * rays.slope30[i];
    across30 += std::int64_t{rays.column_sum[i]} * rays.slope30[i];
  }
  const auto slope = [divisor = max<std::int64_t>(depth, 1)](std::int64_t sum30) {
    return Fixed::from_raw(rounded_division(rounded_shift(sum30, 30 - Fixed::kFractionBits), divisor));
  };
  const Vector3<Fixed> direction = normalised(Vector3<Fixed>(slope(across30), Fixed(1.0), slope(up30)));
  const std::int64_t along8 = rounded_division(depth * 256, returns);
  return {direction, rounded_division(along8 * (1 << (Fixed::kFractionBits - 8)), direction.y().raw())};
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

// Of a point at depth 1 the coordinate along `axis`, 30 bits behind the point: the parts of a ray's column
// and row.
struct Parts {
  const Vector3<Fixed>& axis;
  const DepthImageScratch::Rays& rays;
  std::int64_t of_column(int i) const {
    return rounded_shift(std::int64_t{axis.x().raw()} * rays.slope30[i], 24);
  }
  std::int64_t of_row(int i) const {
    return std::int64_t{axis.y().raw()} * (1 << 6) -
           rounded_shift(std::int64_t{axis.z().raw()} * rays.slope30[i], 24);
  }
};
static_assert(Fixed::kFractionBits == 24);

// Parts are monotonous, so the first and the last are the largest.
std::int64_t largest_part30(const Parts& parts, int count) {
  return max(abs(parts.of_column(0)), abs(parts.of_column(count - 1))) +
         max(abs(parts.of_row(0)), abs(parts.of_row(count - 1)));
}

std::int16_t saturated16(std::int64_t value) {
  return static_cast<std::int16_t>(clamp<std::int64_t>(value, -32767, 32767));
}

void make_coordinate(const Parts& parts, int count, std::int64_t factor8, int shift,
                     DepthImageScratch::Coordinate& coordinate) {
  for (int i = 0; i < count; ++i) {
    coordinate.of_column[i] = saturated16(rounded_shift(parts.of_column(i) * factor8, shift));
    coordinate.of_row[i] = saturated16(rounded_shift(parts.of_row(i) * factor8, shift));
  }
}

// x and down: cells with as many bits behind the point as 16 bits leave, two to six.
void make_cells(const Parts& x, const Parts& down, int count, std::uint32_t swath_mm,
                DepthImageScratch::View& view) {
  const int range_shift = x.rays.range_shift;
  // Cells to the frame's unit times 2^16, 8 bits behind the point.
  const std::int64_t factor8 =
      rounded_division((std::int64_t{DepthImage::kSide} * 1000) << (16 + 8 - 6 - range_shift), swath_mm);
  const std::int64_t largest = max(largest_part30(x, count), largest_part30(down, count)) * factor8;
  int bits = 2;
  for (int more = 3; more <= 6; ++more) bits = select((largest >> (38 - more)) < 32767, more, bits);
  view.cells = static_cast<std::int16_t>(1 << (16 - bits));
  view.middle = static_cast<std::int16_t>((DepthImage::kSide / 2) << bits);
  make_coordinate(x, count, factor8, 38 - bits, view.x);
  make_coordinate(down, count, factor8, 38 - bits, view.down);
}

void make_depth(const Parts& depth, int count, DepthImageScratch::Coordinate& coordinate) {
  for (int i = 0; i < count; ++i) {
    coordinate.of_column[i] = saturated16(rounded_shift(depth.of_column(i), 15));
    coordinate.of_row[i] = saturated16(rounded_shift(depth.of_row(i) - kOne30, 15));
  }
}

void make_scale(std::int64_t centroid, std::uint32_t target_radius_mm, int range_shift,
                DepthImageScratch::View& view) {
  const std::int64_t radius =
      max<std::int64_t>(1, rounded_division((std::int64_t{target_radius_mm} * kMetre) << range_shift, 1000));
  const int shift = max(0, 14 - highest_bit(static_cast<std::uint64_t>(radius)));
  view.centroid = saturated16(centroid);
  view.radius = saturated16(radius);
  view.radius_scale = static_cast<std::int16_t>(1 << shift);
  view.value_of_radius = saturated16(rounded_division(std::int64_t{kMiddleValue} << 15, radius << shift));
}

FrameStatus status_of(const Survey& survey) {
  if (survey.returns < kMinReturns) return FrameStatus::kEmpty;
  return survey.nearest == survey.farthest ? FrameStatus::kFlat : FrameStatus::kOk;
}

FrameStatus status_of(const RangeImage& frame) {
  if (frame.rays < kMinRays || frame.rays > RangeImage::kMaxRays) return FrameStatus::kBadRayCount;
  const bool possible = frame.fov_urad >= kMinFov_urad && frame.fov_urad <= kMaxFov_urad;
  return possible ? FrameStatus::kOk : FrameStatus::kBadFov;
}

}  // namespace

bool is_possible(const DepthProjection& projection) {
  const auto is_length = [](std::uint32_t mm) { return mm >= kMinProjection_mm && mm <= kMaxProjection_mm; };
  return is_length(projection.swath_mm) && is_length(projection.target_radius_mm);
}

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image) {
  return make_depth_image(frame, projection, scratch, image, depth_loops_within(kInstructionSets.back()));
}

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image, const DepthLoops& loops) {
  FrameStatus status = status_of(frame);
  if (status != FrameStatus::kOk) return status;
  const Survey survey = loops.survey(frame);
  status = status_of(survey);
  if (status != FrameStatus::kOk) return status;

  make_rays(frame, survey.farthest, scratch.rays);
  loops.sum_depths(frame, scratch.rays);
  const Centroid centroid = centroid_of(scratch.rays, frame.rays, survey.returns);
  image.r_lrf_view = turn_of_y_to(centroid.direction);

  const Vector3<Fixed> right = image.r_lrf_view.col(0);
  const Vector3<Fixed> down = -image.r_lrf_view.col(2);
  const Vector3<Fixed> away = image.r_lrf_view.col(1);
  make_cells({right, scratch.rays}, {down, scratch.rays}, frame.rays, projection.swath_mm, scratch.view);
  make_depth({away, scratch.rays}, frame.rays, scratch.view.depth);
  make_scale(centroid.distance, projection.target_radius_mm, scratch.rays.range_shift, scratch.view);
  loops.accumulate(frame, scratch.rays, scratch.view, scratch.cells.data());
  loops.encode(scratch.cells.data(), image.depth.data());
  return FrameStatus::kOk;
}

}  // namespace tumblesight::gnc
