// From the flight network's layout of weights to ONNX's.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

inline std::vector<float> values_of(const TensorView& tensor) {
  return {tensor.begin(), tensor.end()};
}

// Float32Layer: float. Int8Layer: std::int8_t.
template <class Layer>
using WeightOf = std::decay_t<decltype(*std::declval<Layer>().weight.begin())>;

// [ky][kx][in][out] -> [out][in][ky][kx]
template <class Layer>
std::vector<WeightOf<Layer>> convolution_of_onnx(const Layer& layer) {
  const auto out = static_cast<std::size_t>(layer.row.outputs),
             in = static_cast<std::size_t>(layer.row.inputs);
  std::vector<WeightOf<Layer>> result;
  for (std::size_t o = 0; o < out; ++o) {
    for (std::size_t i = 0; i < in; ++i) {
      for (std::size_t k = 0; k < 9; ++k) result.push_back(layer.weight[(k * in + i) * out + o]);
    }
  }
  return result;
}

// [in][out]; behind an image [pixel][channel][out] -> [channel][pixel][out], since ONNX flattens channel by
// channel.
template <class Layer>
std::vector<WeightOf<Layer>> dense_of_onnx(const Layer& layer) {
  if (!reads_flat_image(layer.row)) return {layer.weight.begin(), layer.weight.end()};
  const auto channels = static_cast<std::size_t>(channels_of(layer.row.reads[0]));
  const auto out = static_cast<std::size_t>(layer.row.outputs);
  const std::size_t pixels = static_cast<std::size_t>(layer.row.inputs) / channels;
  std::vector<WeightOf<Layer>> result;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const auto row = layer.weight.begin() + static_cast<std::ptrdiff_t>((pixel * channels + channel) * out);
      result.insert(result.end(), row, row + static_cast<std::ptrdiff_t>(out));
    }
  }
  return result;
}

// [row][gate] with the gates input, forget, cell, output -> [gate][row] with input, output, forget, cell.
inline std::vector<float> gates_of_onnx(const TensorView& tensor, std::size_t hidden) {
  const std::size_t gates = 4 * hidden, rows = tensor.size / gates;
  std::vector<float> result;
  for (const std::size_t gate : {0, 3, 1, 2}) {
    for (std::size_t unit = gate * hidden; unit < (gate + 1) * hidden; ++unit) {
      for (std::size_t row = 0; row < rows; ++row) result.push_back(tensor[row * gates + unit]);
    }
  }
  return result;
}

}  // namespace tumblesight::sim
