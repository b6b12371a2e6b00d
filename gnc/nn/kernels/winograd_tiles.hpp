// 3x3 convolution of a whole image with max pooling by Winograd's minimal filter F(4x4, 3x3), for vectors of
// 16-bit products: a quarter of the multiplications. The tiles are pooled while they are in registers.
// Included by the source files of the instruction sets, like blocks.hpp.
#pragma once

#include "gnc/nn/kernels/pooled_windows.hpp"
#include "gnc/nn/kernels/winograd_filters.hpp"
#include "gnc/nn/kernels/x86_vectors.hpp"

namespace tumblesight::gnc {
namespace {

// Ops defines a Vector of kLanes 32-bit numbers, and
//   Vector load(const void*), void store(Vector, void*), Vector zero(), Vector broadcast(const std::int32_t*)
//   Vector add_16(), sub_16(a, b), Vector shift_16<n>(a) to the left, Vector add_32(), sub_32(a, b)
//   Vector shift_32<n>() to the left, Vector divide<n>(a): a / 2^n, Vector multiply_32(a, b), max_32(a, b)
//   Vector widen<odd>(Vector)                            its signed bytes with an even (0) or odd (1) index
//   void multiply_add(Vector& sum, Vector a, Vector b)   adds the products of 16-bit pairs
//   Pool                                                 of PooledWindows; kPooled vectors make its Sums
//   Pool::Sums sums(const Vector*)
//   kTiles                                               tiles whose sums are in registers together
template <class Ops>
struct WinogradTiles {
  using Vector = typename Ops::Vector;
  using Pool = typename Ops::Pool;
  static constexpr int kLanes = Ops::kLanes;
  static constexpr int kPacks = 2;  // vectors of channels that are computed together
  static constexpr int kChannels = kPacks * kLanes;
  static constexpr int kTile = MinimalFilter4::kTile, kPatch = MinimalFilter4::kPatch,
                       kPositions = kPatch * kPatch;
  static constexpr int kGroup = Int8Product::kGroup;
  static constexpr int kChunk = 32;          // channels of the input that are transformed together
  static constexpr int kPairs = kChunk / 2;  // pairs of 16-bit inputs
  static constexpr int kBatch = 9;           // tiles whose sums are in memory together
  static constexpr int kMaxInputPairs = 36 * kPositions * kPairs;

  // Pairs of inputs by position, tile and channel. In each chunk first the even channels of every group, then
  // the odd ones, as split() leaves them.
  struct Scratch {
    std::int32_t inputs[kMaxInputPairs];
    // One row more than used: at a distance of a power of two they would compete for the same places in the
    // cache.
    std::int32_t weights[kPositions][kPairs + 1][kPacks][kLanes];
    std::int32_t sums[kPositions][kBatch][kPacks][kLanes];
  };

  static constexpr int tiles_of(const ImageShape& shape) {
    return (shape.columns() / kTile) * (shape.columns() / kTile);
  }
  static bool fits(const ImageShape& shape) {
    const int tiles = tiles_of(shape);
    return shape.columns() % kTile == 0 && tiles >= kBatch && shape.channels_in % kChunk == 0 &&
           shape.channels_in <= MinimalFilter4::kMaxChannelsIn && shape.channels_out % kChannels == 0 &&
           tiles * kPositions * shape.channels_in / 2 <= kMaxInputPairs;
  }

