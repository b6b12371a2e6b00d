#include "gnc/nn/kernels/chunked_convolution.hpp"
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

// With 64-bit registers, two pixels per register: (x0 + 2^32 x1) times a weight updates two sums at once. A
// negative low sum borrows from the high one; high_half() undoes that at the end.
struct PixelPairs {
  static constexpr int kPairs = 2;
  static constexpr int kPixels = 2 * kPairs;
  static constexpr int kChannels = 8;
  static constexpr int kChunkGroups = 18;
  using Group = std::array<std::array<std::uint64_t, kPairs>, Int8Product::kGroup>;

  TUMBLESIGHT_INLINE std::uint64_t pack_pair(std::int32_t low, std::int32_t high) {
    return static_cast<std::uint64_t>(low) + (static_cast<std::uint64_t>(high) << 32);
  }
  TUMBLESIGHT_INLINE std::int32_t low_half(std::uint64_t pair) { return static_cast<std::int32_t>(pair); }
  TUMBLESIGHT_INLINE std::int32_t high_half(std::uint64_t pair) {
    return static_cast<std::int32_t>((pair - static_cast<std::uint64_t>(low_half(pair))) >> 32);
  }

  TUMBLESIGHT_INLINE void prepare(const std::uint8_t* const (&in)[kPixels], int offset, Group& group) {
#pragma GCC unroll 2
    for (int p = 0; p < kPairs; ++p) {
#pragma GCC unroll 4
      for (int i = 0; i < Int8Product::kGroup; ++i) {
        group[i][p] = pack_pair(in[2 * p][offset + i], in[2 * p + 1][offset + i]);
      }
    }
  }

  [[gnu::noinline]] static void add(const Group* chunk, int groups, const std::int32_t* start, int start_step,
                                    const std::int8_t* weights, std::int32_t* out, int channels) {
    for (int c = 0; c < channels;
         c += kChannels, start += kChannels, out += kChannels, weights += kChannels * Int8Product::kGroup) {
      std::uint64_t sum[kPairs][kChannels];
#pragma GCC unroll 2
      for (int p = 0; p < kPairs; ++p) {
#pragma GCC unroll 8
        for (int k = 0; k < kChannels; ++k)
          sum[p][k] = pack_pair(start[2 * p * start_step + k], start[(2 * p + 1) * start_step + k]);
      }
      const std::int8_t* weight = weights;
      for (const Group* group = chunk; group != chunk + groups;
           ++group, weight += channels * Int8Product::kGroup) {
#pragma GCC unroll 4
        for (int i = 0; i < Int8Product::kGroup; ++i) {
#pragma GCC unroll 8
          for (int k = 0; k < kChannels; ++k) {
            const auto factor = static_cast<std::uint64_t>(std::int64_t{weight[k * Int8Product::kGroup + i]});
#pragma GCC unroll 2
            for (int p = 0; p < kPairs; ++p) sum[p][k] += (*group)[i][p] * factor;
          }
          asm volatile("" ::: "memory");  // keeps later loads from moving up: registers are few
        }
      }
#pragma GCC unroll 2
      for (int p = 0; p < kPairs; ++p) {
#pragma GCC unroll 8
        for (int k = 0; k < kChannels; ++k) {
          out[2 * p * channels + k] = low_half(sum[p][k]);
          out[(2 * p + 1) * channels + k] = high_half(sum[p][k]);
        }
      }
    }
  }
};

constexpr bool kHas64Bits = sizeof(void*) == 8;

void convolve(const ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  if (kHas64Bits && shape.rows * shape.columns >= PixelPairs::kPixels) {
    ChunkedConvolution<PixelPairs>::product(shape, in, start, weights, out);
  } else if (!kHas64Bits && Winograd::supports(shape)) {
    Winograd::convolve(shape, in, start, weights, out);
  } else {
    product<Int8Product>(shape, in, start, weights, out);
  }
}
constexpr int kConvolvedPixels = kHas64Bits ? PixelPairs::kPixels : Winograd::kPixels;

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

const Kernels<FixedPoint> kFixedPortable{
    InstructionSet::kPortable, kConvolvedPixels,     convolve,
    product<Int16Product>,     max_pool<FixedPoint>, average_pool<FixedPoint>};
#if TUMBLESIGHT_FLOAT32
const Kernels<Float32> kFloatPortable{InstructionSet::kPortable, 2,
                                      product<Float32Product>,   product<Float32Product>,
                                      max_pool<Float32>,         average_pool<Float32>};
#endif

}  // namespace tumblesight::gnc::kernels
