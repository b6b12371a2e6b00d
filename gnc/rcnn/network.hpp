// The RCNN in the numerics N (Float32 or FixedPoint): types, weights and activations of the layers in
// network_shape.hpp. What its numbers mean: hypotheses.hpp (CNN) and attitude_track.hpp (LSTM and recurrent
// head).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/network_shape.hpp"
#include "gnc/registration/inlier_ratios.hpp"
#include "gnc/registration/pose_tracker.hpp"

namespace tumblesight::gnc {

template <class N, int kIndex>
using Layer =
    typename LayerOfKind<kLayers[kIndex].kind>::template Type<N, kLayers[kIndex].side, kLayers[kIndex].inputs,
                                                              kLayers[kIndex].outputs>;

template <int kFirst, class Visitor, int... kOffset>
[[gnu::always_inline]] inline void for_each_offset(Visitor& visit, std::integer_sequence<int, kOffset...>) {
  (visit(std::integral_constant<int, kFirst + kOffset>()), ...);
}
// visit(index) with the compile-time constants kFirst, kFirst + 1, ... kEnd - 1. No loop at run time.
template <int kFirst, int kEnd, class Visitor>
[[gnu::always_inline]] inline void for_each_index(Visitor&& visit) {
  for_each_offset<kFirst>(visit, std::make_integer_sequence<int, kEnd - kFirst>());
}

template <class N>
using LstmInput = typename Layer<N, kLstmLayer>::Input;
template <class N>
using LstmState = typename Layer<N, kLstmLayer>::State;
template <class N>
using Features = typename Layer<N, kFeatureLayer>::Hidden;

// Output of the CNN. Per hypothesis k: six numbers at 6k, its logit at kColumns + k; last, the logit of the
// expected error over pi.
template <class Real>
using OutputVector = std::array<Real, shape::kOutput>;
template <class Real>
using HeadOutput = std::array<Real, shape::kHeadOutput>;

// Whether the weights of a layer have the tensor `recurrent`, and how many shifts.
template <class LayerWeights, class = void>
struct HasRecurrent : std::false_type {};
template <class LayerWeights>
struct HasRecurrent<LayerWeights, std::void_t<decltype(std::declval<LayerWeights&>().recurrent)>>
    : std::true_type {};
template <class LayerWeights>
using HasShifts = std::bool_constant<(std::remove_const_t<LayerWeights>::kShifts > 0)>;

// Sums and maxima over all layers.
template <class N, class Indices = std::make_integer_sequence<int, kLayerCount>>
struct LayerTotals;
template <class N, int... kIndex>
struct LayerTotals<N, std::integer_sequence<int, kIndex...>> {
  template <class Weights>
  static constexpr std::size_t kTensorsOf =
      2 + std::size_t{HasRecurrent<Weights>::value} + std::size_t{HasShifts<Weights>::value};
  static constexpr std::size_t kTensors = (kTensorsOf<typename Layer<N, kIndex>::Weights> + ...);
  static constexpr std::size_t kParameters = (Layer<N, kIndex>::kParameters + ...);
  static constexpr std::size_t kMacs = (static_cast<std::size_t>(Layer<N, kIndex>::kMacs) + ...);
  static constexpr std::size_t kBytesInImage = (Layer<N, kIndex>::Weights::kBytesInImage + ...);
  static constexpr std::size_t kLargestSums = std::max({sizeof(typename Layer<N, kIndex>::Sums)...});
  // Of the layers with an even (0) or odd (1) index.
  template <int kParity>
  static constexpr std::size_t kLargestInput =
      std::max({(kIndex % 2 == kParity ? sizeof(typename Layer<N, kIndex>::Input) : 0)...});
};

inline constexpr std::size_t kParameterCount = LayerTotals<FixedPoint>::kParameters;  // that are learnt
inline constexpr std::size_t kMacCount = LayerTotals<FixedPoint>::kMacs;  // multiply-accumulates per frame
template <class N>
inline constexpr std::size_t kTensorCount = LayerTotals<N>::kTensors;
template <class N>
inline constexpr std::size_t kWeightBytes = LayerTotals<N>::kBytesInImage;

template <class N, int kIndex>
struct WeightsOfLayer {
  typename Layer<N, kIndex>::Weights weights;
};
template <class N, class Indices>
struct WeightsOfLayers;
template <class N, int... kIndex>
struct WeightsOfLayers<N, std::integer_sequence<int, kIndex...>> : WeightsOfLayer<N, kIndex>... {};

template <class N>
struct NetworkWeights : WeightsOfLayers<N, std::make_integer_sequence<int, kLayerCount>> {};

template <int kIndex, class N>
auto& layer_weights(NetworkWeights<N>& network) {
  return static_cast<WeightsOfLayer<N, kIndex>&>(network).weights;
}
template <int kIndex, class N>
const auto& layer_weights(const NetworkWeights<N>& network) {
  return static_cast<const WeightsOfLayer<N, kIndex>&>(network).weights;
}

// visit(row, layer's weights) for every layer in the table's order. `network` may be const.
template <class Network, class Visitor>
[[gnu::always_inline]] inline void for_each_layer(Network& network, Visitor&& visit) {
  for_each_index<0, kLayerCount>([&network, &visit ](auto index) __attribute__((always_inline)) {
    constexpr int kIndex = decltype(index)::value;
    visit(kLayers[kIndex], layer_weights<kIndex>(network));
  });
}

// visit(part, tensor) for every tensor of a layer: data() and size(). Parts: weight, recurrent (LSTM only),
// bias, shift (fixed point only).
template <class LayerWeights, class Visitor>
[[gnu::always_inline]] inline void for_each_tensor_of(LayerWeights& layer, Visitor&& visit) {
  visit("weight", layer.weight);
  if constexpr (HasRecurrent<LayerWeights>::value) visit("recurrent", layer.recurrent);
  visit("bias", layer.bias);
  if constexpr (HasShifts<LayerWeights>::value) visit("shift", layer.shift);
}

// visit(layer's name, part, tensor) for every tensor of the network. The model image's sections, its writer
// and the trainer's export all use this order and these names. `network` may be const; then so is the tensor.
template <class Network, class Visitor>
[[gnu::always_inline]] inline void for_each_tensor(Network& network, Visitor&& visit) {
  for_each_layer(network, [&visit](const LayerRow& row, auto& layer) {
    for_each_tensor_of(layer,
                       [&visit, &row](const char* part, auto& tensor) { visit(row.name, part, tensor); });
  });
}

// An object in memory that several use in turn. Each is written before it is read, so that what another one
// left there is never used.
template <class Object, std::size_t kSize>
Object& in_place(std::array<std::byte, kSize>& buffer) {
  static_assert(sizeof(Object) <= kSize);
  return *reinterpret_cast<Object*>(buffer.data());
}

// Memory of the activations: two buffers for the layers' inputs, used in turn, and one for their sums. Each
// buffer is as large as the largest object that it ever holds.
template <class N>
class Arena {
 public:
  // What layer kIndex reads. Its output is the input of layer kIndex + 1, in the other buffer.
  template <int kIndex>
  typename Layer<N, kIndex>::Input& input() {
    using Input = typename Layer<N, kIndex>::Input;
    if constexpr (kIndex % 2 == 0)
      return in_place<Input>(buffers_.even);
    else
      return in_place<Input>(buffers_.odd);
  }
  template <int kIndex>
  typename Layer<N, kIndex>::Sums& sums() {
    return in_place<typename Layer<N, kIndex>::Sums>(buffers_.sums);
  }
  // Over all three buffers.
  DepthImageScratch& projection_scratch() { return in_place<DepthImageScratch>(all_); }
  InlierRatiosScratch& explained_share_scratch() { return in_place<InlierRatiosScratch>(all_); }
  PoseScratch& pose_scratch() { return in_place<PoseScratch>(all_); }

