// What one unit of a layer's sums and of its outputs is worth, channel by channel.
#pragma once

#include <vector>

#include "sim/quantization/distribution.hpp"
#include "sim/quantization/layer.hpp"

namespace tumblesight::sim {

inline constexpr double kLargestUint8 = 255.0;

struct OutputScales {
  std::vector<double> sum;
  std::vector<int> shift;  // a unit of the output is one of the sum times 2^shift
};

// For outputs with bits to spare: the largest weight is 127, and the largest value seen fits.
OutputScales scales_of_many_bits(const FloatLayer& layer, const std::vector<Distribution>& outputs,
                                 double largest_integer);

// For outputs of few bits: those with which weights and outputs together lose least. Rare large values may
// saturate.
OutputScales scales_of_few_bits(const FloatLayer& layer, const InputStatistics& inputs,
                                const std::vector<Distribution>& outputs, double largest_integer);

// Of sums that become numbers with a meaning: of the powers of two the one that loses least. A few weights
// may saturate.
std::vector<double> powers_of_two(const FloatLayer& layer, const InputStatistics& inputs);

}  // namespace tumblesight::sim
