// Weights between LibTorch's layout and the flight network's (docs/icd.md, model image), per kind of layer.
#pragma once

#include <torch/torch.h>

#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

// A flat tensor over the same memory.
torch::Tensor tensor_of(const TensorView& values);

// Flight layout, flat -> [out, in, 3, 3] (convolution), else [out, in]; out of an LSTM: 4 * hidden units.
torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat);
// [out, in, 3, 3] or [out, in] -> flight layout. The result is a view; contiguous() puts it in order.
torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight);

}  // namespace tumblesight::sim
