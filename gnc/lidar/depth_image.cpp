#include "gnc/lidar/depth_image.hpp"

#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kMinRays = 16;
constexpr int kMetre = 64;  // units of depth per metre, before the scale of 2^range_shift

constexpr std::int64_t kOneQ30 = std::int64_t{1} << 30;

// value / 2^shift, to the nearest, halves up.
constexpr std::int64_t rounding_shift_right(std::int64_t value, int shift) {
  return (value + (std::int64_t{1} << (shift - 1))) >> shift;
}
std::int64_t multiply_q30(std::int64_t a, std::int64_t b) {
  return rounding_shift_right(a * b, 30);
}
// dividend / divisor, to the nearest, halves up. Requires divisor > 0.
std::int64_t rounding_divide(std::int64_t dividend, std::int64_t divisor) {
  const std::int64_t twice = 2 * dividend + divisor;
  const std::int64_t truncated = divide(twice, 2 * divisor);
  return truncated + less_mask(twice, truncated * 2 * divisor);
}

// tan(fov / 2) in Q30: Taylor series up to the 11th power, error at most 1e-8.
std::int64_t tan_half_fov_q30(std::uint32_t fov_urad) {
  const std::int64_t x = rounding_divide(std::int64_t{fov_urad} * kOneQ30, 2'000'000);
  const std::int64_t s = multiply_q30(x, x);
  constexpr std::int64_t kSeries[] = {357913941, 143165577, 57948660, 23481185,
                                      9516822};  // 1/3, 2/15, 17/315, ...
  std::int64_t sum = 0;
  for (int k = 4; k >= 0; --k) sum = kSeries[k] + multiply_q30(s, sum);
  return x + multiply_q30(x, multiply_q30(s, sum));
}

// The rays of the frame. Ray i of n has the slope tan (2i + 1 - n) / n, to the nearest, halves up: from one
// to the next by the whole part of 2 tan / n, and by one more where the remainders have added up to a whole.
void make_rays(const RangeImage& frame, std::int64_t tan_q30, DepthImageScratch::Rays& rays) {
  rays.count = frame.rays;
  const std::int64_t divisor = 2 * frame.rays;
  const std::int64_t first = tan_q30 * (1 - frame.rays);
  const std::int64_t step = divide(4 * tan_q30, divisor);
  const auto step_rest = static_cast<std::int32_t>(4 * tan_q30 - step * divisor);
  std::int64_t slope = rounding_divide(first, frame.rays);
  auto rest = static_cast<std::int32_t>(2 * first + frame.rays - slope * divisor);
  for (int i = 0; i < frame.rays; ++i) {
    rays.right_q30[i] = rays.down_q30[i] = static_cast<std::int32_t>(slope);
    rays.right_square_q16[i] = rays.down_square_q16[i] =
        static_cast<std::int16_t>(rounding_shift_right(slope * slope, 44));
    rest += step_rest - 2 * frame.rays;
    const std::int32_t is_short = sign_mask(rest);
    slope += step + 1 + is_short;
    rest += 2 * frame.rays & is_short;
  }
}

// The rays of a resampled window.
void make_rays(const WindowAxis& axis, int frame_rays, std::int64_t tan_q30,
               std::array<std::int32_t, RangeImage::kMaxRays>& slope_q30,
               std::array<std::int16_t, RangeImage::kMaxRays>& square_q16) {
  const std::int64_t half_ray_q38 = divide(tan_q30 * 256, frame_rays);
  for (int i = 0; i < kWindowRays; ++i) {
    const std::int64_t half_rays_q16 =
        2 * (axis.first_q16 + std::int64_t{i} * axis.step_q16) + std::int64_t{1 - frame_rays} * (1 << 16);
    const std::int64_t slope =
        clamp(rounding_shift_right(half_rays_q16 * half_ray_q38, 24), -tan_q30, tan_q30);
    slope_q30[i] = static_cast<std::int32_t>(slope);
    square_q16[i] = static_cast<std::int16_t>(rounding_shift_right(slope * slope, 44));
  }
}

// Centroid of the target's returns: its direction in the LRF and its distance in the frame's unit of depth.
struct Centroid {
  Vector3<Fixed> direction;  // unit vector
  std::int64_t distance;
  std::int64_t right_q30, down_q30;  // slopes of the direction
};
Centroid find_centroid(const DepthImageScratch::Rays& rays, int returns) {
  std::int64_t depth = 0;
  std::int64_t across_q30 = 0;
  std::int64_t up_q30 = 0;
  for (int i = 0; i < rays.count; ++i) {
    depth += rays.row_sum[i];
    up_q30 -= std::int64_t{rays.row_sum[i]} * rays.down_q30[i];
    across_q30 += std::int64_t{rays.column_sum[i]} * rays.right_q30[i];
  }
  const auto slope = [divisor = max<std::int64_t>(depth, 1)](std::int64_t sum_q30) {
    return Fixed::from_raw(
        rounding_divide(rounding_shift_right(sum_q30, 30 - Fixed::kFractionBits), divisor));
  };
  const Fixed across = slope(across_q30), up = slope(up_q30);
  const Vector3<Fixed> direction = normalized(Vector3<Fixed>(across, Fixed(1.0), up));
  const std::int64_t along_q8 = rounding_divide(depth * 256, returns);
  constexpr int kToQ30 = 1 << (30 - Fixed::kFractionBits);
  return {direction, rounding_divide(along_q8 * (1 << (Fixed::kFractionBits - 8)), direction.y().raw()),
          std::int64_t{across.raw()} * kToQ30, -std::int64_t{up.raw()} * kToQ30};
}

