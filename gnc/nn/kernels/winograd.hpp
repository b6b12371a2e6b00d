// 3x3 convolution of a whole image with pooling by Winograd's minimal filters, for processors without
// vectors: a quarter of the multiplications. Included by the source files of the instruction sets, like
// blocks.hpp.
//
// The inputs of a batch of tiles are transformed and stay in memory. For a few output channels at a time the
// weights are transformed; then each position of a tile is a product of inputs and weights over the input
// channels; then the sums of each tile are transformed back and pooled.
#pragma once

#include <cstring>

#include "gnc/nn/kernels/kernels.hpp"
#include "gnc/nn/kernels/winograd_filters.hpp"

namespace tumblesight::gnc {
namespace {

// At a multiple of four bytes.
TUMBLESIGHT_INLINE std::uint32_t load_word(const void* from) {
  std::uint32_t word;
  std::memcpy(&word, __builtin_assume_aligned(from, sizeof word), sizeof word);
  return word;
}
TUMBLESIGHT_INLINE void store_word(std::uint32_t word, void* to) {
  std::memcpy(__builtin_assume_aligned(to, sizeof word), &word, sizeof word);
}

// Arithmetic of numbers modulo 2^32, for the filters.
struct Words32 {
  TUMBLESIGHT_INLINE std::uint32_t add(std::uint32_t a, std::uint32_t b) { return a + b; }
  TUMBLESIGHT_INLINE std::uint32_t sub(std::uint32_t a, std::uint32_t b) { return a - b; }
  template <int kBits>
  TUMBLESIGHT_INLINE std::uint32_t shift(std::uint32_t a) {
    return a << kBits;
  }
};

// The same of two 16-bit numbers in one register: low + 2^16 high, modulo 2^32. A negative low number borrows
// from the high one until it is stored.
struct Pairs : Words32 {
  static constexpr std::uint32_t kLowBytes = 0x00FF00FF, kSigns = 0x00800080;

  // Two of four bytes at a multiple of four: `half` 0 gives two of them, 1 the other two. Which ones depends
  // on the byte order of the processor.
  TUMBLESIGHT_INLINE std::uint32_t load(const std::uint8_t* from, int half) {
    return (load_word(from) >> (8 * half)) & kLowBytes;
  }
  TUMBLESIGHT_INLINE std::uint32_t load(const std::int8_t* from, int half) {
    return (((load_word(from) >> (8 * half)) & kLowBytes) ^ kSigns) - kSigns;
  }
  TUMBLESIGHT_INLINE void store(std::uint32_t pair, std::int16_t* to) {
    store_word(pair + ((pair & 0x8000U) << 1), to);
  }
};

// Ops defines
//   Pairs               arithmetic for inputs and weights, with the functions of Pairs above
//   kTiles, kChannels   tiles and output channels whose sums are in registers together
//   void multiply_add<kFirst>(const std::int16_t* inputs, const std::int16_t* weights, int count,
//                             std::uint32_t* sums)
//     sums[t][c] = (kFirst ? 0 : sums[t][c]) + sum over i < count and n < 2 of inputs[i][t][n] *
//     weights[i][c][n], modulo 2^32. `count` is even and not 0, and both pointers are multiples of
//     four bytes
template <class Ops, class Filter>
struct WinogradImage {
  static constexpr int kTile = Filter::kTile, kPatch = Filter::kPatch, kPositions = kPatch * kPatch;
  static constexpr int kTiles = Ops::kTiles, kChannels = Ops::kChannels;
  static constexpr int kGroup = Int8Product::kGroup, kHalves = 2, kPair = kGroup / kHalves;
  static constexpr int kChunk = 64 / kChannels;  // input channels whose weights are in memory together
  static constexpr int kWeights = kPositions * kChannels * kChunk;
  static_assert(kChunk % kGroup == 0 && kIntegerChannels % kChannels == 0);

  // Tiles of a row or column. The last one is moved back to end at the last pixel; the windows that it
  // computes a second time get the same values.
  static constexpr int tiles_of_row(const ImageShape& shape) { return (shape.columns() + kTile - 1) / kTile; }
  static constexpr long products(const ImageShape& shape) {
    return 1L * tiles_of_row(shape) * tiles_of_row(shape) * kPositions;
  }
  // Rows of tiles whose inputs and sums fit into the scratch memory beside the weights.
  static constexpr int rows_of_batch(const ImageShape& shape) {
    constexpr int kLeft = kPooledConvolutionScratch - kWeights / 2;
    const int group = kPositions * kTiles * (shape.channels_in / 2 + kChannels);
    return min(kLeft / group * kTiles / tiles_of_row(shape), tiles_of_row(shape));
  }
  static constexpr bool fits(const ImageShape& shape) {
    return shape.columns() >= kTile && shape.channels_in % kGroup == 0 &&
           shape.channels_in <= Filter::kMaxChannelsIn && shape.channels_out % kChannels == 0 &&
           rows_of_batch(shape) > 0;
  }

