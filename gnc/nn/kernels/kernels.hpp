// Kernels: the inner loops of the network, one table per instruction set and numerics.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gnc/nn/kernels/numerics.hpp"
#include "gnc/nn/kernels/product.hpp"
#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::gnc {

// 2x2 pooling and activation of two rows of sums. MaxPool activates the largest sum of each window,
// AveragePool averages the four activations (activate_and_average() in numerics.hpp).
//
// sums      two rows of `columns` pixels of `channels` sums
// channels  a multiple of kIntegerChannels in both numerics
// shift     fixed point: a shift of 1..30 per channel; float: not used
// out       columns / 2 pixels of `channels` values
template <class N>
using MaxPool = void(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift,
                     ConvInput<N>* out);
template <class N>
using AveragePool = void(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift,
                         DenseInput<N>* out);

// A square image inside a border of one pixel of zeros, and the number of channels that a convolution turns
// its channels into.
struct ImageShape {
  int side;  // without the border
  int channels_in;
  int channels_out;

  constexpr int columns() const { return side / 2 * 2; }  // of sums: an odd last one fills no window
  constexpr int row() const { return (side + 2) * channels_in; }
};

// Memory that a pooled convolution may use, in numbers of 32 bits, and what the memory budgets allow for it
// in addition: nothing on onboard processors, where it shares the memory of the registration (WorkingMemory).
#if defined(__x86_64__)
inline constexpr int kPooledConvolutionScratch = 50 * 1024;
inline constexpr std::size_t kKernelScratchBytes = kPooledConvolutionScratch * sizeof(std::int32_t);
#else
inline constexpr int kPooledConvolutionScratch = 8 * 1024;
inline constexpr std::size_t kKernelScratchBytes = 0;
#endif

// 3x3 convolution of a whole image and pooling as by MaxPool or AveragePool, without storing all sums.
//
// in        from the first value of the border on
// start     channels_out sums
// weights   as for a Product of three strips of three pixels
// shift     1..30 per channel
// out       the first value inside the border if there is one, `out_row` values per row
// scratch   kPooledConvolutionScratch numbers, aligned to 64 bytes
template <class N, class Out>
using PooledConvolution = void(const ImageShape& shape, const ConvInput<N>* in, const Sum<N>* start,
                               const typename N::ConvProduct::Weight* weights, const std::uint8_t* shift,
                               Out* out, int out_row, std::int32_t* scratch);
template <class N>
using MaxPooledConvolution = PooledConvolution<N, ConvInput<N>>;
template <class N>
using AveragePooledConvolution = PooledConvolution<N, DenseInput<N>>;

// lstm_update() of lstm.hpp in fixed point, for a multiple of kIntegerChannels hidden units.
using LstmUpdate = void(const std::int32_t* gates, const std::uint8_t* shift, int hidden, std::int16_t* h,
                        Fixed* c);

template <class N>
struct Kernels {
  InstructionSet set;
  // Pixels that a convolution computes together. A row of a multiple of them costs the same alone as with
  // other rows.
  int pixels;
  Product<typename N::ConvProduct>* convolve;
  Product<typename N::DenseProduct>* multiply;
  MaxPool<N>* max_pool;
  AveragePool<N>* average_pool;
  // The fastest convolution with pooling of an image of this shape, nullptr if that is convolve() and
  // max_pool() or average_pool(). nullptr: it is so for every shape.
  MaxPooledConvolution<N>* (*max_pooled_convolution)(const ImageShape& shape) = nullptr;
  AveragePooledConvolution<N>* (*average_pooled_convolution)(const ImageShape& shape) = nullptr;
  // Whether convolve() skips the zeros of a shape whose columns are a multiple of `pixels`.
  bool skips_zeros = false;
  LstmUpdate* update_lstm = nullptr;  // nullptr: lstm_update()
};

// The kernels for `set`; nullptr if there are none for this numerics, in this build or on this processor.
template <class N>
const Kernels<N>* kernels_on(InstructionSet set);
// The fastest kernels that this build contains and this processor runs.
template <class N>
const Kernels<N>& fastest_kernels();

}  // namespace tumblesight::gnc
