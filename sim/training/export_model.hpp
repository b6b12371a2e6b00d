// From LibTorch modules to the model image that flies.
#pragma once

#include <string>

#include "gnc/rcnn/model_image.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Batch norm folded into the convolutions, standardisation into the LSTM and the head, layouts turned to the
// flight side's. Modules may lie on any device.
void export_weights(const Cnn& cnn, const Recurrent& recurrent, gnc::NetworkWeights& weights);

// Rounds every weight to 10 significant bits: far below what shows in an attitude, and the image compresses
// to half.
void shorten(gnc::NetworkWeights& weights);

// Writes the image beside `path` and renames it over. Throws std::runtime_error naming the file.
void write_model_file(const std::string& path, const std::string& target, const TrainingTargets& targets,
                      const gnc::NetworkWeights& weights);

}  // namespace tumblesight::sim
