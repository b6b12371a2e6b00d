// The quantization error of each layer.
#pragma once

#include <string>
#include <vector>

#include "sim/quantization/calibration.hpp"
#include "sim/quantization/quantize.hpp"

namespace tumblesight::sim {

struct LayerReport {
  std::string layer;
  double largest = 0.0;    // largest magnitude of the float32 network's outputs
  double saturated = 0.0;  // share of the fixed-point outputs at the end of their range, 0 to 1
  double snr_db = 0.0;     // power of the float32 outputs over that of the difference
};
// One row per hidden layer. `sequences` should not be those that the scales were chosen on.
std::vector<LayerReport> compare(const gnc::NetworkWeights<gnc::Float32>& reference,
                                 const QuantizedNetwork& network, const gnc::Inertia<gnc::Fixed>& inertia,
                                 const std::vector<ImageSequence>& sequences);

}  // namespace tumblesight::sim
