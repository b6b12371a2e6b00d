#include "gnc/lidar/target_window.hpp"

#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kOneQ16 = 1 << 16;

// The middle of the frame is at (rays - 1) / 2, and one ray is 2 tan(fov / 2) / rays of slope.
WindowAxis make_axis(std::int64_t middle_q30, std::int64_t step_q16, int frame_rays,
                     std::int64_t tan_half_fov_q30) {
  const std::int64_t from_middle_q16 = divide(middle_q30 * frame_rays * (kOneQ16 / 2), tan_half_fov_q30);
  const std::int64_t middle_q16 = from_middle_q16 + (frame_rays - 1) * (kOneQ16 / 2);
  return {static_cast<std::int32_t>(middle_q16 - step_q16 * (kWindowRays - 1) / 2),
          static_cast<std::int32_t>(step_q16)};
}

// Position of a ray of the window along an axis of the frame, in Q8, limited to where it still differs: one
// ray beyond the frame's first and last ones.
int position_q8(const WindowAxis& axis, int ray, int frame_rays) {
  return clamp<int>((axis.first_q16 + ray * axis.step_q16) >> 8, -256, 256 * frame_rays - 1);
}

// A row of the frame in which only the target's ranges are left, with a zero before and after.
struct PaddedRow {
  std::array<std::uint16_t, RangeImage::kMaxRays + 2> ranges;
};

// Row -1 and the row after the last are empty.
void fetch(const RangeImage& frame, const RayMask& mask, int row, PaddedRow& out) {
  const int bounded = clamp<int>(row, 0, frame.rays - 1);
  const auto inside = static_cast<std::uint32_t>(sign_mask(abs(bounded - row) - 1));
  RayMask::Row bits = mask.rows[bounded];
  for (std::uint32_t& word : bits) word &= inside;
  out.ranges[0] = 0;
  masked_row(frame, bits, bounded, out.ranges.data() + 1);
  out.ranges[frame.rays + 1] = 0;
}

// The weights of four ranges that are on the same surface as `reference`, and the sum of the ranges by all
// weights, with `reference` in the place of the others.
struct Sample {
  int reference;
  int largest_step;
  int weight = 0;
  int sum = 0;

  void add(int range, int weight_of_range) {
    const int is_alike = sign_mask(abs(range - reference) - largest_step - 1) & sign_mask(-range);
    weight += weight_of_range & is_alike;
    sum += weight_of_range * ((range - reference) & is_alike);
  }
};

}  // namespace

void make_window(const RangeImage& frame, const WindowPlace& place, TargetWindow& window) {
  constexpr std::int64_t kLargestSize_q30 = std::int64_t{1} << 34;
  // Rays of the frame across the window.
  const std::int64_t across_q16 =
      divide(min<std::int64_t>(place.size_q30, kLargestSize_q30) * frame.rays * (kOneQ16 / 2),
             place.tan_half_fov_q30);
  window.is_resampled = across_q16 < std::int64_t{kFewRays} * kOneQ16;
  window.rays = window.is_resampled ? kWindowRays : frame.rays;
  const std::int64_t step_q16 = divide(across_q16, kWindowRays);
  const WindowAxis own{0, kOneQ16};
  window.columns =
      window.is_resampled ? make_axis(place.right_q30, step_q16, frame.rays, place.tan_half_fov_q30) : own;
  window.rows =
      window.is_resampled ? make_axis(place.down_q30, step_q16, frame.rays, place.tan_half_fov_q30) : own;
  window.largest_step = largest_step_counts(place.target_radius_mm);
  for (int ray = 0; ray < kWindowRays; ++ray) {
    const int position = position_q8(window.columns, ray, frame.rays);
    window.column_before[ray] = static_cast<std::uint8_t>((position >> 8) + 1);
    window.past_column_q8[ray] = static_cast<std::uint8_t>(position & 0xFF);
  }
}

void sample_row(const RangeImage& frame, const RayMask& mask, const TargetWindow& window, int row,
                std::uint16_t* out) {
  PaddedRow above, below;
  const int position = position_q8(window.rows, row, frame.rays);
  fetch(frame, mask, position >> 8, above);
  fetch(frame, mask, (position >> 8) + 1, below);
  const int down = position & 0xFF;
  const int nearer_below = sign_mask(127 - down);
  for (int column = 0; column < kWindowRays; ++column) {
    const int left = window.column_before[column];
    const int right = window.past_column_q8[column];
    const int top_left = above.ranges[left], top_right = above.ranges[left + 1];
    const int bottom_left = below.ranges[left], bottom_right = below.ranges[left + 1];

    const int nearer_right = sign_mask(127 - right);
    const int top = top_left ^ ((top_left ^ top_right) & nearer_right);
    const int bottom = bottom_left ^ ((bottom_left ^ bottom_right) & nearer_right);
    const int nearest = top ^ ((top ^ bottom) & nearer_below);
    const int any = max_small(max_small(top_left, top_right), max_small(bottom_left, bottom_right));
    Sample sample{nearest | (any & sign_mask(nearest - 1)), window.largest_step};

    sample.add(top_left, (256 - right) * (256 - down));
    sample.add(top_right, right * (256 - down));
    sample.add(bottom_left, (256 - right) * down);
    sample.add(bottom_right, right * down);
    const int range = sample.reference + ((sample.sum + (1 << 15)) >> 16);
    out[column] = static_cast<std::uint16_t>(range & ~sign_mask(sample.weight - kOneQ16 / 2));
  }
}

}  // namespace tumblesight::gnc
