// From the flight network's order of weights to ONNX's.
#pragma once

#include <cstddef>
#include <vector>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::sim {

template <class Tensor>
std::vector<float> values_of(const Tensor& tensor) {
  return {tensor.data(), tensor.data() + tensor.size()};
}

// [ky][kx][in][out] -> [out][in][ky][kx]
template <class Layer>
std::vector<float> convolution_of_onnx(const Layer& layer) {
  const std::size_t out = layer.bias.size(), in = layer.weight.size() / out / 9;
  std::vector<float> result;
  for (std::size_t o = 0; o < out; ++o) {
    for (std::size_t i = 0; i < in; ++i) {
      for (std::size_t k = 0; k < 9; ++k) result.push_back(layer.weight[(k * in + i) * out + o]);
    }
  }
  return result;
}

// [pixel][channel][out] -> [channel][pixel][out]: a flat image goes pixel by pixel here, channel by channel
// there.
template <class Layer>
std::vector<float> dense_after_flattening(const Layer& layer) {
  constexpr std::size_t kChannels = gnc::shape::kConv4, kPixels = gnc::shape::kFlat / kChannels;
  const std::size_t out = layer.bias.size();
  std::vector<float> result;
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
      const float* const row = layer.weight.data() + (pixel * kChannels + channel) * out;
      result.insert(result.end(), row, row + out);
    }
  }
  return result;
}

// [row][gate] with the gates input, forget, cell, output -> [gate][row] with input, output, forget, cell.
template <class Tensor>
std::vector<float> gates_of_onnx(const Tensor& tensor) {
  constexpr std::size_t kHidden = gnc::shape::kLstm, kGates = 4 * kHidden;
  const std::size_t rows = tensor.size() / kGates;
  std::vector<float> result;
  for (const std::size_t gate : {0, 3, 1, 2}) {
    for (std::size_t unit = gate * kHidden; unit < (gate + 1) * kHidden; ++unit) {
      for (std::size_t row = 0; row < rows; ++row) result.push_back(tensor[row * kGates + unit]);
    }
  }
  return result;
}

}  // namespace tumblesight::sim
