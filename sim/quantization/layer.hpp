// One layer of the float32 network, and its weights as integers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/quantization/rounding.hpp"

namespace tumblesight::sim {

// Of the integers that weights become.
inline constexpr double kLargestWeight = 127.0;

// A layer's float weights as [input][channel], and the real value of one unit of each input.
struct FloatLayer {
  std::string name;
  int channels;
  std::vector<const float*> rows;  // one an input: its `channels` weights
  std::vector<double> input_scale;
  const float* bias;
  double weight(std::size_t input, int channel) const { return rows[input][channel] * input_scale[input]; }
};

void add_rows(FloatLayer& layer, const float* weights, std::size_t inputs);

// The largest weight times the unit of its input; never 0, so that a channel without weights has a scale too.
double largest_weight(const FloatLayer& layer, int channel);

struct IntegerLayer {
  Eigen::MatrixXd weight;  // [input][channel]
  // Of each channel's sum on average, in its units: for the bias to make up for.
  Eigen::VectorXd rounded_away;
  // Mean square of what else each channel's sum lost, in real units.
  Eigen::VectorXd squared_loss;
};
// `scales`: what a unit of each channel's sum is worth.
IntegerLayer integers_of(const FloatLayer& layer, const std::vector<double>& scales,
                         const InputStatistics& inputs);

}  // namespace tumblesight::sim
