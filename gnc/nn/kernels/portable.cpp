#include "gnc/nn/kernels/scalar.hpp"
#include "gnc/nn/kernels/sets.hpp"

namespace tumblesight::gnc::kernels {
namespace {

template <class Kind>
void product(const ProductShape& shape, const typename Kind::Input* in, const typename Kind::Sum* start,
             const typename Kind::Weight* weights, typename Kind::Sum* out) {
  Blocks<Scalar<Kind>>::template product<2, 4, 8>(shape, in, start, weights, out);
}

template <class N>
void max_pool(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift, ConvInput<N>* out) {
  pool<N, LargestOfFour<N>>(sums, columns, channels, shift, out);
}
template <class N>
void average_pool(const Sum<N>* sums, int columns, int channels, const std::uint8_t* shift, DenseInput<N>* out) {
  pool<N, MeanOfFour<N>>(sums, columns, channels, shift, out);
}

}  // namespace

const Kernels<FixedPoint> kFixedPortable{InstructionSet::kPortable, product<Int8Product>, product<Int16Product>,
                                         max_pool<FixedPoint>, average_pool<FixedPoint>};
#if TUMBLESIGHT_FLOAT32
const Kernels<Float32> kFloatPortable{InstructionSet::kPortable, product<Float32Product>, product<Float32Product>,
                                      max_pool<Float32>, average_pool<Float32>};
#endif

}  // namespace tumblesight::gnc::kernels