  // In the scratch memory: sums by group of tiles, position, tile and channel; weights by position, pair of
  // input channels, output channel and number in the pair; inputs by position, group of tiles, pair of input
  // channels, tile and number in the pair. The 16-bit numbers are written as bytes (store_word), and no sum
  // lies where they do.
  struct Batch {
    int first_row, tiles, groups;  // groups of kTiles tiles; the last tile fills up the last group
    std::uint32_t* sums;
    std::int16_t *weights, *inputs;

    Batch(const ImageShape& shape, int row, std::int32_t* scratch)
        : first_row(row),
          tiles(min(rows_of_batch(shape), tiles_of_row(shape) - row) * tiles_of_row(shape)),
          groups((tiles + kTiles - 1) / kTiles),
          sums(reinterpret_cast<std::uint32_t*>(scratch)),
          weights(reinterpret_cast<std::int16_t*>(scratch + kPositions * groups * kTiles * kChannels)),
          inputs(weights + kWeights) {}
  };
  struct Place {  // of a tile: its first pixel
    int y, x;
  };
  static Place place_of(const ImageShape& shape, const Batch& batch, int tile) {
    const int row = tile / tiles_of_row(shape), last = shape.columns() - kTile;
    return {min(kTile * (batch.first_row + row), last),
            min(kTile * (tile - row * tiles_of_row(shape)), last)};
  }

  // One tile and pair of input channels. `step`: from one position to the next.
  TUMBLESIGHT_INLINE void transform_patch(const std::uint8_t* in, int half, int row, int column, int step,
                                          std::int16_t* out) {
    std::uint32_t rows[kPatch][kPatch];  // by row of positions and column of inputs
#pragma GCC unroll 6
    for (int x = 0; x < kPatch; ++x) {
      std::uint32_t d[kPatch], transformed[kPatch];
#pragma GCC unroll 6
      for (int y = 0; y < kPatch; ++y) d[y] = Ops::Pairs::load(in + y * row + x * column, half);
      Filter::template inputs<typename Ops::Pairs>(d, transformed);
#pragma GCC unroll 6
      for (int u = 0; u < kPatch; ++u) rows[u][x] = transformed[u];
    }
#pragma GCC unroll 6
    for (int u = 0; u < kPatch; ++u) {
      std::uint32_t transformed[kPatch];
      Filter::template inputs<typename Ops::Pairs>(rows[u], transformed);
#pragma GCC unroll 6
      for (int v = 0; v < kPatch; ++v, out += step) Ops::Pairs::store(transformed[v], out);
    }
  }
  [[gnu::noinline]] static void transform_inputs(const ImageShape& shape, const Batch& batch,
                                                 const std::uint8_t* in) {
    const int group_step = shape.channels_in * kTiles, step = batch.groups * group_step;
    for (int t = 0; t < batch.groups * kTiles; ++t) {
      const Place place = place_of(shape, batch, min(t, batch.tiles - 1));
      const std::uint8_t* const patch = in + place.y * shape.row() + place.x * shape.channels_in;
      std::int16_t* const out = batch.inputs + t / kTiles * group_step + t % kTiles * kPair;
      for (int c = 0; c < shape.channels_in; c += kGroup) {
        for (int half = 0; half < kHalves; ++half) {
          transform_patch(patch + c, half, shape.row(), shape.channels_in, step,
                          out + (c + half * kPair) * kTiles);
        }
      }
    }
  }

  // One pair of input channels of one output channel. `step`: from one column of the filter to the next.
  static constexpr int kPositionStep = kChunk * kChannels;
  TUMBLESIGHT_INLINE void transform_filter(const std::int8_t* weights, int half, int step,
                                           std::int16_t* out) {
    std::uint32_t columns[3][kPatch];  // by row of weights and column of positions
#pragma GCC unroll 3
    for (int y = 0; y < 3; ++y) {
      std::uint32_t g[3];
#pragma GCC unroll 3
      for (int x = 0; x < 3; ++x, weights += step) g[x] = Ops::Pairs::load(weights, half);
      Filter::template weights<typename Ops::Pairs>(g, columns[y]);
    }
#pragma GCC unroll 6
    for (int v = 0; v < kPatch; ++v) {
      const std::uint32_t g[3] = {columns[0][v], columns[1][v], columns[2][v]};
      std::uint32_t transformed[kPatch];
      Filter::template weights<typename Ops::Pairs>(g, transformed);
#pragma GCC unroll 6
      for (int u = 0; u < kPatch; ++u)
        Ops::Pairs::store(transformed[u], out + (u * kPatch + v) * kPositionStep);
    }
  }
  // Of `channels` input channels and kChannels output channels.
  [[gnu::noinline]] static void transform_filters(const ImageShape& shape, const std::int8_t* weights,
                                                  int channels, std::int16_t* out) {
    const int step = shape.channels_in * shape.channels_out;
    for (int first = 0; first < channels; first += kGroup, weights += shape.channels_out * kGroup) {
      for (int half = 0; half < kHalves; ++half) {
        for (int c = 0; c < kChannels; ++c, out += kPair)
          transform_filter(weights + c * kGroup, half, step, out);
      }
    }
  }

