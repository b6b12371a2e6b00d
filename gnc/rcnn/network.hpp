// The layers of the RCNN, their weights and activations. What their numbers mean: hypotheses.hpp (CNN) and
// attitude_track.hpp (LSTM and head).
#pragma once

#include <array>
#include <cstddef>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/nn/conv3x3.hpp"
#include "gnc/nn/dense.hpp"
#include "gnc/nn/lstm.hpp"
#include "gnc/nn/pooling.hpp"
#include "gnc/nn/space_to_depth.hpp"
#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::gnc {

// The layers, in the order in which an image passes them; sizes: network_shape.hpp.
namespace layers {
using ToDepth = SpaceToDepth<shape::kImageSide>;
using Conv1 = Conv3x3<ToDepth::kSideOut, shape::kSpaceToDepthChannels, shape::kConv1>;
using Pool1 = MaxPool2x2<ToDepth::kSideOut, shape::kConv1>;
using Conv2 = Conv3x3<Pool1::kSideOut, shape::kConv1, shape::kConv2>;
using Pool2 = MaxPool2x2<Pool1::kSideOut, shape::kConv2>;
using Conv3 = Conv3x3<Pool2::kSideOut, shape::kConv2, shape::kConv3>;
using Pool3 = MaxPool2x2<Pool2::kSideOut, shape::kConv3>;
using Conv4 = Conv3x3<Pool3::kSideOut, shape::kConv3, shape::kConv4>;
using Pool4 = AveragePool<Pool3::kSideOut, shape::kConv4, 2>;
using Dense1 = Dense<shape::kFlat, shape::kDense1>;
using Dense2 = Dense<shape::kDense1, shape::kDense2>;
using CnnOut = Dense<shape::kDense2, shape::kOutput>;
using Recurrent = Lstm<shape::kLstmInput, shape::kLstm>;
using Head1 = Dense<shape::kLstm + shape::kLstmInput, shape::kHead>;
using Head2 = Dense<shape::kHead, shape::kHeadOutput>;
}  // namespace layers

using LstmState = layers::Recurrent::State;

// Per hypothesis k: six numbers at 6k, its logit at kColumns + k; last, the logit of the expected error over
// pi.
using OutputVector = std::array<float, shape::kOutput>;

struct NetworkWeights {
  layers::Conv1::Weights conv1;
  layers::Conv2::Weights conv2;
  layers::Conv3::Weights conv3;
  layers::Conv4::Weights conv4;
  layers::Dense1::Weights dense1;
  layers::Dense2::Weights dense2;
  layers::CnnOut::Weights cnn_out;
  layers::Recurrent::Weights lstm;
  layers::Head1::Weights head1;
  layers::Head2::Weights head2;
};

inline constexpr std::size_t kTensorCount = 21;
inline constexpr std::size_t kParameterCount = layers::Conv1::kParameters + layers::Conv2::kParameters +
                                               layers::Conv3::kParameters + layers::Conv4::kParameters +
                                               layers::Dense1::kParameters + layers::Dense2::kParameters +
                                               layers::CnnOut::kParameters + layers::Recurrent::kParameters +
                                               layers::Head1::kParameters + layers::Head2::kParameters;

// visit(name, data, count) for every tensor, always in this order and under these names: the model image's
// sections, its writer and the trainer's export all go by it. `weights` may be const; then so is `data`.
template <class Weights, class Visitor>
void for_each_tensor(Weights& weights, Visitor&& visit) {
  const auto weight_and_bias = [&visit](const char* weight_name, const char* bias_name, auto& layer) {
    visit(weight_name, layer.weight.data(), layer.weight.size());
    visit(bias_name, layer.bias.data(), layer.bias.size());
  };
  weight_and_bias("conv1.weight", "conv1.bias", weights.conv1);
  weight_and_bias("conv2.weight", "conv2.bias", weights.conv2);
  weight_and_bias("conv3.weight", "conv3.bias", weights.conv3);
  weight_and_bias("conv4.weight", "conv4.bias", weights.conv4);
  weight_and_bias("dense1.weight", "dense1.bias", weights.dense1);
  weight_and_bias("dense2.weight", "dense2.bias", weights.dense2);
  weight_and_bias("cnn_out.weight", "cnn_out.bias", weights.cnn_out);
  visit("lstm.input", weights.lstm.input.data(), weights.lstm.input.size());
  visit("lstm.recurrent", weights.lstm.recurrent.data(), weights.lstm.recurrent.size());
  visit("lstm.bias", weights.lstm.bias.data(), weights.lstm.bias.size());
  weight_and_bias("head1.weight", "head1.bias", weights.head1);
  weight_and_bias("head2.weight", "head2.bias", weights.head2);
}

// Weights and activations; about 6 MB, so place it in static storage. Which instructions run does not depend
// on the image, the state or the weights.
class Network {
 public:
  NetworkWeights& weights() { return weights_; }
  const NetworkWeights& weights() const { return weights_; }

  // CNN: of this image alone.
  void infer_frame(const DepthImage& image, OutputVector& out);
  // LSTM and recurrent head; `state` is advanced.
  void infer_sequence(const layers::Recurrent::Input& input, LstmState& state, layers::Head2::Output& out);

  // Of the last infer_frame(): dense2's output (after ReLU).
  const layers::Dense2::Output& features() const { return dense2_; }

 private:
  NetworkWeights weights_;

  alignas(64) layers::Conv1::Input depth_channels_{};
  alignas(64) layers::Conv1::Padded conv1_padded_{};
  alignas(64) layers::Conv1::Output conv1_{};
  alignas(64) layers::Pool1::Output pool1_{};
  alignas(64) layers::Conv2::Padded conv2_padded_{};
  alignas(64) layers::Conv2::Output conv2_{};
  alignas(64) layers::Pool2::Output pool2_{};
  alignas(64) layers::Conv3::Padded conv3_padded_{};
  alignas(64) layers::Conv3::Output conv3_{};
  alignas(64) layers::Pool3::Output pool3_{};
  alignas(64) layers::Conv4::Padded conv4_padded_{};
  alignas(64) layers::Conv4::Output conv4_{};
  alignas(64) layers::Pool4::Output pool4_{};
  alignas(64) layers::Dense1::Output dense1_{};
  alignas(64) layers::Dense2::Output dense2_{};
  alignas(64) layers::Recurrent::Gates gates_{};
  alignas(64) layers::Head1::Input head_input_{};
  alignas(64) layers::Head1::Output head1_{};
};

}  // namespace tumblesight::gnc
