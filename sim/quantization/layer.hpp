// One layer of the float32 network, and its weights rounded to integers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/quantization/rounding.hpp"

namespace tumblesight::sim {

// Magnitude of the integers that weights are rounded to.
inline constexpr double kLargestWeight = 127.0;

// A layer whose inputs are integers. weight() has the inputs' scales multiplied in, so that it applies to
// integers.
struct FloatLayer {
  std::string name;
  int channels;
  std::vector<const float*> rows;   // per input: its `channels` weights, not owned
  std::vector<double> input_scale;  // per input: real value of one unit
  const float* bias;                // [channels], not owned
  double weight(std::size_t input, int channel) const { return rows[input][channel] * input_scale[input]; }
};

// Appends `inputs` rows: `weights` is [inputs][channels].
void add_rows(FloatLayer& layer, const float* weights, std::size_t inputs);

// Largest magnitude of weight() in a channel. Never 0, so that every channel gets a scale.
double largest_weight(const FloatLayer& layer, int channel);

struct IntegerLayer {
  Eigen::MatrixXd weight;  // [input][channel]
  // Per channel, in units of its sum: by how much rounding the weights lowers the mean of the sum. To be
  // added to the bias.
  Eigen::VectorXd mean_loss;
  // Per channel, in real units: mean square of the sum's remaining error.
  Eigen::VectorXd squared_loss;
};
// `scales`: per channel, real value of one unit of its sum. Weights beyond +-kLargestWeight
// saturate.
IntegerLayer integers_of(const FloatLayer& layer, const std::vector<double>& scales,
                         const InputStatistics& inputs);

}  // namespace tumblesight::sim