  using Filter = MinimalFilter4;
  struct InputArithmetic {  // of vectors of 16-bit numbers
    TUMBLESIGHT_INLINE __m256i add(__m256i a, __m256i b) { return _mm256_add_epi16(a, b); }
    TUMBLESIGHT_INLINE __m256i sub(__m256i a, __m256i b) { return _mm256_sub_epi16(a, b); }
    template <int kBits>
    TUMBLESIGHT_INLINE __m256i shift(__m256i a) {
      return _mm256_slli_epi16(a, kBits);
    }
  };
  struct WeightArithmetic {
    TUMBLESIGHT_INLINE Vector add(Vector a, Vector b) { return Ops::add_16(a, b); }
    TUMBLESIGHT_INLINE Vector sub(Vector a, Vector b) { return Ops::sub_16(a, b); }
    template <int kBits>
    TUMBLESIGHT_INLINE Vector shift(Vector a) {
      return Ops::template shift_16<kBits>(a);
    }
  };
  struct SumArithmetic {
    TUMBLESIGHT_INLINE Vector add(Vector a, Vector b) { return Ops::add_32(a, b); }
    TUMBLESIGHT_INLINE Vector sub(Vector a, Vector b) { return Ops::sub_32(a, b); }
    template <int kBits>
    TUMBLESIGHT_INLINE Vector shift(Vector a) {
      return Ops::template shift_32<kBits>(a);
    }
  };

  // One tile and chunk. `out`: its place at the first position; `step`: pairs from one position to the next.
  TUMBLESIGHT_INLINE void transform_patch(const std::uint8_t* in, int row, int column, std::int32_t* out,
                                          int step) {
    __m256i half[2][kPatch][kPatch];  // even and odd channels; by row of positions and column of inputs
    for (int x = 0; x < kPatch; ++x) {
      __m256i d[2][kPatch], transformed[kPatch];
#pragma GCC unroll 6
      for (int y = 0; y < kPatch; ++y) {
        const __m256i bytes = load_256(in + y * row + x * column);
        d[0][y] = _mm256_and_si256(bytes, _mm256_set1_epi16(0xFF));
        d[1][y] = _mm256_srli_epi16(bytes, 8);
      }
#pragma GCC unroll 2
      for (int odd = 0; odd < 2; ++odd) {
        Filter::inputs<InputArithmetic>(d[odd], transformed);
#pragma GCC unroll 6
        for (int u = 0; u < kPatch; ++u) half[odd][u][x] = transformed[u];
      }
    }
    for (int odd = 0; odd < 2; ++odd) {
      for (int u = 0; u < kPatch; ++u) {
        __m256i transformed[kPatch];
        Filter::inputs<InputArithmetic>(half[odd][u], transformed);
#pragma GCC unroll 6
        for (int v = 0; v < kPatch; ++v)
          store_256(transformed[v], out + (u * kPatch + v) * step + odd * kPairs / 2);
      }
    }
  }
  static void transform_image(const ImageShape& shape, const std::uint8_t* in, std::int32_t* out) {
    const int pairs = shape.channels_in / 2;
    const int side = shape.columns() / kTile, step = side * side * pairs;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x, out += pairs) {
        const std::uint8_t* const patch = in + kTile * (y * shape.row() + x * shape.channels_in);
        for (int c = 0; c < shape.channels_in; c += kChunk)
          transform_patch(patch + c, shape.row(), shape.channels_in, out + c / 2, step);
      }
    }
  }

  // The even (kOdd = 0) or odd channels of a group of inputs and the weights of kLanes output channels.
  // `step`: from one column of the filter to the next. `out`: their place at the first position.
  static constexpr int kPositionStep = (kPairs + 1) * kChannels;
  template <int kOdd>
  TUMBLESIGHT_INLINE void transform_filter(const std::int8_t* weights, int step, std::int32_t* out) {
    Vector rows[3][kPatch];  // by column of weights and row of positions
#pragma GCC unroll 3
    for (int x = 0; x < 3; ++x) {
      Vector column[3];
#pragma GCC unroll 3
      for (int y = 0; y < 3; ++y)
        column[y] = Ops::template widen<kOdd>(Ops::load(weights + (y * 3 + x) * step));
      Filter::weights<WeightArithmetic>(column, rows[x]);
    }
#pragma GCC unroll 6
    for (int u = 0; u < kPatch; ++u) {
      const Vector columns[3] = {rows[0][u], rows[1][u], rows[2][u]};
      Vector transformed[kPatch];
      Filter::weights<WeightArithmetic>(columns, transformed);
#pragma GCC unroll 6
      for (int v = 0; v < kPatch; ++v) Ops::store(transformed[v], out + (u * kPatch + v) * kPositionStep);
    }
  }
  // The weights of a chunk and kChannels output channels.
  static void transform_filters(const std::int8_t* weights, int channels, int step, Scratch& scratch) {
    for (int g = 0; g < kChunk / kGroup; ++g) {
      for (int pack = 0; pack < kPacks; ++pack) {
        const std::int8_t* const from = weights + (g * channels + pack * kLanes) * kGroup;
        transform_filter<0>(from, step, scratch.weights[0][g][pack]);
        transform_filter<1>(from, step, scratch.weights[0][g + kPairs / 2][pack]);
      }
    }
  }

