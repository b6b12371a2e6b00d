// Vectors of floats of any width, with the vector extension of GCC and clang.
#pragma once

#include "gnc/nn/kernels/scalar.hpp"

namespace tumblesight::gnc {
namespace {

// One specialization per width, since GCC 12 ignores a vector size that depends on a template parameter.
template <int kWidth>
struct VectorOf;
template <>
struct VectorOf<4> {
  typedef float Type __attribute__((vector_size(16)));
};
template <>
struct VectorOf<8> {
  typedef float Type __attribute__((vector_size(32)));
};
template <>
struct VectorOf<16> {
  typedef float Type __attribute__((vector_size(64)));
};

template <int kVectorWidth>
struct FloatVectors {
  using Kind = Float32Product;
  static constexpr int kWidth = kVectorWidth;
  using Sums = typename VectorOf<kWidth>::Type;
  using Weights = Sums;
  using Values = float;
  // Unaligned access to floats as a vector. A packed struct, because clang 14 drops the alignment attribute
  // of a vector typedef that is passed through a template.
  struct __attribute__((packed, aligned(alignof(float)), may_alias)) InMemory {
    Sums vector;
  };
  TUMBLESIGHT_INLINE Sums load(const float* from) { return reinterpret_cast<const InMemory*>(from)->vector; }
  TUMBLESIGHT_INLINE void store(Sums sum, float* to) { reinterpret_cast<InMemory*>(to)->vector = sum; }
  TUMBLESIGHT_INLINE Weights weights(const float* from) { return load(from); }
  TUMBLESIGHT_INLINE Values values(const float* from) { return *from; }
  TUMBLESIGHT_INLINE void add(Sums& sum, Values value, Weights weight) { sum += weight * value; }
};

// The channels from `first` on, one at a time.
TUMBLESIGHT_INLINE void remaining_channels(const ProductShape& shape, int first, const float* in,
                                           const float* start, const float* weights, float* out) {
  for (int c = first; c < shape.channels; ++c) {
    Blocks<Scalar<Float32Product>>::all_pixels<1, 1>(shape, c, in, start, weights, out);
  }
}

template <int kWidth, int kPixels, int kPacks, int kSinglePacks>
TUMBLESIGHT_INLINE void float_product(const ProductShape& shape, const float* in, const float* start,
                                      const float* weights, float* out) {
  const int done = Blocks<FloatVectors<kWidth>>::template product<kPixels, kPacks, kSinglePacks>(
      shape, in, start, weights, out);
  remaining_channels(shape, done, in, start, weights, out);
}

}  // namespace
}  // namespace tumblesight::gnc
