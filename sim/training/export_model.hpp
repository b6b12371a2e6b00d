// From LibTorch modules to the model image that flies.
#pragma once

#include <string>

#include "gnc/rcnn/model_image.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Batch norm folded into the convolutions, standardisation into the LSTM and the head, layouts turned to the
// flight side's. Modules may lie on any device.
void export_weights(const Cnn& cnn, const Recurrent& recurrent, gnc::NetworkWeights<gnc::Float32>& weights);

// Rounds every weight to 10 significant bits: far below what shows in an attitude, and the image compresses
// to half.
void shorten(gnc::NetworkWeights<gnc::Float32>& weights);

// Throws std::runtime_error when the name or the inertia is not possible.
gnc::ModelHeader model_header(const std::string& target, const TrainingTargets& targets);

}  // namespace tumblesight::sim