  // Sums of the products of a chunk for Ops::kTiles tiles at one position, added to those of the chunks
  // before unless it is the first. Not inlined: otherwise the compiler runs out of registers.
  template <bool kFirst>
  [[gnu::noinline]] static void multiply(const std::int32_t* inputs, int tile_step,
                                         const std::int32_t (*weights)[kPacks][kLanes],
                                         std::int32_t (*sums)[kPacks][kLanes]) {
    Vector sum[Ops::kTiles][kPacks];
#pragma GCC unroll 16
    for (int t = 0; t < Ops::kTiles; ++t) {
#pragma GCC unroll 2
      for (int p = 0; p < kPacks; ++p) sum[t][p] = kFirst ? Ops::zero() : Ops::load(sums[t][p]);
    }
    for (int i = 0; i < kPairs; ++i) {
      const Vector weight[kPacks] = {Ops::load(weights[i][0]), Ops::load(weights[i][1])};
#pragma GCC unroll 16
      for (int t = 0; t < Ops::kTiles; ++t) {
        const Vector value = Ops::broadcast(inputs + t * tile_step + i);
#pragma GCC unroll 2
        for (int p = 0; p < kPacks; ++p) {
          Ops::multiply_add(sum[t][p], value, weight[p]);
          asm("" : "+v"(sum[t][p]));  // otherwise the compiler moves every sum to another register and back
        }
      }
    }
#pragma GCC unroll 16
    for (int t = 0; t < Ops::kTiles; ++t) {
#pragma GCC unroll 2
      for (int p = 0; p < kPacks; ++p) Ops::store(sum[t][p], sums[t][p]);
    }
  }
  // A batch at all positions.
  template <bool kFirst>
  static void multiply_batch(const ImageShape& shape, const std::int32_t* inputs, Scratch& scratch) {
    static_assert(kBatch % Ops::kTiles == 0);
    const int tile_step = shape.channels_in / 2, step = tiles_of(shape) * tile_step;
    for (int position = 0; position < kPositions; ++position, inputs += step) {
      for (int t = 0; t < kBatch; t += Ops::kTiles) {
        multiply<kFirst>(inputs + t * tile_step, tile_step, scratch.weights[position],
                         scratch.sums[position] + t);
      }
    }
  }

