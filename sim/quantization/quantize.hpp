// Makes the fixed-point network that flies from the float32 network. Specification of the result:
// docs/numerics.md.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnc/rcnn/model_image.hpp"
#include "sim/quantization/statistics.hpp"

namespace tumblesight::sim {

// Per network input and hidden layer: real value of one unit, channel by channel. Not part of the model
// image.
using Scales = std::map<std::string, std::vector<double>>;

struct QuantizedNetwork {
  gnc::NetworkWeights<gnc::FixedPoint> weights;  // they point into `storage`
  std::vector<std::vector<std::int8_t>> storage;
  Scales scales;
};

// Weights become symmetric 8-bit integers with one scale per output channel (scales.hpp), after the inputs'
// scales have been multiplied into them. The scale is a power of two where the output is a real number. The
// bias compensates the mean error of the rounded weights. The scale of an activation is that of its channel's
// sum times a power of two, so that a shift is the only operation between layers. Throws std::runtime_error
// that names the layer and channel if the weights are outside the range of fixed point.
std::unique_ptr<QuantizedNetwork> quantize(const gnc::NetworkWeights<gnc::Float32>& weights,
                                           const Statistics& statistics);

}  // namespace tumblesight::sim
