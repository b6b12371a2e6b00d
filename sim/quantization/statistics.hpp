// Statistics of the float32 network's layers over the calibration sequences.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/quantization/calibration.hpp"
#include "sim/quantization/rounding.hpp"

namespace tumblesight::sim {

// Distribution: histogram of one channel's outputs, and the loss when they are quantized.
class Distribution {
 public:
  void add(double value);                      // >= 0
  double largest() const { return largest_; }  // 0 if there are no values
  // Mean square error when values are rounded to multiples of `unit` and clamped to `largest_integer` units.
  double squared_loss(double unit, double largest_integer) const;

 private:
  double count_ = 0.0;
  double largest_ = 0.0;
  std::map<int, double> counts_;  // by bin on a logarithmic scale; zeros are not in it
};

struct Statistics {
  // By the name of a network input or hidden layer: one distribution per channel.
  std::map<std::string, std::vector<Distribution>> outputs;
  // By the name of a layer: of the inputs of one sum (inputs_per_sum()).
  std::map<std::string, InputStatistics> inputs;
};

// Collects statistics sequence by sequence.
class Calibration {
 public:
  // `weights` must outlive it.
  Calibration(const gnc::NetworkWeights<gnc::Float32>& weights,
              const gnc::MotionModels<float>& motion_models);
  void add(const ImageSequence& sequence);
  const Statistics& statistics() const { return statistics_; }

 private:
  const gnc::NetworkWeights<gnc::Float32>& weights_;
  gnc::MotionModels<float> motion_models_;
  Statistics statistics_;
};

}  // namespace tumblesight::sim
