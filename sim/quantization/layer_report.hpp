// What each layer loses on the way to fixed point.
#pragma once

#include <string>
#include <vector>

#include "sim/quantization/calibration.hpp"
#include "sim/quantization/quantize.hpp"

namespace tumblesight::sim {

struct LayerReport {
  std::string layer;
  double largest = 0.0;    // of the float32 network's outputs
  double saturated = 0.0;  // share of the fixed-point outputs at the end of their range
  double snr_db = 0.0;     // float32's output over the difference
};
// One line a hidden layer, over sequences that should not be those of the ranges.
std::vector<LayerReport> compare(const gnc::NetworkWeights<gnc::Float32>& reference,
                                 const QuantizedNetwork& network, const gnc::Inertia<gnc::Fixed>& inertia,
                                 const std::vector<ImageSequence>& sequences);

}  // namespace tumblesight::sim
