// Kernels: the inner loops of the network for one instruction set each.
#pragma once

#include <cstdint>

#include "gnc/nn/numerics.hpp"
#include "gnc/nn/product.hpp"
#include "gnc/numerics/instruction_set.hpp"

namespace tumblesight::gnc {

// `sums`: two rows of `columns` pixels; `out`: columns / 2 pixels, of each 2x2 window's sums the largest,
// activated, or the four activated and then averaged (activate_four()). `channels` a multiple of
// kIntegerChannels in both numerics.
template <class N>
using MaxPool = void(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift,
                     ConvInput<N>* out);
template <class N>
using AveragePool = void(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift,
                         DenseInput<N>* out);

template <class N>
struct Kernels {
  InstructionSet set;
  int pixels;  // that a convolution computes together; a row of a multiple of them is as cheap alone as with
               // others
  Product<typename N::ConvProduct>* convolve;
  Product<typename N::DenseProduct>* multiply;
  MaxPool<N>* max_pool;
  AveragePool<N>* average_pool;
};

// nullptr where this numerics has no kernels of the set, or this build or this processor lacks it.
template <class N>
const Kernels<N>* kernels_on(InstructionSet set);
template <class N>
const Kernels<N>& fastest_kernels();

}  // namespace tumblesight::gnc
