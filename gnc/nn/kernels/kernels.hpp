// Kernels: the inner loops of the network, one table per instruction set and numerics.
#pragma once

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
};

// The kernels for `set`; nullptr if there are none for this numerics, in this build or on this processor.
template <class N>
const Kernels<N>* kernels_on(InstructionSet set);
// The fastest kernels that this build contains and this processor runs.
template <class N>
const Kernels<N>& fastest_kernels();

}  // namespace tumblesight::gnc
