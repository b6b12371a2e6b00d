// The network's table of layers (gnc/rcnn/network_shape.hpp) for training, quantization, ONNX export and
// bench.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::sim {

// Rows in the table's order: those of the CNN that read images, those of the CNN behind them (up to the
// single-frame output), and those of the recurrent head, behind the LSTM.
std::vector<gnc::LayerRow> image_rows();
std::vector<gnc::LayerRow> vector_rows();
std::vector<gnc::LayerRow> head_rows();

// Channels of a network input or of a layer's output. In a vector every value is a channel. Throws
// std::invalid_argument for an unknown name.
int channels_of(const std::string& name);

// Whether the layer's output is an activation: what quantization observes and reports.
bool is_hidden(const gnc::LayerRow& row);

// Whether the layer reads an image as a flat vector. The flight network flattens it pixel by pixel, LibTorch
// and ONNX channel by channel.
bool reads_flat_image(const gnc::LayerRow& row);

// The names in LayerRow::reads.
std::vector<std::string> reads_of(const gnc::LayerRow& row);

// A tensor of the network, not owned.
struct TensorView {
  const float* data = nullptr;
  std::size_t size = 0;

  const float* begin() const { return data; }
  const float* end() const { return data + size; }
  float operator[](std::size_t i) const { return data[i]; }
};

// One layer of the float32 network. Layouts: docs/icd.md, model image.
struct Float32Layer {
  gnc::LayerRow row;
  TensorView weight;     // [3][3][in][sums] (convolution), else [in][sums]; sums: gnc::sum_channels()
  TensorView recurrent;  // LSTM: [hidden][sums]; else empty
  TensorView bias;       // [sums]
};
// All layers in the table's order. `weights` must outlive them.
std::vector<Float32Layer> layers_of(const gnc::NetworkWeights<gnc::Float32>& weights);

}  // namespace tumblesight::sim
