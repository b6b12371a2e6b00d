#include "gnc/nn/sliding_product.hpp"

#include <initializer_list>

#define TUMBLESIGHT_INLINE [[gnu::always_inline]] inline

#if defined(__x86_64__)
#define TUMBLESIGHT_X86_VECTORS 1
#else
#define TUMBLESIGHT_X86_VECTORS 0
#endif
#if defined(__x86_64__) || defined(__aarch64__)
#define TUMBLESIGHT_128_BIT_VECTORS 1
#else
#define TUMBLESIGHT_128_BIT_VECTORS 0
#endif

namespace tumblesight::gnc {
namespace {

// A pack holds one pixel's sums of kWidth neighbouring output channels. GCC's and clang's vector extension
// keeps the kernel readable; a pack of one float is the plain scalar kernel. Each width is written out, since
// GCC 12 ignores a vector size that depends on a template parameter.
template <int kWidth>
struct PackOf;
template <>
struct PackOf<1> {
  typedef float Type;
};
template <>
struct PackOf<4> {
  typedef float Type __attribute__((vector_size(16)));
};
template <>
struct PackOf<8> {
  typedef float Type __attribute__((vector_size(32)));
};
template <>
struct PackOf<16> {
  typedef float Type __attribute__((vector_size(64)));
};
template <int kWidth>
using Pack = typename PackOf<kWidth>::Type;

// Floats in memory seen as a pack. It need not be aligned as one: a packed struct, because clang 14 forgets
// the alignment of a vector typedef on its way through a template.
template <int kWidth>
struct __attribute__((packed, aligned(alignof(float)), may_alias)) PackInMemory {
  Pack<kWidth> pack;
};
static_assert(sizeof(PackInMemory<16>) == 64 && alignof(PackInMemory<16>) == alignof(float));

template <int kWidth>
TUMBLESIGHT_INLINE const PackInMemory<kWidth>& at(const float* address) {
  return *reinterpret_cast<const PackInMemory<kWidth>*>(address);
}
template <int kWidth>
TUMBLESIGHT_INLINE PackInMemory<kWidth>& at(float* address) {
  return *reinterpret_cast<PackInMemory<kWidth>*>(address);
}

// kPixels pixels times kPacks packs of channels, with every sum in a register. `in` and `out` hold a pointer
// for each pixel; start, weights and out point at the block's first channel.
template <int kWidth, int kPixels, int kPacks>
TUMBLESIGHT_INLINE void block(const SlidingProductShape& shape, const float* const* in, const float* start,
                              const float* weights, float* const* out) {
  Pack<kWidth> sum[kPixels][kPacks];
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 16
    for (int c = 0; c < kPacks; ++c) sum[p][c] = at<kWidth>(start + c * kWidth).pack;
  }
  for (int strip = 0; strip < shape.strips; ++strip) {
    const int offset = strip * shape.strip_step;
    for (int i = 0; i < shape.strip_length; ++i, weights += shape.channels) {
      Pack<kWidth> weight[kPacks];
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) weight[c] = at<kWidth>(weights + c * kWidth).pack;
#pragma GCC unroll 16
      for (int p = 0; p < kPixels; ++p) {
        const float value = in[p][offset + i];
#pragma GCC unroll 16
        for (int c = 0; c < kPacks; ++c) sum[p][c] += weight[c] * value;
      }
    }
  }
#pragma GCC unroll 16
  for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 16
    for (int c = 0; c < kPacks; ++c) at<kWidth>(out[p] + c * kWidth).pack = sum[p][c];
  }
}

// Every pixel of `shape`, for channels [first_channel, first_channel + kPacks * kWidth). The last block of
// pixels is moved back to end at the last pixel; what it does again comes out the same.
template <int kWidth, int kPixels, int kPacks>
TUMBLESIGHT_INLINE void all_pixels(const SlidingProductShape& shape, int first_channel, const float* in,
                                   const float* start, const float* weights, float* out) {
  const int pixels = shape.rows * shape.columns;
  for (int next = 0; next < pixels; next += kPixels) {
    const int first = next + kPixels <= pixels ? next : pixels - kPixels;
    const float* block_in[kPixels];
    float* block_out[kPixels];
    for (int p = 0; p < kPixels; ++p) {
      const int y = (first + p) / shape.columns;
      const int x = (first + p) % shape.columns;
      block_in[p] = in + y * shape.row_step + x * shape.column_step;
      block_out[p] = out + (first + p) * shape.channels + first_channel;
    }
    block<kWidth, kPixels, kPacks>(shape, block_in, start + first_channel, weights + first_channel,
                                   block_out);
  }
}

