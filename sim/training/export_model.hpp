// From LibTorch modules to the model image that flies.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>

#include "gnc/rcnn/model_image.hpp"
#include "sim/model/model_file.hpp"
#include "sim/model/network_layers.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

// Weights between LibTorch's layout and the flight network's (docs/icd.md, model image).
// A flat tensor over the same memory.
torch::Tensor tensor_of(const TensorView& values);

// Flight layout, flat -> [sums, in, 3, 3] (convolution), else [sums, in]. sums: gnc::sum_channels().
torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat);
// [sums, in, 3, 3] or [sums, in] -> flight layout. The result is a view; contiguous() puts it in order.
torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight);

// Copies the modules' weights into the flight network's layout. Batch norm is folded into the convolutions,
// the standardization of the LSTM input into the LSTM and the recurrent head. The modules may be on any
// device.
void export_weights(const Cnn& cnn, const Recurrent& recurrent, gnc::NetworkWeights<gnc::Float32>& weights);

// A recurrent part that leaves the weights of the CNN's hypotheses as they are: the track alone combines the
// frames. For images of a network whose recurrent part is not trained yet. `mean_error_rad`: of the CNN; it
// becomes the expected error.
void make_neutral(Recurrent& recurrent, double mean_error_rad);

// The network as a model image in float32, its weights rounded.
std::unique_ptr<Float32Model> model_of(const Cnn& cnn, const Recurrent& recurrent, const std::string& target,
                                       const TrainingTargets& targets);

// Rounds every weight to 10 significant bits. The effect on attitudes is far below their error, and the image
// compresses to half its size.
void round_to_10_bits(gnc::NetworkWeights<gnc::Float32>& weights);

// Header of the model image for `target`. Throws std::runtime_error if the name is empty, longer than 31
// characters or not printable ASCII, or if fixed point cannot represent the inertia.
gnc::ModelHeader model_header(const std::string& target, const TrainingTargets& targets);

}  // namespace tumblesight::sim