  // Sums of one vector of channels of a tile: the largest of each of its four windows, without the start.
  template <int kShift>
  TUMBLESIGHT_INLINE Vector unscaled(Vector scaled) {
    return Ops::template divide<kShift>(Ops::multiply_32(scaled, Filter::kInverseOf9));
  }
  template <int kRow, int kColumn>
  TUMBLESIGHT_INLINE Vector largest_of_window(const Vector (&top)[kTile], const Vector (&bottom)[kTile]) {
    constexpr int kTop = Filter::kShifts[kRow], kBottom = Filter::kShifts[kRow + 1];
    constexpr int kLeft = Filter::kShifts[kColumn], kRight = Filter::kShifts[kColumn + 1];
    return Ops::max_32(
        Ops::max_32(unscaled<kTop + kLeft>(top[kColumn]), unscaled<kTop + kRight>(top[kColumn + 1])),
        Ops::max_32(unscaled<kBottom + kLeft>(bottom[kColumn]),
                    unscaled<kBottom + kRight>(bottom[kColumn + 1])));
  }
  TUMBLESIGHT_INLINE void largest_sums(const Scratch& scratch, int tile, int pack, Vector (&out)[2][2]) {
    Vector columns[kTile][kPatch];  // by column of sums and row of positions
#pragma GCC unroll 6
    for (int u = 0; u < kPatch; ++u) {
      Vector m[kPatch], transformed[kTile];
#pragma GCC unroll 6
      for (int v = 0; v < kPatch; ++v) m[v] = Ops::load(scratch.sums[u * kPatch + v][tile][pack]);
      Filter::sums<SumArithmetic>(m, transformed);
#pragma GCC unroll 4
      for (int x = 0; x < kTile; ++x) columns[x][u] = transformed[x];
    }
    Vector rows[kTile][kTile];
#pragma GCC unroll 4
    for (int x = 0; x < kTile; ++x) {
      Vector transformed[kTile];
      Filter::sums<SumArithmetic>(columns[x], transformed);
#pragma GCC unroll 4
      for (int y = 0; y < kTile; ++y) rows[y][x] = transformed[y];
    }
    out[0][0] = largest_of_window<0, 0>(rows[0], rows[1]);
    out[0][1] = largest_of_window<0, 2>(rows[0], rows[1]);
    out[1][0] = largest_of_window<2, 0>(rows[2], rows[3]);
    out[1][1] = largest_of_window<2, 2>(rows[2], rows[3]);
  }

  // The four windows of a tile.
  static void pool_tile(const Scratch& scratch, int tile, const std::int32_t* start,
                        const std::uint8_t* shift, int channels, std::uint8_t* out, int out_row) {
    Vector largest[2][2][kPacks];
    for (int p = 0; p < kPacks; ++p) {
      Vector windows[2][2];
      largest_sums(scratch, tile, p, windows);
      for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) largest[y][x][p] = windows[y][x];
      }
    }
    for (int p = 0; p < kPacks; p += Ops::kPooled) {
      const int c = p * kLanes;
      const auto rounding = Pool::rounding(shift + c);
      const auto first = Pool::load(start + c);
      for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
          const auto sums = Pool::add(Ops::sums(largest[y][x] + p), first);
          Pool::store(Pool::requantize(sums, rounding), out + y * out_row + x * channels + c);
        }
      }
    }
  }

  static void convolve(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out, int out_row,
                       std::int32_t* memory) {
    static_assert(sizeof(Scratch) <= kPooledConvolutionScratch * sizeof(std::int32_t));
    Scratch& scratch = *reinterpret_cast<Scratch*>(memory);
    transform_image(shape, in, scratch.inputs);
    const int side = shape.columns() / kTile, tiles = side * side;
    const int column_step = shape.channels_in * shape.channels_out;
    for (int c = 0; c < shape.channels_out; c += kChannels) {
      for (int next = 0; next < tiles; next += kBatch) {
        const int first = min(next, tiles - kBatch);
        for (int chunk = 0; chunk < shape.channels_in; chunk += kChunk) {
          if (next == 0 || shape.channels_in > kChunk) {
            transform_filters(weights + chunk * shape.channels_out + c * kGroup, shape.channels_out,
                              column_step, scratch);
          }
          const std::int32_t* const inputs = scratch.inputs + (first * shape.channels_in + chunk) / 2;
          if (chunk == 0) {
            multiply_batch<true>(shape, inputs, scratch);
          } else {
            multiply_batch<false>(shape, inputs, scratch);
          }
        }
        for (int t = 0; t < kBatch; ++t) {
          const int y = (first + t) / side, x = (first + t) - y * side;
          pool_tile(scratch, t, start + c, shift + c, shape.channels_out,
                    out + 2 * (y * out_row + x * shape.channels_out) + c, out_row);
        }
      }
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
