// Makes a float32 network out of the fixed-point network that flies: where the float32 image is lost, as the
// start of further training and for comparisons. The inverse of quantize.hpp.
#pragma once

#include <memory>
#include <string>

#include "sim/model/model_file.hpp"
#include "sim/quantization/quantize.hpp"

namespace tumblesight::sim {

struct DequantizedNetwork {
  gnc::NetworkWeights<gnc::Float32> weights;
  Scales scales;  // of the fixed-point network, as the float32 weights imply them
};

// Computes the same function, but neither rounds nor limits activations. Every weight is the integer times a
// power of two, so nothing is lost, and quantization errors of the weights stay. The bias keeps what
// compensates the mean of those errors (IntegerLayer::mean_loss), since it belongs to the integers.
//
// An image has no scales. In a hidden layer any scale of a channel gives an equivalent network, since ReLU
// and the next layer's weights follow it. The one chosen brings the L2 norm of the channel's weights within a
// factor of sqrt(2) of what is typical of a trained network.
std::unique_ptr<DequantizedNetwork> dequantize(const gnc::NetworkWeights<gnc::FixedPoint>& weights);

// From a model image in fixed point. The header has the paper's noise, as `tumblesight train` writes it into
// every float32 image; all else in it stays. Throws std::runtime_error that names the file if it cannot be
// read, is in float32 already, or is refused.
std::unique_ptr<Float32Model> dequantized_model(const std::string& path);

}  // namespace tumblesight::sim
