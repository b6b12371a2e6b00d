#include "gnc/nn/kernels/scalar.hpp"
#include "gnc/nn/kernels/sets.hpp"
#include "gnc/nn/kernels/winograd.hpp"

namespace tumblesight::gnc::kernels {
namespace {

template <class Kind>
void product(const ProductShape& shape, const typename Kind::Input* in, const typename Kind::Sum* start,
             const typename Kind::Weight* weights, typename Kind::Sum* out) {
  Blocks<Scalar<Kind>>::template product<2, 4, 8>(shape, in, start, weights, out);
}
// Only for shapes without a pooled convolution.
void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  Blocks<Scalar<Int8Product>>::all_channels<1, 1>(shape, in, start, weights, out);
}

// Without vectors, for WinogradImage.
struct OneByOne {
  using Pairs = gnc::Pairs;
  static constexpr int kTiles = 3, kChannels = 4, kPair = 2;

  // Each product is added after the next one is begun, so that the addition does not wait for it. The empty
  // assembly statements keep this order. Without them the compiler also runs out of registers.
  TUMBLESIGHT_INLINE void add_products(const std::int16_t* in, const std::int16_t* weights,
                                       std::uint32_t (&sum)[kTiles][kChannels]) {
    std::int32_t value[kTiles];
#pragma GCC unroll 3
    for (int t = 0; t < kTiles; ++t) value[t] = in[t * kPair];
    std::int32_t product = 0;
#pragma GCC unroll 4
    for (int c = 0; c < kChannels; ++c) {
      const std::int32_t weight = weights[c * kPair];
#pragma GCC unroll 3
      for (int t = 0; t < kTiles; ++t) {
        std::int32_t next = value[t] * weight;
        asm volatile("" : "+r"(next));
        if (c + t > 0) add_to(t > 0 ? sum[t - 1][c] : sum[kTiles - 1][c - 1], product);
        product = next;
      }
    }
    add_to(sum[kTiles - 1][kChannels - 1], product);
  }
  TUMBLESIGHT_INLINE void add_to(std::uint32_t& sum, std::int32_t product) {
    sum += static_cast<std::uint32_t>(product);
    asm volatile("" : "+r"(sum));
  }

  template <bool kFirst>
  TUMBLESIGHT_INLINE void multiply_add(const std::int16_t* in, const std::int16_t* weights, int count,
                                       std::uint32_t* sums) {
    std::uint32_t sum[kTiles][kChannels];
#pragma GCC unroll 3
    for (int t = 0; t < kTiles; ++t) {
#pragma GCC unroll 4
      for (int c = 0; c < kChannels; ++c) sum[t][c] = kFirst ? 0 : sums[t * kChannels + c];
    }
    const std::int16_t* const end = in + count * kTiles * kPair;
    for (; in != end; in += kTiles * kPair, weights += kChannels * kPair) {
#pragma GCC unroll 2
      for (int n = 0; n < kPair; ++n) add_products(in + n, weights + n, sum);
    }
#pragma GCC unroll 3
    for (int t = 0; t < kTiles; ++t) {
#pragma GCC unroll 4
      for (int c = 0; c < kChannels; ++c) sums[t * kChannels + c] = sum[t][c];
    }
  }
};

template <class N>
void max_pool(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift, ConvInput<N>* out) {
  pool<N, MaxPooling<N>>(sums, columns, channels, shift, out);
}
template <class N>
void average_pool(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift,
                  DenseInput<N>* out) {
  pool<N, AveragePooling<N>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedPortable{InstructionSet::kPortable,
                                         1,
                                         convolve,
                                         product<Int16Product>,
                                         max_pool<FixedPoint>,
                                         average_pool<FixedPoint>,
                                         winograd_convolution<OneByOne, MaxPooling<FixedPoint>>,
                                         winograd_convolution<OneByOne, AveragePooling<FixedPoint>>};
#if TUMBLESIGHT_FLOAT32
const Kernels<Float32> kFloatPortable{InstructionSet::kPortable, 2,
                                      product<Float32Product>,   product<Float32Product>,
                                      max_pool<Float32>,         average_pool<Float32>};
#endif

}  // namespace tumblesight::gnc::kernels
