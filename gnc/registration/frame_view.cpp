#include "gnc/registration/frame_view.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/functions.hpp"
#include "gnc/numerics/select.hpp"
#include "gnc/registration/reciprocal.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kOneQ30 = std::int64_t{1} << 30;
constexpr std::int64_t kNearest_um = 1'000'000, kFarthest_um = 520'000'000;
constexpr std::int64_t kMostNoise_q8 = 1 << 24;
constexpr int kMostShift = 26;
constexpr int kHiddenCounts = 2 * kCountsPerMetre;  // in front of the nearest return of the target

std::int64_t product_q30(std::int64_t a, std::int64_t b) {
  return (a * b) >> 30;
}

// tan(x) for half of a field of view, by its series up to the 11th power.
std::int64_t tan_half_q30(std::uint32_t fov_urad) {
  const std::int64_t x = divide(std::int64_t{fov_urad} * (kOneQ30 / 64), 31'250);  // 2 * 10^6 / 64
  const std::int64_t s = product_q30(x, x);
  constexpr std::array<std::int64_t, 5> kTerms{9'521'150, 23'498'208, 57'954'022, 143'165'577, 357'913'941};
  std::int64_t sum = 0;
  for (const std::int64_t term : kTerms) sum = product_q30(s, sum + term);
  return x + product_q30(x, sum);
}

// The same in 32 bits.
std::int32_t short_product_q30(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>((std::int64_t{a} * b) >> 30);
}

// 1 / sqrt(1 + s) with 30 fraction bits, s in Q30 below 1, by Newton's method.
std::int32_t inverse_norm_q30(std::int32_t s) {
  const std::int32_t half_a_q30 = (1 << 29) + s / 2;
  std::int32_t y = (1 << 30) - s / 2 + short_product_q30(s, short_product_q30(s, 3 << 27));
  for (int i = 0; i < 3; ++i)
    y = short_product_q30(y, (3 << 29) - short_product_q30(half_a_q30, short_product_q30(y, y)));
  return y;
}

// From a range and the length of its ray to a depth over the reference depth.
class Depths {
 public:
  explicit Depths(std::int32_t reference_depth_um) {
    const auto counts =
        static_cast<std::int32_t>(divide(std::int64_t{reference_depth_um} * kCountsPerMetre, 1'000'000));
    bits_ = 16 - highest_bit(static_cast<std::uint64_t>(counts));  // so that 3 `counts` have 31 with 12 more
    most_ = 3 * counts;
    per_count_q27_ = static_cast<std::int32_t>(min<std::int64_t>(
        divide((std::int64_t{1'000'000} << 40), std::int64_t{reference_depth_um} << bits_), 0x7FFF'FFFF));
  }
  // Limited to 1/4 to 2.
  std::int32_t over_reference_q30(std::uint16_t range, std::int32_t inverse_norm_q30) const {
    const std::int32_t counts = min_small(range, most_);
    const auto depth_q12 = static_cast<std::int32_t>((std::int64_t{counts} * inverse_norm_q30) >> 18);
    const std::int32_t depth_q27 = high_product(depth_q12 * (1 << bits_), per_count_q27_);
    return min_small(max_small(depth_q27, 1 << 25), (1 << 28) - 1) * 8;
  }

 private:
  int bits_;
  std::int32_t most_, per_count_q27_;
};

std::uint16_t nearest_of(const RangeImage& frame, const RayMask& mask) {
  std::uint16_t nearest = 0xFFFF;
  for (int row = 0; row < frame.rays; ++row) {
    for (int word = 0; word < RayMask::kWordsPerRow; ++word) {
      std::uint32_t rays = mask.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(word)];
      for (int column = word * RayMask::kColumnsPerWord; rays != 0; ++column, rays <<= 1) {
        const std::uint16_t range = frame.ranges[row * frame.rays + column];
        if ((rays >> 31) != 0 && range < nearest) nearest = range;
      }
    }
  }
  return nearest;
}

// Standard deviation of a range at the reference depth.
std::int64_t sigma_at_um(const RangeNoise& noise, std::int32_t reference_depth_um) {
  return std::int64_t{noise.constant_mm} * 1000 +
         divide(std::int64_t{reference_depth_um} * noise.share_1e5, 100'000);
}

bool is_in_reach(std::int32_t reference_depth_um, std::int64_t radius_um) {
  return radius_um > 0 && reference_depth_um >= max<std::int64_t>(2 * radius_um, kNearest_um) &&
         reference_depth_um <= kFarthest_um;
}

// False: the target is too small for a shift of the inverse depth.
bool set_scales(const RangeImage& frame, std::int32_t reference_depth_um, std::int64_t radius_um,
                std::int64_t sigma_um, FrameView& view) {
  view.rays = frame.rays;
  view.tan_half_fov_q30 = tan_half_q30(frame.fov_urad);
  view.reference_depth_um = reference_depth_um;
  view.target_radius_um = static_cast<std::int32_t>(radius_um);
  view.radius_over_depth_q30 = static_cast<std::int32_t>(divide(radius_um << 30, reference_depth_um));
  // (depth - radius) / radius: the inverse depth of the nearest point before the shift is one over it.
  view.shift =
      13 + highest_bit(static_cast<std::uint64_t>(divide(reference_depth_um - radius_um, radius_um)));
  if (view.shift > kMostShift) return false;
  view.noise_q8 = static_cast<std::int32_t>(
      clamp<std::int64_t>(divide(sigma_um << (view.shift + 8), reference_depth_um), 1, kMostNoise_q8));
  view.rays_per_radius_q8 = static_cast<std::int32_t>(
      divide(std::int64_t{view.radius_over_depth_q30} * view.rays * 128, view.tan_half_fov_q30));
  return true;
}

// From the ranges of a frame to inverse depths.
class InverseDepths {
 public:
  InverseDepths(const RangeImage& frame, const FrameView& view, std::int64_t sigma_um)
      : frame_(frame), depths_(view.reference_depth_um), shift_(view.shift) {
    // The mean of 1 / depth is larger than 1 / mean depth, by the squared relative noise.
    const std::int64_t relative_q30 = min(kOneQ30 / 2, divide(sigma_um << 30, view.reference_depth_um));
    unbiased_q30_ = static_cast<std::int32_t>(kOneQ30 - product_q30(relative_q30, relative_q30));
    for (int i = 0; i < frame.rays; ++i) {
      const std::int64_t slope = divide(view.tan_half_fov_q30 * (2 * i + 1 - frame.rays), frame.rays);
      slope_squared_q30_[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(product_q30(slope, slope));
    }
  }
  std::int32_t at(int row, int column) const {
    const std::int32_t inverse_norm = inverse_norm_q30(slope_squared_q30_[static_cast<std::size_t>(row)] +
                                                       slope_squared_q30_[static_cast<std::size_t>(column)]);
    const std::uint16_t range = frame_.ranges[row * frame_.rays + column];
    const std::int32_t inverse_q28 = reciprocal_q28(depths_.over_reference_q30(range, inverse_norm));
    const std::int32_t inverse_depth =
        (short_product_q30(inverse_q28, unbiased_q30_) - (1 << 28)) >> (28 - shift_);
    return min_small(max_small(inverse_depth, -32'766), 32'767);
  }

 private:
  const RangeImage& frame_;
  Depths depths_;
  int shift_;
  std::int32_t unbiased_q30_;
  std::array<std::int32_t, RangeImage::kMaxRays> slope_squared_q30_;  // of the rays of a row or a column
};

// Means over the blocks of two rows.
class BlockMeans {
 public:
  void add(int column, std::int32_t inverse_depth) {
    const auto block = static_cast<std::size_t>(column / 2);
    sum_[block] += inverse_depth;
    ++count_[block];
  }
  // Begins again.
  void write(int block_row, FrameView& view) {
    constexpr std::array<std::int32_t, 5> kShare_q16{0, 65536, 32768, 21846, 16384};
    for (int block = 0; block < FrameView::kMaxBlocks; ++block) {
      const auto at = static_cast<std::size_t>(block);
      const std::int64_t mean_q16 = std::int64_t{sum_[at]} * kShare_q16[static_cast<std::size_t>(count_[at])];
      view.block_inverse_depth[block_row * FrameView::kMaxBlocks + block] =
          static_cast<std::int16_t>((mean_q16 + (1 << 15)) >> 16);
      sum_[at] = count_[at] = 0;
    }
  }

 private:
  std::array<std::int32_t, FrameView::kMaxBlocks> sum_{}, count_{};
};

// Adds the target's returns of a row to the means, and marks the other rays that something hides. `nearest`:
// range of the nearest return of the target.
void add_row(const RangeImage& frame, int row, std::uint16_t nearest, const InverseDepths& inverse_depths,
             BlockMeans& means, FrameView& view) {
  const auto at_row = static_cast<std::size_t>(row);
  for (int first = 0; first < frame.rays; first += RayMask::kColumnsPerWord) {
    const auto at_word = static_cast<std::size_t>(first / RayMask::kColumnsPerWord);
    std::uint32_t of_target = view.returned.rows[at_row][at_word];
    std::uint32_t hidden = 0;
    const int count = min<int>(RayMask::kColumnsPerWord, frame.rays - first);
    for (int i = 0; i < count; ++i, of_target <<= 1) {
      hidden <<= 1;
      if ((of_target >> 31) != 0) {
        means.add(first + i, inverse_depths.at(row, first + i));
      } else {
        const std::uint16_t range = frame.ranges[row * frame.rays + first + i];
        hidden |= range != 0 && range + kHiddenCounts < nearest ? 1U : 0U;
      }
    }
    view.hidden.rows[at_row][at_word] = hidden << (RayMask::kColumnsPerWord - count);
  }
}

}  // namespace

bool make_frame_view(const RangeImage& frame, const RayMask& mask, std::int32_t reference_depth_um,
                     std::uint32_t target_radius_mm, const RangeNoise& noise, FrameView& view) {
  const std::int64_t radius_um = std::int64_t{target_radius_mm} * 1000;
  if (!is_in_reach(reference_depth_um, radius_um)) return false;
  const std::int64_t sigma_um = sigma_at_um(noise, reference_depth_um);
  if (!set_scales(frame, reference_depth_um, radius_um, sigma_um, view)) return false;
  view.returned = mask;
  view.hidden = {};
  const std::uint16_t nearest = nearest_of(frame, mask);
  const InverseDepths inverse_depths(frame, view, sigma_um);
  BlockMeans means;
  for (int row = 0; row < frame.rays; ++row) {
    add_row(frame, row, nearest, inverse_depths, means, view);
    if (row % 2 == 1) means.write(row / 2, view);
  }
  return true;
}

}  // namespace tumblesight::gnc
