// Convolution 3x3 with two thirds of the multiplications, for processors with 32-bit registers and no
// vectors, on which a multiplication costs what any instruction costs. Winograd's minimal filter: of a row
// d0...d3 and the weights g0...g2
//   d0 g0 + d1 g1 + d2 g2 = m0 + (m1 + m2) / 2        m0 = (d0 - d2) g0    m1 = (d1 + d2) (g0 + g1 + g2)
//   d1 g0 + d2 g1 + d3 g2 =      (m1 - m2) / 2 - m3   m3 = (d1 - d3) g2    m2 = (d2 - d1) (g0 - g1 + g2)
// exactly, since m1 + m2 and m1 - m2 are even. The m are summed over inputs and rows of weights before they
// are put together. Included by source files as blocks.hpp is.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

struct MinimalFilter {
  static constexpr int kTiles = 3;  // of two pixels, side by side
  static constexpr int kPixels = 2 * kTiles;
  static constexpr int kGroup = Int8Product::kGroup;
  static constexpr int kStretch =
      16;  // groups whose inputs are turned into differences and sums before they are used

  // Of one input of a tile: d0 - d2 and d1 + d2, d2 - d1 and d1 - d3; two numbers in one, the first one
  // above.
  using Turned = std::array<std::uint64_t, 2>;
  using Group = std::array<std::array<Turned, kTiles>, kGroup>;
  using Sums = std::int32_t[kTiles][4];

  static bool suits(const ProductShape& shape) {
    return shape.strip_length == 3 * shape.column_step && shape.columns % 2 == 0 &&
           shape.rows * shape.columns >= kPixels;
  }

  TUMBLESIGHT_INLINE std::uint64_t pair_of(std::int32_t first, std::int32_t second) {
    return std::uint64_t{static_cast<std::uint32_t>(first)} << 32 | static_cast<std::uint32_t>(second);
  }

  // `column_step` numbers lie between neighbours in a row.
  TUMBLESIGHT_INLINE void turn(const std::uint8_t* const (&in)[kTiles], int offset, int column_step,
                               Group& group) {
    for (int t = 0; t < kTiles; ++t) {
      const std::uint8_t* const d = in[t] + offset;
#pragma GCC unroll 4
      for (int i = 0; i < kGroup; ++i) {
        const std::int32_t d0 = d[i], d1 = d[column_step + i], d2 = d[2 * column_step + i],
                           d3 = d[3 * column_step + i];
        group[i][t] = {pair_of(d0 - d2, d1 + d2), pair_of(d2 - d1, d1 - d3)};
      }
    }
  }

  // The group's inputs times the weights of one channel.
#if defined(__sparc__)
  // Written down, since a compiler takes the pairs apart, which here are fetched at once, and runs out of
  // registers.
  TUMBLESIGHT_INLINE void add(const Group* group, const std::int8_t* const (&weight)[3], Sums& sums) {
#define TUMBLESIGHT_TILE(at, a, b, c, d) \
  "ldd [%[in]+" #at                      \
  "], %%o0\n\t"                          \
  "smul %%o0, %%o2, %%o0\n\t"            \
  "add %[" #a "], %%o0, %[" #a           \
  "]\n\t"                                \
  "smul %%o1, %%o4, %%o1\n\t"            \
  "add %[" #b "], %%o1, %[" #b           \
  "]\n\t"                                \
  "ldd [%[in]+8+" #at                    \
  "], %%o0\n\t"                          \
  "smul %%o0, %%o3, %%o0\n\t"            \
  "add %[" #c "], %%o0, %[" #c           \
  "]\n\t"                                \
  "smul %%o1, %%o5, %%o1\n\t"            \
  "add %[" #d "], %%o1, %[" #d "]\n\t"
#define TUMBLESIGHT_INPUT(i, at)                                                                            \
  "ldsb [%[g0]+" #i                                                                                         \
  "], %%o2\n\t"                                                                                             \
  "ldsb [%[g1]+" #i                                                                                         \
  "], %%o3\n\t"                                                                                             \
  "ldsb [%[g2]+" #i                                                                                         \
  "], %%o5\n\t"                                                                                             \
  "add %%o2, %%o5, %%o0\n\t"                                                                                \
  "add %%o0, %%o3, %%o4\n\t"                                                                                \
  "sub %%o0, %%o3, %%o3\n\t" TUMBLESIGHT_TILE(at, a0, a1, a2, a3) TUMBLESIGHT_TILE(at + 16, b0, b1, b2, b3) \
      TUMBLESIGHT_TILE(at + 32, c0, c1, c2, c3)
    auto& [a, b, c] = sums;
    asm volatile(TUMBLESIGHT_INPUT(0, 0) TUMBLESIGHT_INPUT(1, 48) TUMBLESIGHT_INPUT(2, 96)
                     TUMBLESIGHT_INPUT(3, 144)
                 : [a0] "+r"(a[0]), [a1] "+r"(a[1]), [a2] "+r"(a[2]), [a3] "+r"(a[3]), [b0] "+r"(b[0]),
                   [b1] "+r"(b[1]), [b2] "+r"(b[2]), [b3] "+r"(b[3]), [c0] "+r"(c[0]), [c1] "+r"(c[1]),
                   [c2] "+r"(c[2]), [c3] "+r"(c[3])
                 : [in] "r"(group), [g0] "r"(weight[0]), [g1] "r"(weight[1]), [g2] "r"(weight[2])
                 : "o0", "o1", "o2", "o3", "o4", "o5", "memory");
#undef TUMBLESIGHT_INPUT
#undef TUMBLESIGHT_TILE
  }
#else
  TUMBLESIGHT_INLINE void add(const Group* group, const std::int8_t* const (&weight)[3], Sums& sums) {
#pragma GCC unroll 4
    for (int i = 0; i < kGroup; ++i) {
      const std::int32_t g0 = weight[0][i], g1 = weight[1][i], g2 = weight[2][i];
      const std::int32_t factor[4] = {g0, (g0 + g2) + g1, (g0 + g2) - g1, g2};
#pragma GCC unroll 3
      for (int t = 0; t < kTiles; ++t) {
        const Turned& two = (*group)[i][t];
        add_to(sums[t][0], static_cast<std::int32_t>(two[0] >> 32), factor[0]);
        add_to(sums[t][1], static_cast<std::int32_t>(two[0]), factor[1]);
        add_to(sums[t][2], static_cast<std::int32_t>(two[1] >> 32), factor[2]);
        add_to(sums[t][3], static_cast<std::int32_t>(two[1]), factor[3]);
      }
    }
  }
  // Done with this sum before anything else begins: left to itself the compiler begins too much, and runs out
  // of registers.
  TUMBLESIGHT_INLINE void add_to(std::int32_t& sum, std::int32_t value, std::int32_t factor) {
    sum += value * factor;
    asm volatile("" : : "r"(sum) : "memory");
  }
#endif