 private:
  using Totals = LayerTotals<N>;
  struct Buffers {
    alignas(64) std::array<std::byte, Totals::template kLargestInput<0>> even;
    alignas(64) std::array<std::byte, Totals::kLargestSums> sums;
    alignas(64) std::array<std::byte, Totals::template kLargestInput<1>> odd;
  };
  union {
    Buffers buffers_;
    alignas(64) std::array<std::byte, std::max(sizeof(DepthImageScratch), sizeof(PoseScratch))> all_;
  };
};

// Weights (in fixed point they are read where the model image lies) and activations; place it in static
// storage. Which instructions run does not depend on the image, the state or the weights.
template <class N>
class Network {
 public:
  NetworkWeights<N>& weights() { return weights_; }
  const NetworkWeights<N>& weights() const { return weights_; }

  // The CNN, on one image; no state.
  void infer_frame(const DepthImage& image, OutputVector<typename N::Real>& out);
  // LSTM and recurrent head. Advances `state` by one frame.
  void infer_sequence(const LstmInput<N>& input, LstmState<N>& state, HeadOutput<typename N::Real>& out);

  // Scratch for making the frame's depth image. It shares the memory of the activations: use it before
  // infer_frame() only.
  DepthImageScratch& projection_scratch() { return arena_.projection_scratch(); }
  // The same for the check of the attitude: use it after infer_sequence() only.
  InlierRatiosScratch& explained_share_scratch() { return arena_.explained_share_scratch(); }
  // And for registration.
  PoseScratch& pose_scratch() { return arena_.pose_scratch(); }

  // Of the last infer_frame(): the output of layer kFeatureLayer, after ReLU.
  const Features<N>& features() const { return features_; }

  // Default: the fastest kernels of this build and processor.
  void use(const Kernels<N>& kernels) { kernels_ = &kernels; }
  const Kernels<N>& kernels() const { return *kernels_; }

 private:
  const Kernels<N>* kernels_ = &fastest_kernels<N>();
  NetworkWeights<N> weights_;
  Arena<N> arena_;
  Features<N> features_{};
};

}  // namespace tumblesight::gnc
