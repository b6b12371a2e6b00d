// The layers of the RCNN, their weights and activations, in the numerics N (Float32 or FixedPoint). What
// their numbers mean: hypotheses.hpp (CNN) and attitude_track.hpp (LSTM and head).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/nn/conv_block.hpp"
#include "gnc/nn/dense.hpp"
#include "gnc/nn/lstm.hpp"
#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::gnc {

// The layers, in the order in which an image passes them; sizes: network_shape.hpp.
template <class N>
struct Layers {
  using Conv1 = ConvBlock<N, shape::kImageSide / 2, shape::kSpaceToDepthChannels, shape::kConv1>;
  using Conv2 = ConvBlock<N, Conv1::kSideOut, shape::kConv1, shape::kConv2>;
  using Conv3 = ConvBlock<N, Conv2::kSideOut, shape::kConv2, shape::kConv3>;
  using Conv4 = ConvBlock<N, Conv3::kSideOut, shape::kConv3, shape::kConv4>;
  using Dense1 = Dense<N, shape::kFlat, shape::kDense1>;
  using Dense2 = Dense<N, shape::kDense1, shape::kDense2>;
  using CnnOut = Dense<N, shape::kDense2, shape::kOutput>;
  using Recurrent = Lstm<N, shape::kLstmInput, shape::kLstm>;
  using Head1 = Dense<N, shape::kLstm + shape::kLstmInput, shape::kHead>;
  using Head2 = Dense<N, shape::kHead, shape::kHeadOutput>;
};

template <class N>
using LstmInput = typename Layers<N>::Recurrent::Input;
template <class N>
using LstmState = typename Layers<N>::Recurrent::State;
template <class N>
using Features = typename Layers<N>::Dense2::Hidden;

// Per hypothesis k: six numbers at 6k, its logit at kColumns + k; last, the logit of the expected error over
// pi.
template <class Real>
using OutputVector = std::array<Real, shape::kOutput>;
template <class Real>
using HeadOutput = std::array<Real, shape::kHeadOutput>;

template <class N>
struct NetworkWeights {
  typename Layers<N>::Conv1::Weights conv1;
  typename Layers<N>::Conv2::Weights conv2;
  typename Layers<N>::Conv3::Weights conv3;
  typename Layers<N>::Conv4::Weights conv4;
  typename Layers<N>::Dense1::Weights dense1;
  typename Layers<N>::Dense2::Weights dense2;
  typename Layers<N>::CnnOut::Weights cnn_out;
  typename Layers<N>::Recurrent::Weights lstm;
  typename Layers<N>::Head1::Weights head1;
  typename Layers<N>::Head2::Weights head2;
};

template <class Layer, class = void>
struct HasRecurrent : std::false_type {};
template <class Layer>
struct HasRecurrent<Layer, std::void_t<decltype(std::declval<Layer&>().recurrent)>> : std::true_type {};
template <class Layer>
using HasShifts = std::bool_constant<(std::remove_const_t<Layer>::kShifts > 0)>;

// visit(name, layer) for every layer, always in this order.
template <class Weights, class Visitor>
void for_each_layer(Weights& weights, Visitor&& visit) {
  visit("conv1", weights.conv1);
  visit("conv2", weights.conv2);
  visit("conv3", weights.conv3);
  visit("conv4", weights.conv4);
  visit("dense1", weights.dense1);
  visit("dense2", weights.dense2);
  visit("cnn_out", weights.cnn_out);
  visit("lstm", weights.lstm);
  visit("head1", weights.head1);
  visit("head2", weights.head2);
}

// visit(layer's name, part, tensor) for every tensor of a layer: data() and size(). Parts: weight, recurrent
// (LSTM only), bias, shift (fixed point only).
template <class Layer, class Visitor>
void for_each_tensor_of(const char* name, Layer& layer, Visitor&& visit) {
  visit(name, "weight", layer.weight);
  if constexpr (HasRecurrent<Layer>::value) visit(name, "recurrent", layer.recurrent);
  visit(name, "bias", layer.bias);
  if constexpr (HasShifts<Layer>::value) visit(name, "shift", layer.shift);
}

// For every tensor of the network, always in this order and under these names: the model image's sections,
// its writer and the trainer's export all go by it. `weights` may be const; then so is the tensor.
template <class Weights, class Visitor>
void for_each_tensor(Weights& weights, Visitor&& visit) {
  for_each_layer(weights,
                 [&visit](const char* name, auto& layer) { for_each_tensor_of(name, layer, visit); });
}
template <class N>
inline constexpr std::size_t kTensorCount = N::kIsInteger ? 31 : 21;

