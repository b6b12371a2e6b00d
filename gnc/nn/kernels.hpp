// Kernels: the inner loops of the network for one instruction set each. All sets give the same bits; they differ
// in speed only. On a target the build decides which exist, on a desktop the processor that is found.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/nn/numerics.hpp"
#include "gnc/nn/product.hpp"

namespace tumblesight::gnc {

enum class InstructionSet : std::uint8_t {
  kPortable,  // plain C++, every processor
  k128Bit,    // float32: SSE2 or NEON; fixed point: NEON
  kDotProduct,  // fixed point: Arm's 8-bit dot product
  kDsp,         // fixed point: the dual 16-bit multiply-accumulate of Cortex-M and Cortex-R
  kAvx2,
  kAvxVnni,     // fixed point
  kAvx512,      // float32
  kAvx512Vnni,  // fixed point
};
inline constexpr std::array<InstructionSet, 8> kInstructionSets{
    InstructionSet::kPortable, InstructionSet::k128Bit,  InstructionSet::kDotProduct, InstructionSet::kDsp,
    InstructionSet::kAvx2,     InstructionSet::kAvxVnni, InstructionSet::kAvx512,     InstructionSet::kAvx512Vnni};
const char* to_string(InstructionSet set);

// `sums`: two rows of `columns` pixels; `out`: columns / 2 pixels, each the largest of a 2x2 window's sums,
// activated.
template <class N>
using MaxPool = void(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift, ConvInput<N>* out);

template <class N>
struct Kernels {
  InstructionSet set;
  Product<typename N::ConvProduct>* convolve;
  Product<typename N::DenseProduct>* multiply;
  MaxPool<N>* max_pool;
};

// nullptr where this numerics has no kernels of the set, or this build or this processor lacks it.
template <class N>
const Kernels<N>* kernels_on(InstructionSet set);
template <class N>
const Kernels<N>& fastest_kernels();

}  // namespace tumblesight::gnc
