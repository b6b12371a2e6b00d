// Statistics of the float32 network's layers over the calibration sequences.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/quantization/calibration.hpp"
#include "sim/quantization/distribution.hpp"
#include "sim/quantization/rounding.hpp"

namespace tumblesight::sim {

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
  Calibration(const gnc::NetworkWeights<gnc::Float32>& weights, const gnc::MotionLaws<float>& laws);
  void add(const ImageSequence& sequence);
  const Statistics& statistics() const { return statistics_; }

 private:
  const gnc::NetworkWeights<gnc::Float32>& weights_;
  gnc::MotionLaws<float> laws_;
  Statistics statistics_;
};

}  // namespace tumblesight::sim
