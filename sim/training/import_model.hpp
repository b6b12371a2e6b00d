// From a model image back to the LibTorch CNN: to continue its training, or to start another target's
// training.
#pragma once

#include "gnc/rcnn/model_image.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Makes `cnn` compute the same function as the weights. A model image has no batch statistics: they are
// measured on `images` [B, 1, 100, 100], which should be those of the training to come, and the layers are
// rescaled to keep the function. The LSTM is not imported: it only works with the features of its own CNN.
void import_cnn(const gnc::NetworkWeights<gnc::Float32>& weights, const torch::Tensor& images, Cnn& cnn);

}  // namespace tumblesight::sim
