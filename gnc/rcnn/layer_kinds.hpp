// The kinds of layers, and what a row of the network's table (network_shape.hpp) says. Per kind: the row,
// what its sums run over, its type, and how it runs. The ground goes by these functions too, so that it needs
// a branch per kind only for what differs there.
//
// To add a kind: docs/contributing.md.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/nn/conv_block.hpp"
#include "gnc/nn/dense.hpp"
#include "gnc/nn/lstm.hpp"

// A switch over the kinds has no default. A kind that is missing in one then does not compile.
#pragma GCC diagnostic error "-Wswitch"

namespace tumblesight::gnc {

enum class LayerKind : std::uint8_t {
  kConvolution,  // 3x3, zero padding 1, pooling 2x2 (floor), ReLU: gnc/nn/conv_block.hpp
  kDense,        // fully connected: gnc/nn/dense.hpp
  kLstm,         // one step of a long short-term memory: gnc/nn/lstm.hpp
};

// The output of a layer.
enum class LayerOutput : std::uint8_t {
  kMaxPooled,      // convolution: maximum of each 2x2 window, then ReLU
  kAveragePooled,  // convolution: ReLU, then the mean of each 2x2 window; flat, pixel by pixel
  kHidden,         // dense: ReLU; LSTM: hidden state
  kOutput,         // dense: values with a meaning, no activation
};

struct LayerRow {
  const char* name;  // of its tensors, in files and reports
  LayerKind kind;
  LayerOutput output;
  int inputs;   // channels of the input image (convolution), else values
  int outputs;  // channels (convolution), hidden units (LSTM), else values
  int side;     // convolution: pixels along one side of the input image; else 0
  // The layer or network input that it reads. A second one is appended to the first.
  std::array<const char*, 2> reads;
};

constexpr LayerRow max_pooled_convolution(const char* name, const char* reads, int side, int inputs,
                                          int outputs) {
  return {name, LayerKind::kConvolution, LayerOutput::kMaxPooled, inputs, outputs, side, {reads}};
}
constexpr LayerRow average_pooled_convolution(const char* name, const char* reads, int side, int inputs,
                                              int outputs) {
  return {name, LayerKind::kConvolution, LayerOutput::kAveragePooled, inputs, outputs, side, {reads}};
}
constexpr LayerRow hidden_dense(const char* name, std::array<const char*, 2> reads, int inputs, int outputs) {
  return {name, LayerKind::kDense, LayerOutput::kHidden, inputs, outputs, 0, reads};
}
constexpr LayerRow output_dense(const char* name, std::array<const char*, 2> reads, int inputs, int outputs) {
  return {name, LayerKind::kDense, LayerOutput::kOutput, inputs, outputs, 0, reads};
}
constexpr LayerRow lstm(const char* name, std::array<const char*, 2> reads, int inputs, int hidden_units) {
  return {name, LayerKind::kLstm, LayerOutput::kHidden, inputs, hidden_units, 0, reads};
}

// What the sums of a layer run over.
struct LayerSums {
  int window;        // pixels along one side of the part of an image that a sum reads; 0: a sum reads vectors
  int per_output;    // sums per output
  bool read_state;   // a sum also reads the layer's outputs of the frame before
  bool become_real;  // in fixed point, also in a hidden layer: the sums become real numbers (gates)
};
constexpr LayerSums sums_of(LayerKind kind) {
  switch (kind) {
    case LayerKind::kConvolution:
      return {3, 1, false, false};
    case LayerKind::kDense:
      return {0, 1, false, false};
    case LayerKind::kLstm:
      return {0, 4, true, true};
  }
  return {};
}

// Whether the layer reads and writes an image.
constexpr bool is_image_layer(const LayerRow& row) {
  return sums_of(row.kind).window > 0;
}
// Values that the layer reads from `reads`, and that it writes, per frame.
constexpr int input_values(const LayerRow& row) {
  return is_image_layer(row) ? row.side * row.side * row.inputs : row.inputs;
}
constexpr int output_values(const LayerRow& row) {
  return is_image_layer(row) ? (row.side / 2) * (row.side / 2) * row.outputs : row.outputs;
}
// How often a sum reads each channel of `reads`, if they are images: once per pixel of the window.
constexpr int pixels_per_sum(const LayerRow& row) {
  return is_image_layer(row) ? sums_of(row.kind).window * sums_of(row.kind).window : 1;
}
// Number of inputs of one sum.
constexpr int inputs_per_sum(const LayerRow& row) {
  return pixels_per_sum(row) * row.inputs + (sums_of(row.kind).read_state ? row.outputs : 0);
}
// Number of sums of one pixel or vector: channels of the bias.
constexpr int sum_channels(const LayerRow& row) {
  return sums_of(row.kind).per_output * row.outputs;
}

// Per kind of layer: its type, and how a layer without state runs. `sums` is scratch.
template <LayerKind kKind>
struct LayerOfKind;

template <>
struct LayerOfKind<LayerKind::kConvolution> {
  template <class N, int kSide, int kInputs, int kOutputs>
  using Type = ConvBlock<N, kSide, kInputs, kOutputs>;

  // The type of `out` selects the pooling.
  template <class Layer, LayerOutput, class N, class Out>
  static void run(const Kernels<N>& kernels, const typename Layer::Weights& weights,
                  const typename Layer::Input& in, typename Layer::Sums& sums, Out& out) {
    Layer::forward(kernels, weights, in, sums, out);
  }
};

template <>
struct LayerOfKind<LayerKind::kDense> {
  template <class N, int, int kInputs, int kOutputs>
  using Type = Dense<N, kInputs, kOutputs>;

  template <class Layer, LayerOutput kOutput, class N, class Out>
  static void run(const Kernels<N>& kernels, const typename Layer::Weights& weights,
                  const typename Layer::Input& in, typename Layer::Sums& sums, Out& out) {
    if constexpr (kOutput == LayerOutput::kHidden) {
      Layer::hidden(kernels, weights, in, sums, out);
    } else {
      Layer::output(kernels, weights, in, sums, out);
    }
  }
};

template <>
struct LayerOfKind<LayerKind::kLstm> {
  template <class N, int, int kInputs, int kOutputs>
  using Type = Lstm<N, kInputs, kOutputs>;
};

}  // namespace tumblesight::gnc
