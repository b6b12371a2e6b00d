// Weights between LibTorch's layout and the flight network's (docs/icd.md, model image).
#pragma once

#include <torch/torch.h>

#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

// A flat tensor over the same memory.
torch::Tensor tensor_of(const TensorView& values);

// Flight layout, flat -> [sums, in, 3, 3] (convolution), else [sums, in]. sums: gnc::sum_channels().
torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat);
// [sums, in, 3, 3] or [sums, in] -> flight layout. The result is a view; contiguous() puts it in order.
torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight);

}  // namespace tumblesight::sim
