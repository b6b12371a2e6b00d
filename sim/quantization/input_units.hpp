// The units of the integers that a layer of the fixed-point network reads.
#pragma once

#include <vector>

#include "gnc/rcnn/network_shape.hpp"
#include "sim/quantization/quantize.hpp"

namespace tumblesight::sim {

// Of the network's inputs, which are fixed. The LSTM's input and its hidden state have the unit 2^-15, except
// for the features, which keep theirs: their layer must have its scales. `lstm`: row of the LSTM.
void put_depth_scales(Scales& scales);
void put_lstm_scales(const gnc::LayerRow& lstm, Scales& scales);

// Of each input of the layer's sums. The layers that it reads must have their scales.
std::vector<double> input_units(const gnc::LayerRow& row, const Scales& scales);

}  // namespace tumblesight::sim
