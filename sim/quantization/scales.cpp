#include "sim/quantization/scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumblesight::sim {
namespace {

constexpr int kLargestShift = 24;
constexpr int kStepsPerOctave = 16;
// Fraction of the error of weights rounded independently that remains when other weights compensate it
// (rounding.hpp). Tuned: 0.1 and 1 give worse networks.
constexpr double kUncompensated = 0.3;
// How many times a power of two may be halved below the one that fits the largest weight.
constexpr int kHalvings = 2;

// Mean square error of a sum, in its units, when every weight is rounded independently.
double rounding_error(const FloatLayer& layer, const InputStatistics& inputs) {
  const Eigen::VectorXd variance = inputs.variance();
  double sum = 0.0;
  for (std::size_t i = 0; i < layer.rows.size(); ++i) {
    sum += variance[static_cast<Eigen::Index>(i)] / (layer.input_scale[i] * layer.input_scale[i]);
  }
  return sum / 12.0;
}

}  // namespace

OutputScales scales_that_fit(const FloatLayer& layer, const std::vector<Distribution>& outputs,
                             double largest_integer) {
  OutputScales scales;
  for (int c = 0; c < layer.channels; ++c) {
    const double sum = largest_weight(layer, c) / kLargestWeight;
    const double steps = outputs.at(c).largest() / sum / largest_integer;
    const int shift = steps > 2.0 ? static_cast<int>(std::ceil(std::log2(steps))) : 1;
    scales.sum.push_back(sum);
    scales.shift.push_back(std::min(shift, kLargestShift));
  }
  return scales;
}

OutputScales scales_of_least_loss(const FloatLayer& layer, const InputStatistics& inputs,
                                  const std::vector<Distribution>& outputs, double largest_integer) {
  const double of_weights = kUncompensated * rounding_error(layer, inputs);
  OutputScales scales;
  for (int c = 0; c < layer.channels; ++c) {
    const double smallest = largest_weight(layer, c) / kLargestWeight;
    double best_sum = smallest, least = std::numeric_limits<double>::infinity();
    int best_shift = 1;
    for (int shift = 1; shift <= kLargestShift; ++shift) {
      for (int step = 0; step < kStepsPerOctave; ++step) {
        const double sum = smallest * std::exp2(step / double{kStepsPerOctave});
        const double loss =
            of_weights * sum * sum + outputs.at(c).squared_loss(std::ldexp(sum, shift), largest_integer);
        if (loss >= least) continue;
        least = loss;
        best_sum = sum;
        best_shift = shift;
      }
    }
    scales.sum.push_back(best_sum);
    scales.shift.push_back(best_shift);
  }
  return scales;
}

std::vector<double> powers_of_two(const FloatLayer& layer, const InputStatistics& inputs) {
  std::vector<double> scales;
  for (int c = 0; c < layer.channels; ++c) {
    scales.push_back(std::exp2(std::ceil(std::log2(largest_weight(layer, c) / kLargestWeight))));
  }
  Eigen::VectorXd least = integers_of(layer, scales, inputs).squared_loss;
  std::vector<double> smaller = scales;
  for (int halving = 0; halving < kHalvings; ++halving) {
    for (double& scale : smaller) scale /= 2.0;
    const Eigen::VectorXd loss = integers_of(layer, smaller, inputs).squared_loss;
    for (int c = 0; c < layer.channels; ++c) {
      if (loss[c] >= least[c]) continue;
      least[c] = loss[c];
      scales[c] = smaller[c];
    }
  }
  return scales;
}

}  // namespace tumblesight::sim
