// From the float32 network to the fixed-point one that flies. docs/numerics.md is the norm of what comes out.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnc/rcnn/model_image.hpp"
#include "sim/quantization/statistics.hpp"

namespace tumblesight::sim {

// Real value over integer, channel by channel, of every hidden layer. For the report only: it does not leave
// the host.
using Scales = std::map<std::string, std::vector<double>>;

struct QuantizedNetwork {
  gnc::NetworkWeights<gnc::FixedPoint> weights;  // looks into `storage`
  std::vector<std::vector<std::int8_t>> storage;
  Scales scales;
};

// Symmetric weights of 8 bits with a scale for each output channel (scales.hpp), into which the scales of the
// inputs have been drawn beforehand; powers of two where the layer's output has a meaning. What rounding the
// weights adds to a sum on average is taken off its bias. Each activation's scale is its channel's sum's
// times a power of two.
std::unique_ptr<QuantizedNetwork> quantize(const gnc::NetworkWeights<gnc::Float32>& weights,
                                           const Statistics& statistics);

}  // namespace tumblesight::sim
