// What the numbers in a model image may be.
#pragma once

#include <cstdint>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

// Whether every weight of the whole image is finite (float32), or no sum of a layer can leave 32 bits and
// every shift is in its range (fixed point). `weights` only lends the sizes of its tensors.
bool has_possible_values(const std::uint8_t* image, const NetworkWeights<FixedPoint>& weights);
#if TUMBLESIGHT_FLOAT32
bool has_possible_values(const std::uint8_t* image, const NetworkWeights<Float32>& weights);
#endif

}  // namespace tumblesight::gnc