// Sums over the layers: parameters that are learnt, multiply-accumulates of a frame, bytes in a model image.
template <template <class Layer> class Count, class N>
inline constexpr std::size_t kSumOverLayers =
    Count<typename Layers<N>::Conv1>::value + Count<typename Layers<N>::Conv2>::value +
    Count<typename Layers<N>::Conv3>::value + Count<typename Layers<N>::Conv4>::value +
    Count<typename Layers<N>::Dense1>::value + Count<typename Layers<N>::Dense2>::value +
    Count<typename Layers<N>::CnnOut>::value + Count<typename Layers<N>::Recurrent>::value +
    Count<typename Layers<N>::Head1>::value + Count<typename Layers<N>::Head2>::value;
template <class Layer>
using ParametersOf = std::integral_constant<std::size_t, Layer::kParameters>;
template <class Layer>
using MacsOf = std::integral_constant<std::size_t, static_cast<std::size_t>(Layer::kMacs)>;
template <class Layer>
using BytesInImageOf = std::integral_constant<std::size_t, Layer::Weights::kBytesInImage>;

inline constexpr std::size_t kParameterCount = kSumOverLayers<ParametersOf, FixedPoint>;
inline constexpr std::size_t kMacCount = kSumOverLayers<MacsOf, FixedPoint>;
template <class N>
inline constexpr std::size_t kWeightBytes = kSumOverLayers<BytesInImageOf, N>;

// Memory of the activations, planned by hand: what a layer reads lies in one buffer, what it writes in the
// other, and its sums between them. Each buffer is as large as the largest thing that ever lies in it.
template <class N>
class Arena {
 public:
  template <class Thing>
  Thing& front() {
    return placed<Thing>(buffers_.front);
  }
  template <class Thing>
  Thing& back() {
    return placed<Thing>(buffers_.back);
  }
  template <class Thing>
  Thing& sums() {
    return placed<Thing>(buffers_.sums);
  }
  DepthImageScratch& projection_scratch() { return placed<DepthImageScratch>(all_); }

 private:
  using L = Layers<N>;
  static constexpr std::size_t kFront =
      std::max({sizeof(typename L::Conv1::Input), sizeof(typename L::Conv3::Input),
                sizeof(typename L::Conv4::AveragePooled)});
  static constexpr std::size_t kBack =
      std::max({sizeof(typename L::Conv2::Input), sizeof(typename L::Conv4::Input),
                sizeof(typename L::Dense1::Hidden)});
  static constexpr std::size_t kSums = std::max(
      {sizeof(typename L::Conv1::Sums), sizeof(typename L::Conv2::Sums), sizeof(typename L::Conv3::Sums),
       sizeof(typename L::Conv4::Sums), sizeof(typename L::Recurrent::Sums)});

  // The first to write there makes the thing, whose numbers are no one's until then; it is found again as it
  // was left.
  template <class Thing, std::size_t kSize>
  static Thing& placed(std::array<std::byte, kSize>& buffer) {
    static_assert(sizeof(Thing) <= kSize, "the arena's plan does not foresee this");
    return *reinterpret_cast<Thing*>(buffer.data());
  }

  struct Buffers {
    alignas(64) std::array<std::byte, kFront> front;
    alignas(64) std::array<std::byte, kSums> sums;
    alignas(64) std::array<std::byte, kBack> back;
  };
  union {
    Buffers buffers_;
    alignas(64) std::array<std::byte, sizeof(DepthImageScratch)> all_;
  };
};

// Weights (in fixed point where the model image lies) and activations; place it in static storage. Which
// instructions run does not depend on the image, the state or the weights.
template <class N>
class Network {
 public:
  NetworkWeights<N>& weights() { return weights_; }
  const NetworkWeights<N>& weights() const { return weights_; }

  // CNN: of this image alone.
  void infer_frame(const DepthImage& image, OutputVector<typename N::Real>& out);
  // LSTM and recurrent head; `state` is advanced.
  void infer_sequence(const LstmInput<N>& input, LstmState<N>& state, HeadOutput<typename N::Real>& out);

  // For the frame's depth image, before infer_frame(): the activations' memory, which no one needs then.
  DepthImageScratch& projection_scratch() { return arena_.projection_scratch(); }

  // Of the last infer_frame(): dense2's output (after ReLU).
  const Features<N>& features() const { return features_; }

  // The fastest kernels there are, unless told otherwise.
  void use(const Kernels<N>& kernels) { kernels_ = &kernels; }
  const Kernels<N>& kernels() const { return *kernels_; }

 private:
  const Kernels<N>* kernels_ = &fastest_kernels<N>();
  NetworkWeights<N> weights_;
  Arena<N> arena_;
  Features<N> features_{};
};

}  // namespace tumblesight::gnc
