#include "gnc/nn/kernels/float_vectors.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

void multiply(const ProductShape& shape, const float* in, const float* start, const float* weights,
              float* out) {
  if (shape.channels % 64 == 0) {
    float_product<16, 6, 4, 12>(shape, in, start, weights, out);
  } else if (shape.channels % 48 == 0) {
    float_product<16, 6, 3, 12>(shape, in, start, weights, out);
  } else {
    float_product<16, 12, 2, 12>(shape, in, start, weights, out);
  }
}
void max_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, MaxPooling<Float32>>(sums, columns, channels, shift, out);
}
void average_pool(const float* sums, int columns, int channels, const std::uint8_t* shift, float* out) {
  pool<Float32, AveragePooling<Float32>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<Float32> kFloatAvx512{InstructionSet::kAvx512, 6, multiply, multiply, max_pool, average_pool};

}  // namespace tumblesight::gnc::kernels
