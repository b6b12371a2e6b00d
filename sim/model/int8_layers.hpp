// The fixed-point network as other runtimes take it: 8-bit activations with one scale per tensor, 8-bit
// weights with one per output channel. Convolutions and the dense layers behind them are in int8, the LSTM
// and the recurrent head in float32.
//
// Values are in counts, the integers of the fixed-point network. It has no other scales: its shift is a
// factor of 2^-shift per output channel. conv1...conv3 therefore differ only in the rounding of halves.
// Behind them activations have 8 bits instead of conv4's 12 and the dense layers' 15.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/rcnn/network.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// output = sum * scale, rounded and saturated to 0...255 in a hidden layer.
struct Int8Layer {
  gnc::LayerRow row;
  std::vector<std::int8_t> weight;  // [3][3][in][out] (convolution), else [in][out]
  std::vector<std::int32_t> bias;   // [out], in the unit of the sum of inputs times weights
  std::vector<float> scale;         // [out]
  // Counts per step of input and output. An average-pooled output is the mean of four; the sum of the four,
  // which the next layer reads, has four times the unit. The output of cnn_out is a real number, not steps.
  float input_unit;
  float output_unit;
};

// The CNN's layers in the table's order.
std::vector<Int8Layer> int8_layers_of(const gnc::NetworkWeights<gnc::FixedPoint>& weights);

// A float32 network whose LSTM and recurrent head compute what those in fixed point do, without their
// rounding. The LSTM's input is in counts; hidden state, cells and outputs are real numbers. The CNN's
// weights are zero.
std::unique_ptr<Float32Model> recurrent_in_float32(const gnc::ModelHeader& header,
                                                   const gnc::NetworkWeights<gnc::FixedPoint>& weights);

}  // namespace tumblesight::sim
