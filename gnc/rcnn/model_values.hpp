// Range check of the tensors in a model image.
#pragma once

#include <cstdint>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

// `image` is complete. In fixed point: whether no sum of any layer can leave 32 bits, no weight is -128 and
// every shift is in range. In float32: whether every weight is finite. Only the sizes of the tensors in
// `weights` are used.
bool has_possible_values(const std::uint8_t* image, const NetworkWeights<FixedPoint>& weights);
#if TUMBLESIGHT_FLOAT32
bool has_possible_values(const std::uint8_t* image, const NetworkWeights<Float32>& weights);
#endif

}  // namespace tumblesight::gnc