  static constexpr int kSumStep = kTiles * kChannels;  // from one position to the next
  // The sums of all tiles of the batch and `channels` input channels, added to those before.
  template <bool kFirst>
  [[gnu::noinline]] static void multiply(const Batch& batch, const std::int16_t* inputs, int group_step,
                                         int channels) {
    const int pairs = channels / kPair, groups_step = batch.groups * kPositions * kSumStep;
    const std::int16_t* weights = batch.weights;
    for (int position = 0; position < kPositions; ++position, weights += kPositionStep) {
      std::uint32_t* sums = batch.sums + position * kSumStep;
      const std::uint32_t* const end = sums + groups_step;
      for (; sums != end; sums += kPositions * kSumStep, inputs += group_step)
        Ops::template multiply_add<kFirst>(inputs, weights, pairs, sums);
    }
  }

  // The pooled windows of one channel of a tile.
  template <class Pool>
  TUMBLESIGHT_INLINE void pool_tile(const std::uint32_t* sums, std::uint32_t start, int shift, int channels,
                                    typename Pool::Out* out, int out_row) {
    std::uint32_t half[kTile][kPatch];  // by column of sums and row of positions
#pragma GCC unroll 6
    for (int u = 0; u < kPatch; ++u) {
      std::uint32_t m[kPatch], transformed[kTile];
#pragma GCC unroll 6
      for (int v = 0; v < kPatch; ++v) m[v] = sums[(u * kPatch + v) * kSumStep];
      Filter::template sums<Words32>(m, transformed);
#pragma GCC unroll 4
      for (int x = 0; x < kTile; ++x) half[x][u] = transformed[x];
    }
    std::int32_t tile[kTile][kTile];
#pragma GCC unroll 4
    for (int x = 0; x < kTile; ++x) {
      std::uint32_t transformed[kTile];
      Filter::template sums<Words32>(half[x], transformed);
#pragma GCC unroll 4
      for (int y = 0; y < kTile; ++y)
        tile[y][x] = static_cast<std::int32_t>(
            static_cast<std::uint32_t>(Filter::unscaled(transformed[y], y, x)) + start);
    }
#pragma GCC unroll 2
    for (int y = 0; y < kTile; y += 2) {
#pragma GCC unroll 2
      for (int x = 0; x < kTile; x += 2) {
        const std::int32_t four[4] = {tile[y][x], tile[y][x + 1], tile[y + 1][x], tile[y + 1][x + 1]};
        Pool::pool(four, shift, out[y / 2 * out_row + x / 2 * channels]);
      }
    }
  }
  // kChannels channels of all tiles of the batch.
  template <class Pool>
  [[gnu::noinline]] static void pool_tiles(const ImageShape& shape, const Batch& batch,
                                           const std::int32_t* start, const std::uint8_t* shift,
                                           typename Pool::Out* out, int out_row) {
    for (int t = 0; t < batch.tiles; ++t) {
      const Place place = place_of(shape, batch, t);
      typename Pool::Out* const windows = out + place.y / 2 * out_row + place.x / 2 * shape.channels_out;
      const int group = t / kTiles;
      const std::uint32_t* const sums =
          batch.sums + group * kPositions * kSumStep + (t - group * kTiles) * kChannels;
      for (int c = 0; c < kChannels; ++c) {
        pool_tile<Pool>(sums + c, static_cast<std::uint32_t>(start[c]), shift[c], shape.channels_out,
                        windows + c, out_row);
      }
    }
  }

  template <class Pool>
  static void convolve(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                       const std::int8_t* weights, const std::uint8_t* shift, typename Pool::Out* out,
                       int out_row, std::int32_t* scratch) {
    const int group_step = shape.channels_in * kTiles;
    for (int row = 0; row < tiles_of_row(shape); row += rows_of_batch(shape)) {
      const Batch batch(shape, row, scratch);
      transform_inputs(shape, batch, in);
      for (int c = 0; c < shape.channels_out; c += kChannels) {
        for (int chunk = 0; chunk < shape.channels_in; chunk += kChunk) {
          const int channels = min(kChunk, shape.channels_in - chunk);
          transform_filters(shape, weights + chunk * shape.channels_out + c * kGroup, channels,
                            batch.weights);
          const std::int16_t* const inputs = batch.inputs + chunk * kTiles;
          if (chunk == 0) {
            multiply<true>(batch, inputs, group_step, channels);
          } else {
            multiply<false>(batch, inputs, group_step, channels);
          }
        }
        pool_tiles<Pool>(shape, batch, start + c, shift + c, out + c, out_row);
      }
    }
  }
};

// The filter that needs fewer products for the shape, the smaller one if both need the same.
template <class Ops, class Pool>
PooledConvolution<FixedPoint, typename Pool::Out>* winograd_convolution(const ImageShape& shape) {
  using Large = WinogradImage<Ops, MinimalFilter4>;
  using Small = WinogradImage<Ops, MinimalFilter2>;
  if (Large::fits(shape) && Large::products(shape) < Small::products(shape))
    return Large::template convolve<Pool>;
  return Small::fits(shape) ? Small::template convolve<Pool> : nullptr;
}

}  // namespace
}  // namespace tumblesight::gnc