  // The stretch's part of six pixels in one channel. A function of its own, lest the compiler take the
  // stretch apart. `step`: from a group's weights to the next one's; `apart`: to those of the next column.
  [[gnu::noinline]] static void add_stretch(const Group* stretch, int groups, int step, int apart,
                                            const std::int32_t* start, int start_step,
                                            const std::int8_t* weights, std::int32_t* out, int channels) {
    for (int c = 0; c < channels; ++c) {
      Sums sums{};
      const std::int8_t* weight[3] = {weights, weights + apart, weights + 2 * apart};
      for (const Group* group = stretch; group != stretch + groups; ++group) {
        add(group, weight, sums);
        for (const std::int8_t*& at : weight) at += step;
      }
      put_together(sums, start + c, start_step, out + c, channels);
      weights += kGroup;
    }
  }

  TUMBLESIGHT_INLINE void put_together(const Sums& sums, const std::int32_t* start, int start_step,
                                       std::int32_t* out, int out_step) {
#pragma GCC unroll 3
    for (const auto& m : sums) {
      out[0] = start[0] + (m[0] + ((m[1] + m[2]) >> 1));
      out[out_step] = start[start_step] + (((m[1] - m[2]) >> 1) - m[3]);
      start += 2 * start_step;
      out += 2 * out_step;
    }
  }

  // Six pixels, all channels.
  TUMBLESIGHT_INLINE void tiles(const ProductShape& shape, const std::uint8_t* const (&in)[kTiles],
                                const std::int32_t* start, const std::int8_t* weights, std::int32_t* out) {
    Group stretch[kStretch];
    // Where a pixel has one group of inputs only, the strips make one stretch together.
    const bool joined = shape.column_step == kGroup && shape.strips <= kStretch;
    const int runs = joined ? 1 : shape.strips;
    const int run = joined ? shape.strips : shape.column_step / kGroup;  // groups
    const int in_step = joined ? shape.strip_step : kGroup;
    const int apart = shape.column_step * shape.channels;
    const int step = joined ? 3 * apart : kGroup * shape.channels;
    int start_step = 0;  // the same for every pixel
    for (int strip = 0; strip < runs; ++strip) {
      for (int first = 0; first < run; first += kStretch) {
        const int groups = min(run - first, kStretch);
        for (int g = 0; g < groups; ++g) {
          turn(in, strip * shape.strip_step + (first + g) * in_step, shape.column_step, stretch[g]);
        }
        add_stretch(stretch, groups, step, apart, start, start_step,
                    weights + strip * 3 * apart + first * step, out, shape.channels);
        start = out;
        start_step = shape.channels;
      }
    }
  }

  // The last tiles are moved back to end at the last one; what is done again comes out the same.
  static void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, std::int32_t* out) {
    const int columns = shape.columns / 2;
    const int count = shape.rows * columns;
    for (int next = 0; next < count; next += kTiles) {
      const int first = min(next, count - kTiles);
      const std::uint8_t* of_tile[kTiles];
      for (int t = 0; t < kTiles; ++t) {
        const int y = (first + t) / columns;
        of_tile[t] = in + y * shape.row_step + 2 * (first + t - y * columns) * shape.column_step;
      }
      tiles(shape, of_tile, start, weights, out + 2 * first * shape.channels);
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
