// The data flow from layer to layer. Each function calls observe(name, values) with every network input and
// with every hidden layer's output; in flight the observer is empty and costs nothing.
#pragma once

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

inline void to_conv_input(std::uint16_t depth, float& out) {
  out = static_cast<float>(depth) * (1.0F / 65536.0F);
}
inline void to_conv_input(std::uint16_t depth, std::uint8_t& out) {
  out = static_cast<std::uint8_t>(min((depth + 128) >> 8, 255));
}

// Every 2x2 pixels become one pixel of four channels, channel = 2 * (row & 1) + (column & 1).
template <class N>
[[gnu::noinline]] void space_to_depth(const DepthImage& image, typename Layer<N, 0>::Input& out) {
  constexpr int kSide = DepthImage::kSide;
  out.values.fill({});
  for (int y = 0; y < kSide / 2; ++y) {
    const std::uint16_t* const top = image.depth.data() + 2 * y * kSide;
    const std::uint16_t* const bottom = top + kSide;
    ConvInput<N>* const row = out.row(y);
    for (int x = 0; x < kSide / 2; ++x) {
      to_conv_input(top[2 * x], row[4 * x]);
      to_conv_input(top[2 * x + 1], row[4 * x + 1]);
      to_conv_input(bottom[2 * x], row[4 * x + 2]);
      to_conv_input(bottom[2 * x + 1], row[4 * x + 3]);
    }
  }
}

// One layer without state, from `in` to `out`.
template <int kIndex, class N, class Out>
[[gnu::always_inline]] inline void run_layer(const Kernels<N>& kernels, const NetworkWeights<N>& weights,
                                             const typename Layer<N, kIndex>::Input& in,
                                             Activations<N>& activations, Out& out) {
  constexpr LayerRow kRow = kLayers[kIndex];
  LayerOfKind<kRow.kind>::template run<Layer<N, kIndex>, kRow.output>(
      kernels, layer_weights<kIndex>(weights), in, activations.template sums<kIndex>(), out);
}

// Layers kFirst to kLast, each from its input among the activations to the next one's. The last one writes
// `out`, which is not observed.
template <int kFirst, int kLast, class N, class Out, class Observer>
[[gnu::always_inline]] inline void run_layers(const Kernels<N>& kernels, const NetworkWeights<N>& weights,
                                              Activations<N>& activations, Out& out, Observer&& observe) {
  if constexpr (kFirst == kLast) {
    run_layer<kLast>(kernels, weights, activations.template input<kLast>(), activations, out);
  } else {
    auto& next = activations.template input<kFirst + 1>();
    run_layer<kFirst>(kernels, weights, activations.template input<kFirst>(), activations, next);
    observe(kLayers[kFirst].name, next);
    run_layers<kFirst + 1, kLast>(kernels, weights, activations, out, observe);
  }
}

// The CNN. `features`: output of layer kFeatureLayer.
template <class N, class Observer>
void run_frame(const Kernels<N>& kernels, const NetworkWeights<N>& weights, const DepthImage& image,
               Activations<N>& activations, Features<N>& features, OutputVector<typename N::Real>& out,
               Observer&& observe) {
  auto& folded = activations.template input<0>();
  space_to_depth<N>(image, folded);
  observe(kDepthInput, folded);
  run_layers<0, kFeatureLayer>(kernels, weights, activations, features, observe);
  observe(kLayers[kFeatureLayer].name, features);
  run_layer<kCnnOutputLayer>(kernels, weights, features, activations, out);
}

// LSTM and recurrent head. Advances `state` by one frame.
template <class N, class Observer>
void run_sequence(const Kernels<N>& kernels, const NetworkWeights<N>& weights, const LstmInput<N>& input,
                  Activations<N>& activations, LstmState<N>& state, HeadOutput<typename N::Real>& out,
                  Observer&& observe) {
  Layer<N, kLstmLayer>::forward(kernels, layer_weights<kLstmLayer>(weights), input,
                                activations.template sums<kLstmLayer>(), state);
  observe(kLayers[kLstmLayer].name, state.h);
  auto& head_input = activations.template input<kLstmLayer + 1>();
  const auto after_hidden = std::copy(state.h.begin(), state.h.end(), head_input.begin());
  std::copy(input.begin(), input.end(), after_hidden);
  run_layers<kLstmLayer + 1, kHeadOutputLayer>(kernels, weights, activations, out, observe);
}

}  // namespace tumblesight::gnc
