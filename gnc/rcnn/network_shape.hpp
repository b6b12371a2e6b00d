// The RCNN as one table: its sizes, then its layers. Everything else about the network is derived from it:
// types, weights and data flow (network.hpp, network_flow.hpp), model image (model_image.hpp), and on the
// ground training, quantization, ONNX export and bench.
#pragma once

#include "gnc/rcnn/layer_kinds.hpp"

namespace tumblesight::gnc {

namespace shape {

inline constexpr int kImageSide = 100;
inline constexpr int kSpaceToDepthChannels = 4;  // channel = 2 * (row & 1) + (column & 1)
inline constexpr int kConv1 = 16;                // 50x50 -> 25x25
inline constexpr int kConv2 = 48;                // 25x25 -> 12x12
inline constexpr int kConv3 = 96;                // 12x12 -> 6x6
inline constexpr int kConv4 = 160;               // 6x6   -> 3x3
inline constexpr int kFlat = 3 * 3 * kConv4;
inline constexpr int kDense1 = 192;
inline constexpr int kDense2 = 128;

// Output of the single-frame head: kHypotheses attitudes as two unnormalized columns of R_view_trf (six
// numbers each), their logits, and the logit of the expected error over pi.
inline constexpr int kHypotheses = 8;
inline constexpr int kColumns = 6 * kHypotheses;
inline constexpr int kOutput = kColumns + kHypotheses + 1;

// LSTM input: output of dense2; two columns of each hypothesis relative to the predicted attitude; the
// softmax probabilities; two columns of the predicted attitude.
inline constexpr int kLstmInput = kDense2 + kColumns + kHypotheses + 6;
inline constexpr int kLstm = 192;

// Output of the recurrent head, for the kHypotheses candidates of the frame and the predicted one:
// corrections to the logits of choosing them, then to the logarithms of their weights; then the correction to
// the rate's gain; last, the logit of the expected error over pi.
inline constexpr int kHead = 128;
inline constexpr int kCandidates = kHypotheses + 1;
inline constexpr int kHeadOutput = 2 * kCandidates + 2;

// Hashed in this order into every model image (architecture_hash()): an image fits only the sizes it was made
// for.
inline constexpr int kHashed[] = {
    kImageSide, kSpaceToDepthChannels, kConv1,  kConv2,     kConv3, kConv4, kFlat,      kDense1,
    kDense2,    kHypotheses,           kOutput, kLstmInput, kLstm,  kHead,  kHeadOutput};

}  // namespace shape

// The network's inputs: the depth image folded 2x2 into four channels, and the LSTM input.
inline constexpr const char* kDepthInput = "depth";
inline constexpr const char* kLstmInput = "lstm_input";

// The layers in the order of execution: first the CNN, whose last layer is the single-frame
// head, then the LSTM and the recurrent head. This is also the order of the tensors in a model image.
inline constexpr LayerRow kLayers[] = {
    max_pooled_convolution("conv1", kDepthInput, 50, shape::kSpaceToDepthChannels, shape::kConv1),
    max_pooled_convolution("conv2", "conv1", 25, shape::kConv1, shape::kConv2),
    max_pooled_convolution("conv3", "conv2", 12, shape::kConv2, shape::kConv3),
    average_pooled_convolution("conv4", "conv3", 6, shape::kConv3, shape::kConv4),
    hidden_dense("dense1", {"conv4"}, shape::kFlat, shape::kDense1),
    hidden_dense("dense2", {"dense1"}, shape::kDense1, shape::kDense2),
    output_dense("cnn_out", {"dense2"}, shape::kDense2, shape::kOutput),
    lstm("lstm", {kLstmInput}, shape::kLstmInput, shape::kLstm),
    hidden_dense("head1", {"lstm", kLstmInput}, shape::kLstm + shape::kLstmInput, shape::kHead),
    output_dense("head2", {"head1"}, shape::kHead, shape::kHeadOutput),
};
inline constexpr int kLayerCount = static_cast<int>(sizeof kLayers / sizeof kLayers[0]);

constexpr bool is_same_name(const char* a, const char* b) {
  while (*a != '\0' && *a == *b) {
    ++a;
    ++b;
  }
  return *a == *b;
}

// Row of the layer of that name; kLayerCount if there is none.
constexpr int layer_index(const char* name) {
  int index = 0;
  while (index < kLayerCount && !is_same_name(kLayers[index].name, name)) ++index;
  return index;
}

// The rows that the data flow refers to.
inline constexpr int kLstmLayer = layer_index("lstm");
inline constexpr int kCnnOutputLayer = kLstmLayer - 1;
inline constexpr int kFeatureLayer = kLstmLayer - 2;  // its output, the features, begins the LSTM input
inline constexpr int kHeadOutputLayer = kLayerCount - 1;

// How many values of one frame have this name: a network input's or a layer's output. 0: no such name.
constexpr int values_per_frame(const char* name) {
  if (is_same_name(name, kDepthInput)) return shape::kImageSide * shape::kImageSide;
  // cppcheck takes shape::kLstmInput, a size, for the name gnc::kLstmInput.
  // cppcheck-suppress CastAddressToIntegerAtReturn
  if (is_same_name(name, kLstmInput)) return shape::kLstmInput;
  const int index = layer_index(name);
  return index < kLayerCount ? output_values(kLayers[index]) : 0;
}

// Every layer is as wide as what it reads.
constexpr bool is_consistent() {
  for (const LayerRow& row : kLayers) {
    int values = 0;
    for (const char* name : row.reads) values += name != nullptr ? values_per_frame(name) : 0;
    if (values != input_values(row)) return false;
  }
  return true;
}
static_assert(is_consistent(), "a layer's inputs do not match what it reads, or it reads an unknown layer");
static_assert(kLayers[kFeatureLayer].outputs == shape::kDense2 &&
              kLayers[kHeadOutputLayer].outputs == shape::kHeadOutput);

// The layers that read images, which come first in the table.
constexpr int count_image_layers() {
  int count = 0;
  while (is_image_layer(kLayers[count])) ++count;
  return count;
}
inline constexpr int kImageLayerCount = count_image_layers();
constexpr bool all_images_come_first() {
  for (int i = kImageLayerCount; i < kLayerCount; ++i) {
    if (is_image_layer(kLayers[i])) return false;
  }
  return true;
}
static_assert(all_images_come_first(), "a layer that reads an image stands behind one that reads a vector");

// Whether the outputs of all layers stand in shape::kHashed, in the table's order.
constexpr bool all_layers_are_hashed() {
  int layer = 0;
  for (const int size : shape::kHashed) {
    if (layer < kLayerCount && kLayers[layer].outputs == size) ++layer;
  }
  return layer == kLayerCount;
}
static_assert(all_layers_are_hashed(), "shape::kHashed lacks the outputs of a layer at its place");

}  // namespace tumblesight::gnc
