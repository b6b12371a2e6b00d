// The network's flow, layer by layer. `observe(name, output)` is shown what every layer gets; in flight no
// one looks, and it costs nothing.
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
[[gnu::noinline]] void space_to_depth(const DepthImage& image, typename Layers<N>::Conv1::Input& out) {
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

template <class N, class Observer>
void run_frame(const Kernels<N>& kernels, const NetworkWeights<N>& weights, const DepthImage& image,
               Arena<N>& arena, Features<N>& features, OutputVector<typename N::Real>& out,
               Observer&& observe) {
  using L = Layers<N>;
  auto& map1 = arena.template front<typename L::Conv1::Input>();
  auto& map2 = arena.template back<typename L::Conv2::Input>();
  auto& map3 = arena.template front<typename L::Conv3::Input>();
  auto& map4 = arena.template back<typename L::Conv4::Input>();
  auto& flat = arena.template front<typename L::Dense1::Input>();
  auto& hidden = arena.template back<typename L::Dense1::Hidden>();

  space_to_depth<N>(image, map1);
  observe("depth", map1);
  L::Conv1::forward(kernels, weights.conv1, map1, arena.template sums<typename L::Conv1::Sums>(), map2);
  observe("conv1", map2);
  L::Conv2::forward(kernels, weights.conv2, map2, arena.template sums<typename L::Conv2::Sums>(), map3);
  observe("conv2", map3);
  L::Conv3::forward(kernels, weights.conv3, map3, arena.template sums<typename L::Conv3::Sums>(), map4);
  observe("conv3", map4);
  L::Conv4::forward(kernels, weights.conv4, map4, arena.template sums<typename L::Conv4::Sums>(), flat);
  observe("conv4", flat);
  L::Dense1::hidden(kernels, weights.dense1, flat, arena.template sums<typename L::Dense1::Sums>(), hidden);
  observe("dense1", hidden);
  L::Dense2::hidden(kernels, weights.dense2, hidden, arena.template sums<typename L::Dense2::Sums>(),
                    features);
  observe("dense2", features);
  L::CnnOut::output(kernels, weights.cnn_out, features, arena.template sums<typename L::CnnOut::Sums>(), out);
}

template <class N, class Observer>
void run_sequence(const Kernels<N>& kernels, const NetworkWeights<N>& weights, const LstmInput<N>& input,
                  Arena<N>& arena, LstmState<N>& state, HeadOutput<typename N::Real>& out,
                  Observer&& observe) {
  using L = Layers<N>;
  L::Recurrent::forward(kernels, weights.lstm, input, arena.template sums<typename L::Recurrent::Sums>(),
                        state);
  observe("lstm", state.h);
  auto& head_input = arena.template front<typename L::Head1::Input>();
  auto& hidden = arena.template back<typename L::Head1::Hidden>();
  const auto after_hidden = std::copy(state.h.begin(), state.h.end(), head_input.begin());
  std::copy(input.begin(), input.end(), after_hidden);
  L::Head1::hidden(kernels, weights.head1, head_input, arena.template sums<typename L::Head1::Sums>(),
                   hidden);
  observe("head1", hidden);
  L::Head2::output(kernels, weights.head2, hidden, arena.template sums<typename L::Head2::Sums>(), out);
}

}  // namespace tumblesight::gnc
