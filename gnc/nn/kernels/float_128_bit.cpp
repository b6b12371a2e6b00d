// SSE2 on x86-64, NEON on AArch64: both are part of the base instruction set.
#include "gnc/nn/kernels/float_vectors.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

#if defined(__aarch64__)
constexpr int kPixels = 6, kPacks = 4, kSinglePacks = 12;  // 32 registers
#else
constexpr int kPixels = 3, kPacks = 4, kSinglePacks = 8;  // 16 registers; a value takes two instructions
#endif

void multiply(const ProductShape& shape, const float* in, const float* start, const float* weights,
              float* out) {
  float_product<4, kPixels, kPacks, kSinglePacks>(shape, in, start, weights, out);
}
void max_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, MaxPooling<Float32>>(sums, columns, channels, shift, out);
}
void average_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, AveragePooling<Float32>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<Float32> kFloat128Bit{
    InstructionSet::k128Bit, kPixels, multiply, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
