// The loops around the innermost operations of an instruction set: blocks of pixels and channels whose sums
// are all in registers. One source file per instruction set includes this file and is compiled for that set.
// No code may be shared between the sets, so everything here has internal linkage.
#pragma once

#include "gnc/nn/kernels/numerics.hpp"
#include "gnc/nn/kernels/product.hpp"

#define TUMBLESIGHT_INLINE [[gnu::always_inline]] static inline

namespace tumblesight::gnc {
namespace {

// Ops defines the vector operations: the Kind of product, kWidth (output channels per vector), the types
// Sums, Weights and Values, and
//   Sums load(const Sum*), void store(Sums, Sum*)   kWidth sums
//   Weights weights(const Weight*)                  kGroup weights of each of kWidth channels
//   Values values(const Input*)                     kGroup inputs of one pixel
//   void add(Sums&, Values, Weights)                adds the products of the group to the sum of each channel
template <class Ops>
struct Blocks {
  using Kind = typename Ops::Kind;
  using Input = typename Kind::Input;
  using Weight = typename Kind::Weight;
  using Sum = typename Kind::Sum;
  static constexpr int kGroup = Kind::kGroup;
  static constexpr int kWidth = Ops::kWidth;

  // One block: kPixels pixels and kPacks vectors of channels. `in` and `out` hold a pointer per pixel.
  // `start`, `weights` and `out` point to the first channel of the block.
  template <int kPixels, int kPacks>
  TUMBLESIGHT_INLINE void block(const ProductShape& shape, const Input* const* in, const Sum* start,
                                const Weight* weights, Sum* const* out) {
    typename Ops::Sums sum[kPixels][kPacks];
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) sum[p][c] = Ops::load(start + c * kWidth);
    }
    for (int strip = 0; strip < shape.strips; ++strip) {
      const int offset = strip * shape.strip_step;
      for (int i = 0; i < shape.strip_length; i += kGroup, weights += shape.channels * kGroup) {
        typename Ops::Weights weight[kPacks];
#pragma GCC unroll 16
        for (int c = 0; c < kPacks; ++c) weight[c] = Ops::weights(weights + c * kWidth * kGroup);
#pragma GCC unroll 16
        for (int p = 0; p < kPixels; ++p) {
          const typename Ops::Values value = Ops::values(in[p] + offset + i);
#pragma GCC unroll 16
          for (int c = 0; c < kPacks; ++c) Ops::add(sum[p][c], value, weight[c]);
        }
      }
    }
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) Ops::store(sum[p][c], out[p] + c * kWidth);
    }
  }

  // All pixels of `shape` for channels [first_channel, first_channel + kPacks * kWidth). The last block is
  // moved back to end at the last pixel; the pixels that it computes a second time get the same values.
  template <int kPixels, int kPacks>
  TUMBLESIGHT_INLINE void all_pixels(const ProductShape& shape, int first_channel, const Input* in,
                                     const Sum* start, const Weight* weights, Sum* out) {
    const int pixels = shape.rows * shape.columns;
    for (int next = 0; next < pixels; next += kPixels) {
      const int first = min(next, pixels - kPixels);
      const Input* block_in[kPixels];
      Sum* block_out[kPixels];
      const int y = first / shape.columns;
      int x = first - y * shape.columns;
      const Input* pixel = in + y * shape.row_step + x * shape.column_step;
      for (int p = 0; p < kPixels; ++p) {
        block_in[p] = pixel;
        block_out[p] = out + (first + p) * shape.channels + first_channel;
        const bool row_ends = ++x == shape.columns;
        x = row_ends ? 0 : x;
        pixel += row_ends ? shape.row_step - (shape.columns - 1) * shape.column_step : shape.column_step;
      }
      block<kPixels, kPacks>(shape, block_in, start + first_channel, weights + first_channel * kGroup,
                             block_out);
    }
  }

  // Integer products have a multiple of kIntegerChannels channels, so no single vectors remain.
  template <int kPacks>
  static constexpr bool kFillBlocks = kGroup > 1 && kIntegerChannels % (kPacks * kWidth) == 0;

  // Blocks of kPacks vectors as far as they fit, then single vectors. Returns the first channel that is not
  // computed.
  template <int kPixels, int kPacks>
  TUMBLESIGHT_INLINE int all_channels(const ProductShape& shape, const Input* in, const Sum* start,
                                      const Weight* weights, Sum* out) {
    int c = 0;
    for (; c + kPacks * kWidth <= shape.channels; c += kPacks * kWidth) {
      all_pixels<kPixels, kPacks>(shape, c, in, start, weights, out);
    }
    if constexpr (!kFillBlocks<kPacks>) {
      for (; c + kWidth <= shape.channels; c += kWidth)
        all_pixels<kPixels, 1>(shape, c, in, start, weights, out);
    }
    return c;
  }

  // The product: blocks of kPixels pixels and kPacks vectors, or of one pixel and kSinglePacks vectors if
  // there are fewer pixels. A block needs kPixels * kPacks registers for sums, kPacks for weights and one for
  // a value. Returns the first channel that is not computed.
  template <int kPixels, int kPacks, int kSinglePacks>
  TUMBLESIGHT_INLINE int product(const ProductShape& shape, const Input* in, const Sum* start,
                                 const Weight* weights, Sum* out) {
    return shape.rows * shape.columns >= kPixels
               ? all_channels<kPixels, kPacks>(shape, in, start, weights, out)
               : all_channels<1, kSinglePacks>(shape, in, start, weights, out);
  }
};

// Pooling, in loops of a constant length that the compiler vectorizes for the instruction set.
template <class N>
struct MaxPooling {
  using Out = ConvInput<N>;
  TUMBLESIGHT_INLINE void pool(const Sum<N> (&four)[4], int shift, Out& out) {
    activate(max_conv_sum(max_conv_sum(four[0], four[1]), max_conv_sum(four[2], four[3])), shift, out);
  }
};
template <class N>
struct AveragePooling {
  using Out = DenseInput<N>;
  TUMBLESIGHT_INLINE void pool(const Sum<N> (&four)[4], int shift, Out& out) {
    activate_and_average(four, shift, out);
  }
};

template <class N, class Pool>
TUMBLESIGHT_INLINE void pool_channels(const Sum<N>* __restrict left, int channels, int row_below,
                                      const std::uint8_t* __restrict shift,
                                      typename Pool::Out* __restrict out) {
  const Sum<N>* const right = left + channels;
  for (int c = 0; c < kIntegerChannels; ++c) {
    const Sum<N> four[4] = {left[c], right[c], left[row_below + c], right[row_below + c]};
    Pool::pool(four, N::kIsInteger ? shift[c] : 0, out[c]);
  }
}

// Pointer to the shift of `channel`. Floats have no shifts: arithmetic on a null pointer is undefined.
template <class N>
TUMBLESIGHT_INLINE const std::uint8_t* shift_of(const std::uint8_t* shift, int channel) {
  return N::kIsInteger ? shift + channel : nullptr;
}

template <class N, class Pool>
TUMBLESIGHT_INLINE void pool(const Sum<N>* __restrict sums, int columns, int channels,
                             const std::uint8_t* __restrict shift, typename Pool::Out* __restrict out) {
  for (int x = 0; x + 1 < columns; x += 2) {
    const Sum<N>* const left = sums + x * channels;
    for (int c = 0; c < channels; c += kIntegerChannels) {
      pool_channels<N, Pool>(left + c, channels, columns * channels, shift_of<N>(shift, c), out + c);
    }
    out += channels;
  }
}

}  // namespace
}  // namespace tumblesight::gnc