// Blocks of kPacks packs as far as they fit, then single packs, then single channels.
template <int kWidth, int kPixels, int kPacks>
TUMBLESIGHT_INLINE void all_channels(const SlidingProductShape& shape, const float* in, const float* start,
                                     const float* weights, float* out) {
  int c = 0;
  for (; c + kPacks * kWidth <= shape.channels; c += kPacks * kWidth) {
    all_pixels<kWidth, kPixels, kPacks>(shape, c, in, start, weights, out);
  }
  for (; c + kWidth <= shape.channels; c += kWidth) {
    all_pixels<kWidth, kPixels, 1>(shape, c, in, start, weights, out);
  }
  for (; c < shape.channels; ++c) all_pixels<1, kPixels, 1>(shape, c, in, start, weights, out);
}

// Blocks of kPixels x kPacks where there are that many pixels, one pixel and kSinglePacks packs where there
// are not.
template <int kWidth, int kPixels, int kPacks, int kSinglePacks>
TUMBLESIGHT_INLINE void product(const SlidingProductShape& shape, const float* in, const float* start,
                                const float* weights, float* out) {
  if (shape.rows * shape.columns >= kPixels) {
    all_channels<kWidth, kPixels, kPacks>(shape, in, start, weights, out);
  } else {
    all_channels<kWidth, 1, kSinglePacks>(shape, in, start, weights, out);
  }
}

// Block sizes follow the number of registers: kPixels * kPacks sums, kPacks weights and one value.
using Product = void(const SlidingProductShape& shape, const float* in, const float* start,
                     const float* weights, float* out);

void product_scalar(const SlidingProductShape& shape, const float* in, const float* start,
                    const float* weights, float* out) {
  product<1, 4, 4, 16>(shape, in, start, weights, out);
}

#if TUMBLESIGHT_128_BIT_VECTORS
void product_128_bit(const SlidingProductShape& shape, const float* in, const float* start,
                     const float* weights, float* out) {
  constexpr bool kManyRegisters = !TUMBLESIGHT_X86_VECTORS;  // 32 on AArch64, 16 on x86-64
  product<4, 6, kManyRegisters ? 4 : 2, kManyRegisters ? 12 : 8>(shape, in, start, weights, out);
}
#endif

#if TUMBLESIGHT_X86_VECTORS
[[gnu::target("avx2")]] void product_avx2(const SlidingProductShape& shape, const float* in,
                                          const float* start, const float* weights, float* out) {
  product<8, 6, 2, 8>(shape, in, start, weights, out);
}

[[gnu::target("avx512f")]] void product_avx512(const SlidingProductShape& shape, const float* in,
                                               const float* start, const float* weights, float* out) {
  if (shape.channels % 64 == 0) {
    product<16, 6, 4, 12>(shape, in, start, weights, out);
  } else if (shape.channels % 48 == 0) {
    product<16, 9, 3, 12>(shape, in, start, weights, out);
  } else {
    product<16, 12, 2, 12>(shape, in, start, weights, out);
  }
}
#endif

// nullptr: this build or this processor lacks the unit.
Product* kernel(VectorUnit unit) {
#if TUMBLESIGHT_X86_VECTORS
  if (unit == VectorUnit::kAvx512) return __builtin_cpu_supports("avx512f") != 0 ? product_avx512 : nullptr;
  if (unit == VectorUnit::kAvx2) return __builtin_cpu_supports("avx2") != 0 ? product_avx2 : nullptr;
#endif
#if TUMBLESIGHT_128_BIT_VECTORS
  if (unit == VectorUnit::k128Bit) return product_128_bit;
#endif
  return unit == VectorUnit::kScalar ? product_scalar : nullptr;
}

}  // namespace

bool is_available(VectorUnit unit) {
  return kernel(unit) != nullptr;
}

VectorUnit widest_vector_unit() {
  for (const VectorUnit unit : {VectorUnit::kAvx512, VectorUnit::kAvx2, VectorUnit::k128Bit}) {
    if (is_available(unit)) return unit;
  }
  return VectorUnit::kScalar;
}

void sliding_product(const SlidingProductShape& shape, const float* in, const float* start,
                     const float* weights, float* out) {
  kernel(widest_vector_unit())(shape, in, start, weights, out);
}

void sliding_product_on(VectorUnit unit, const SlidingProductShape& shape, const float* in,
                        const float* start, const float* weights, float* out) {
  kernel(unit)(shape, in, start, weights, out);
}

}  // namespace tumblesight::gnc
