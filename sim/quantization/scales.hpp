// Scales of a layer: real value of one unit of its sums and of its outputs, channel by channel.
#pragma once

#include <vector>

#include "sim/quantization/layer.hpp"
#include "sim/quantization/statistics.hpp"

namespace tumblesight::sim {

inline constexpr double kLargestUint8 = 255.0;

struct OutputScales {
  std::vector<double> sum;
  std::vector<int> shift;  // unit of the output = unit of the sum * 2^shift
};

// For outputs of 12 or more bits: the largest weight becomes 127, and the largest observed output fits.
OutputScales scales_that_fit(const FloatLayer& layer, const std::vector<Distribution>& outputs,
                             double largest_integer);

// For outputs of 8 bits: minimizes the loss of rounded weights, rounded outputs and saturated outputs
// together. Rare large outputs may saturate.
OutputScales scales_of_least_loss(const FloatLayer& layer, const InputStatistics& inputs,
                                  const std::vector<Distribution>& outputs, double largest_integer);

// For sums that become real numbers (outputs, LSTM gates): per channel the power of two with the smallest
// loss. A few weights may saturate.
std::vector<double> powers_of_two(const FloatLayer& layer, const InputStatistics& inputs);

}  // namespace tumblesight::sim