// The window around the centroid is 1/16 wider than the image. At an angle to the boresight, a length covers
// a larger difference of slopes: up to 1 / cos^2.
WindowPlace place_of(const Centroid& centroid, std::int64_t distance_mm, const DepthProjection& projection,
                     std::int64_t tan_q30) {
  const std::int64_t cosine_q24 = centroid.direction.y().raw();
  const std::int64_t across_mm = max<std::int64_t>(
      rounding_shift_right(distance_mm * rounding_shift_right(cosine_q24 * cosine_q24, 24), 24), 1);
  const std::int64_t size_mm = projection.swath_mm + projection.swath_mm / 16;
  return {tan_q30, centroid.right_q30, centroid.down_q30, rounding_divide(size_mm * kOneQ30, across_mm),
          projection.target_radius_mm};
}

// The shortest rotation that takes +y to `direction`, a unit vector within 90 degrees of +y.
Matrix3<Fixed> rotation_of_y_to(const Vector3<Fixed>& direction) {
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

// Coordinate along `axis` of the point at depth 1 on a ray, in Q30: the sum of a term of the ray's column and
// a term of its row.
struct RayTerms {
  const Vector3<Fixed>& axis;
  const DepthImageScratch::Rays& rays;
  std::int64_t column_term(int i) const {
    return rounding_shift_right(std::int64_t{axis.x().raw()} * rays.right_q30[i], 24);
  }
  std::int64_t row_term(int i) const {
    return std::int64_t{axis.y().raw()} * (1 << 6) -
           rounding_shift_right(std::int64_t{axis.z().raw()} * rays.down_q30[i], 24);
  }
};
static_assert(Fixed::kFractionBits == 24);

// Largest absolute coordinate. The terms are monotonic, so the first or the last is the largest.
std::int64_t max_coordinate_q30(const RayTerms& terms) {
  const int last = terms.rays.count - 1;
  return max(abs(terms.column_term(0)), abs(terms.column_term(last))) +
         max(abs(terms.row_term(0)), abs(terms.row_term(last)));
}

std::int16_t saturate16(std::int64_t value) {
  return static_cast<std::int16_t>(clamp<std::int64_t>(value, -32767, 32767));
}

void make_coordinate(const RayTerms& terms, std::int64_t factor_q8, int shift,
                     DepthImageScratch::Coordinate<std::int32_t>& coordinate) {
  for (int i = 0; i < terms.rays.count; ++i) {
    coordinate.column[i] =
        static_cast<std::int32_t>(rounding_shift_right(terms.column_term(i) * factor_q8, shift));
    coordinate.row[i] = static_cast<std::int32_t>(rounding_shift_right(terms.row_term(i) * factor_q8, shift));
  }
}

// x and down in cells, with as many fraction bits as fit into 16 bits: two to six.
void make_cells(const RayTerms& x, const RayTerms& down, std::uint32_t swath_mm,
                DepthImageScratch::View& view) {
  const int range_shift = x.rays.range_shift;
  // Cells per unit of depth, times 2^16, in Q8.
  const std::int64_t factor_q8 =
      rounding_divide((std::int64_t{DepthImage::kSide} * 1000) << (16 + 8 - 6 - range_shift), swath_mm);
  const std::int64_t largest = max(max_coordinate_q30(x), max_coordinate_q30(down)) * factor_q8;
  int bits = 2;
  for (int more = 3; more <= 6; ++more) bits = select((largest >> (38 - more)) < 32767, more, bits);
  view.cells = static_cast<std::int16_t>(1 << (16 - bits));
  view.middle = static_cast<std::int16_t>((DepthImage::kSide / 2) << bits);
  make_coordinate(x, factor_q8, 38 - bits, view.x);
  make_coordinate(down, factor_q8, 38 - bits, view.down);
}

void make_depth(const RayTerms& depth, DepthImageScratch::Coordinate<std::int16_t>& coordinate) {
  for (int i = 0; i < depth.rays.count; ++i) {
    coordinate.column[i] = saturate16(rounding_shift_right(depth.column_term(i), 15));
    coordinate.row[i] = saturate16(rounding_shift_right(depth.row_term(i) - kOneQ30, 15));
  }
}

void make_scale(std::int64_t centroid, std::uint32_t target_radius_mm, int range_shift,
                DepthImageScratch::View& view) {
  const std::int64_t radius =
      max<std::int64_t>(1, rounding_divide((std::int64_t{target_radius_mm} * kMetre) << range_shift, 1000));
  const int shift = max(0, 14 - highest_bit(static_cast<std::uint64_t>(radius)));
  view.centroid = saturate16(centroid);
  view.radius = saturate16(radius);
  view.radius_scale = static_cast<std::int16_t>(1 << shift);
  view.inverse_radius = saturate16(rounding_divide(std::int64_t{kCentroidValue} << 15, radius << shift));
}

FrameStatus status_of(const ReturnSummary& summary) {
  if (summary.returns < kMinReturns) return FrameStatus::kEmpty;
  return summary.any_bits == summary.common_bits ? FrameStatus::kFlat : FrameStatus::kOk;
}

// The first place from `next` on with another pair than no returns and `known` in it or the three after it,
// or one of the last places.
int skip_known(const RangeImage& frame, int next, int rays, std::uint32_t known) {
  const auto is_known = [known](std::uint32_t pair) { return pair == 0 || pair == known; };
  next = skip_empty(frame, next, rays);
  while (next + 4 <= rays && is_known(pair_at(frame, next)) && is_known(pair_at(frame, next + 2))) next += 4;
  return next;
}

FrameStatus status_of(const RangeImage& frame) {
  if (frame.rays < kMinRays || frame.rays > RangeImage::kMaxRays) return FrameStatus::kBadRayCount;
  const bool possible = frame.fov_urad >= kMinFov_urad && frame.fov_urad <= kMaxFov_urad;
  return possible ? FrameStatus::kOk : FrameStatus::kBadFov;
}

}  // namespace

