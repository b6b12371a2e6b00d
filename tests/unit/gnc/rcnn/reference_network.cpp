#include "tests/unit/gnc/rcnn/reference_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumblesight::gnc {
namespace {

using Numbers = ReferenceNetwork::Numbers;

double exact_sigmoid(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

void relu(Numbers& values) {
  for (double& v : values) v = std::max(v, 0.0);
}

// Every 2x2 window of a square image, channel by channel, reduced to one value. A last odd row and column are
// left out.
Numbers pool(const Numbers& in, int side, double (*reduce)(double, double, double, double)) {
  const int channels = static_cast<int>(in.size()) / (side * side);
  Numbers out;
  for (int y = 0; y < side / 2; ++y) {
    for (int x = 0; x < side / 2; ++x) {
      for (int k = 0; k < channels; ++k) {
        const auto at = [&](int dy, int dx) { return in[((2 * y + dy) * side + 2 * x + dx) * channels + k]; };
        out.push_back(reduce(at(0, 0), at(0, 1), at(1, 0), at(1, 1)));
      }
    }
  }
  return out;
}

double largest(double a, double b, double c, double d) {
  return std::max({a, b, c, d});
}
double mean(double a, double b, double c, double d) {
  return (a + b + c + d) / 4.0;
}

}  // namespace

ReferenceNetwork::ReferenceNetwork(const NetworkWeights<Float32>& weights) : h(192, 0.0), c(192, 0.0) {
  for_each_tensor(weights, [this](const char* layer, const char* part, const auto& tensor) {
    tensors_[std::string(layer) + "." + part] = Numbers(tensor.begin(), tensor.end());
  });
}

Numbers ReferenceNetwork::conv(const std::string& name, const Numbers& in, int side) const {
  const Numbers& weight = tensors_.at(name + ".weight");
  const Numbers& bias = tensors_.at(name + ".bias");
  const int channels_in = static_cast<int>(in.size()) / (side * side);
  const int channels_out = static_cast<int>(bias.size());
  Numbers out;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      Numbers sum = bias;
      for (int ky = 0; ky < 3; ++ky) {
        for (int kx = 0; kx < 3; ++kx) {
          const int from_y = y + ky - 1, from_x = x + kx - 1;
          if (from_y < 0 || from_y >= side || from_x < 0 || from_x >= side) continue;
          for (int i = 0; i < channels_in; ++i) {
            const double value = in[(from_y * side + from_x) * channels_in + i];
            const double* row = weight.data() + ((ky * 3 + kx) * channels_in + i) * channels_out;
            for (int o = 0; o < channels_out; ++o) sum[o] += value * row[o];
          }
        }
      }
      out.insert(out.end(), sum.begin(), sum.end());
    }
  }
  return out;
}

Numbers ReferenceNetwork::dense(const std::string& name, const Numbers& in) const {
  const Numbers& weight = tensors_.at(name + ".weight");
  Numbers sum = tensors_.at(name + ".bias");
  for (std::size_t i = 0; i < in.size(); ++i) {
    for (std::size_t o = 0; o < sum.size(); ++o) sum[o] += in[i] * weight.at(i * sum.size() + o);
  }
  return sum;
}

Numbers ReferenceNetwork::layer(const LayerRow& row, const Numbers& in) const {
  Numbers out;
  switch (row.kind) {
    case LayerKind::kConvolution:
      out = conv(row.name, in, row.side);
      relu(out);
      return pool(out, row.side, row.output == LayerOutput::kMaxPooled ? largest : mean);
    case LayerKind::kDense:
      out = dense(row.name, in);
      if (row.output == LayerOutput::kHidden) relu(out);
      return out;
    case LayerKind::kLstm:
      break;  // infer_sequence()
  }
  ADD_FAILURE() << "layer " << row.name << " keeps a state";
  return out;
}

ReferenceNetwork::Frame ReferenceNetwork::infer_frame(const DepthImage& image) const {
  Numbers map(50 * 50 * 4);
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 100; ++column) {
      map[((row / 2) * 50 + column / 2) * 4 + 2 * (row & 1) + (column & 1)] =
          image.depth[row * 100 + column] / 65536.0;
    }
  }
  Frame frame;
  for (int i = 0; i < kLstmLayer; ++i) {
    const LayerRow& row = kLayers[i];
    map = layer(row, map);
    if (i == kFeatureLayer) frame.features = map;
  }
  frame.output = map;
  return frame;
}

Numbers ReferenceNetwork::infer_sequence(const Numbers& lstm_input) {
  Numbers gates = tensors_.at("lstm.bias");
  const auto add_product = [&gates](const Numbers& in, const Numbers& weight) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      for (std::size_t g = 0; g < gates.size(); ++g) gates[g] += in[i] * weight.at(i * gates.size() + g);
    }
  };
  add_product(lstm_input, tensors_.at("lstm.weight"));
  add_product(h, tensors_.at("lstm.recurrent"));
  for (int i = 0; i < 192; ++i) {
    c[i] = exact_sigmoid(gates[192 + i]) * c[i] + exact_sigmoid(gates[i]) * std::tanh(gates[384 + i]);
    h[i] = exact_sigmoid(gates[576 + i]) * std::tanh(c[i]);
  }

  Numbers values = h;
  values.insert(values.end(), lstm_input.begin(), lstm_input.end());
  for (int i = kLstmLayer + 1; i < kLayerCount; ++i) {
    values = layer(kLayers[i], values);
  }
  return values;
}

}  // namespace tumblesight::gnc
