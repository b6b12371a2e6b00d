// From a model image back to the LibTorch CNN: to go on training it, or to begin another target's from it.
#pragma once

#include "gnc/rcnn/model_image.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Makes `cnn` compute what the weights compute. An image holds no batch statistics: they are taken from
// `images` [B, 1, 100, 100] of what it is to be trained on, and the layers are rescaled so that the function
// stays the same. The LSTM is not taken over: it is worth nothing on another CNN's features.
void import_cnn(const gnc::NetworkWeights<gnc::Float32>& weights, const torch::Tensor& images, Cnn& cnn);

}  // namespace tumblesight::sim