bool is_possible(const DepthProjection& projection) {
  return projection.swath_mm >= kMinProjection_mm && projection.swath_mm <= kMaxSwath_mm &&
         projection.target_radius_mm >= kMinProjection_mm &&
         projection.target_radius_mm <= kMaxTargetRadius_mm;
}

FrameStatus check_frame(const RangeImage& frame) {
  const FrameStatus status = status_of(frame);
  if (status != FrameStatus::kOk) return status;
  const int rays = frame.rays * frame.rays;
  int returns = 0, next = 0, last = kFirstOfPair;
  std::uint16_t first = 0;  // range of the first return
  bool differ = false;
  while (next < rays && (returns < kMinReturns || !differ)) {
    for (; next < last; ++next) {
      const std::uint16_t range = frame.ranges[static_cast<std::size_t>(next)];
      if (range < kMinRange_counts || range > kMaxRange_counts) continue;
      if (returns == 0) first = range;
      if (range != first) differ = true;
      ++returns;
    }
    next = skip_known(frame, next, rays, returns < kMinReturns ? 0U : first * 0x10001U);
    last = min(next + 2 * kRaysOfGroup, rays);
  }
  if (returns < kMinReturns) return FrameStatus::kEmpty;
  return differ ? FrameStatus::kOk : FrameStatus::kFlat;
}

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image) {
  return make_depth_image(frame, projection, scratch, image, fastest_depth_loops(kInstructionSets.back()));
}

FrameStatus make_depth_image(const RangeImage& frame, const DepthProjection& projection,
                             DepthImageScratch& scratch, DepthImage& image, const DepthLoops& loops) {
  FrameStatus status = status_of(frame);
  if (status != FrameStatus::kOk) return status;
  DepthImageScratch::Rays& rays = scratch.rays;
  select_target(frame, projection.target_radius_mm, scratch.selection, scratch.mask);
  const ReturnSummary summary = loops.summarize_returns(frame, scratch.mask);
  status = status_of(summary);
  if (status != FrameStatus::kOk) return status;

  const std::int64_t tan_q30 = tan_half_fov_q30(frame.fov_urad);
  make_rays(frame, tan_q30, rays);
  rays.range_shift = 15 - highest_bit(summary.any_bits);
  loops.sum_depths(frame, scratch.mask, rays);
  const Centroid centroid = find_centroid(rays, summary.returns);
  image.r_lrf_view = rotation_of_y_to(centroid.direction);
  image.centroid_distance_mm = static_cast<std::int32_t>(
      rounding_divide(centroid.distance * 1000, std::int64_t{kMetre} << rays.range_shift));

  make_window(frame, place_of(centroid, image.centroid_distance_mm, projection, tan_q30), scratch.window);
  if (scratch.window.is_resampled) {
    rays.count = kWindowRays;
    make_rays(scratch.window.columns, frame.rays, tan_q30, rays.right_q30, rays.right_square_q16);
    make_rays(scratch.window.rows, frame.rays, tan_q30, rays.down_q30, rays.down_square_q16);
  }
  const Vector3<Fixed> right = image.r_lrf_view.col(0);
  const Vector3<Fixed> down = -image.r_lrf_view.col(2);
  const Vector3<Fixed> away = image.r_lrf_view.col(1);
  make_cells({right, rays}, {down, rays}, projection.swath_mm, scratch.view);
  make_depth({away, rays}, scratch.view.depth);
  make_scale(centroid.distance, projection.target_radius_mm, rays.range_shift, scratch.view);
  loops.accumulate(frame, scratch);
  loops.encode(scratch.cells.data(), image.depth.data());
  return FrameStatus::kOk;
}

}  // namespace tumblesight::gnc
