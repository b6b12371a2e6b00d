// 3x3 convolution with two thirds of the multiplications, for processors with 32-bit registers and no
// vectors, on which a multiplication costs as much as an addition. Winograd's minimal filter F(2, 3), applied
// to the rows: for inputs d0...d3 and weights g0...g2
//   d0 g0 + d1 g1 + d2 g2 = m0 + (m1 + m2) / 2        m0 = (d0 - d2) g0    m1 = (d1 + d2) (g0 + g1 + g2)
//   d1 g0 + d2 g1 + d3 g2 =      (m1 - m2) / 2 - m3   m3 = (d1 - d3) g2    m2 = (d2 - d1) (g0 - g1 + g2)
// This is exact, since m1 + m2 and m1 - m2 are even. The m are summed over all inputs and rows of weights
// before they are combined. Included by the source files of the instruction sets, like blocks.hpp.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

struct Winograd {
  static constexpr int kTiles = 3;  // tiles of two adjacent pixels
  static constexpr int kPixels = 2 * kTiles;
  static constexpr int kGroup = Int8Product::kGroup;
  static constexpr int kChunkGroups =
      16;  // groups whose inputs are turned into differences and sums before they are used

  // One input of a tile: d0 - d2 and d1 + d2, then d2 - d1 and d1 - d3. Two numbers per word, the first in
  // the high half.
  using TransformedInput = std::array<std::uint64_t, 2>;
  using Group = std::array<std::array<TransformedInput, kTiles>, kGroup>;
  using Sums = std::int32_t[kTiles][4];

  // Whether `shape` is a 3-wide convolution over an even number of columns with enough pixels.
  static bool supports(const ProductShape& shape) {
    return shape.strip_length == 3 * shape.column_step && shape.columns % 2 == 0 &&
           shape.rows * shape.columns >= kPixels;
  }

  TUMBLESIGHT_INLINE std::uint64_t pack_pair(std::int32_t first, std::int32_t second) {
    return std::uint64_t{static_cast<std::uint32_t>(first)} << 32 | static_cast<std::uint32_t>(second);
  }

  // `column_step`: values from one pixel of a row to the next.
  TUMBLESIGHT_INLINE void transform_input(const std::uint8_t* const (&in)[kTiles], int offset,
                                          int column_step, Group& group) {
    for (int t = 0; t < kTiles; ++t) {
      const std::uint8_t* const d = in[t] + offset;
#pragma GCC unroll 4
      for (int i = 0; i < kGroup; ++i) {
        const std::int32_t d0 = d[i], d1 = d[column_step + i], d2 = d[2 * column_step + i],
                           d3 = d[3 * column_step + i];
        group[i][t] = {pack_pair(d0 - d2, d1 + d2), pack_pair(d2 - d1, d1 - d3)};
      }
    }
  }

  // Adds the products of a group's inputs and the weights of one channel.
#if defined(__sparc__)
  // In assembly: a pair is loaded with one instruction. The compiler loads its halves separately and runs out
  // of registers.
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
        const TransformedInput& two = (*group)[i][t];
        add_to(sums[t][0], static_cast<std::int32_t>(two[0] >> 32), factor[0]);
        add_to(sums[t][1], static_cast<std::int32_t>(two[0]), factor[1]);
        add_to(sums[t][2], static_cast<std::int32_t>(two[1] >> 32), factor[2]);
        add_to(sums[t][3], static_cast<std::int32_t>(two[1]), factor[3]);
      }
    }
  }
  // The empty assembly statement finishes this sum before the next one starts. Without it the compiler
  // interleaves too many sums and runs out of registers.
  TUMBLESIGHT_INLINE void add_to(std::int32_t& sum, std::int32_t value, std::int32_t factor) {
    sum += value * factor;
    asm volatile("" : : "r"(sum) : "memory");
  }
#endif

  // Adds the products of a chunk to the sums of six pixels in all channels. Not inlined: otherwise the
  // compiler splits the chunk into separate variables. `step`: from the weights of a group to those of the
  // next group; `column_step`: to those of the next column of the filter.
  [[gnu::noinline]] static void add_chunk(const Group* chunk, int groups, int step, int column_step,
                                          const std::int32_t* start, int start_step,
                                          const std::int8_t* weights, std::int32_t* out, int channels) {
    for (int c = 0; c < channels; ++c) {
      Sums sums{};
      const std::int8_t* weight[3] = {weights, weights + column_step, weights + 2 * column_step};
      for (const Group* group = chunk; group != chunk + groups; ++group) {
        add(group, weight, sums);
        for (const std::int8_t*& at : weight) at += step;
      }
      transform_output(sums, start + c, start_step, out + c, channels);
      weights += kGroup;
    }
  }

  TUMBLESIGHT_INLINE void transform_output(const Sums& sums, const std::int32_t* start, int start_step,
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
    Group chunk[kChunkGroups];
    // If a pixel has only one group of inputs, all strips form one chunk.
    const bool joined = shape.column_step == kGroup && shape.strips <= kChunkGroups;
    const int runs = joined ? 1 : shape.strips;
    const int run = joined ? shape.strips : shape.column_step / kGroup;  // groups
    const int in_step = joined ? shape.strip_step : kGroup;
    const int weight_column_step = shape.column_step * shape.channels;
    const int step = joined ? 3 * weight_column_step : kGroup * shape.channels;
    int start_step = 0;  // the same for every pixel
    for (int strip = 0; strip < runs; ++strip) {
      for (int first = 0; first < run; first += kChunkGroups) {
        const int groups = min(run - first, kChunkGroups);
        for (int g = 0; g < groups; ++g) {
          transform_input(in, strip * shape.strip_step + (first + g) * in_step, shape.column_step, chunk[g]);
        }
        add_chunk(chunk, groups, step, weight_column_step, start, start_step,
                  weights + strip * 3 * weight_column_step + first * step, out, shape.channels);
        start = out;
        start_step = shape.channels;
      }
    }
  }

  // The last tiles are moved back to end at the last pixel; the pixels computed a second time get the same
  // values.
  static void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, std::int32_t* out) {
    const int columns = shape.columns / 2;
    const int count = shape.rows * columns;
    for (int next = 0; next < count; next += kTiles) {
      const int first = min(next, count - kTiles);
      const std::uint8_t* tile_in[kTiles];
      for (int t = 0; t < kTiles; ++t) {
        const int y = (first + t) / columns;
        tile_in[t] = in + y * shape.row_step + 2 * (first + t - y * columns) * shape.column_step;
      }
      tiles(shape, tile_in, start, weights, out + 2 * first * shape.channels);
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
