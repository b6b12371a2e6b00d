#include "gnc/rcnn/network.hpp"

#include <algorithm>

#include "gnc/attitude/rotation.hpp"
#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {

static_assert(DepthImage::kSide == shape::kImageSide);
static_assert(std::tuple_size_v<layers::Pool4::Output> == shape::kFlat,
              "dense1 eats the flattened average pool");
static_assert(sizeof(Network) <= 6'000'000, "memory budget of weights and activations");

namespace {

template <std::size_t kCount>
void relu(std::array<float, kCount>& values) {
  gnc::relu(values.data(), static_cast<int>(kCount));
}

}  // namespace

void Network::infer(const DepthImage& image, LstmState& state, OutputVector& single_frame_out,
                    OutputVector& rcnn_out) {
  infer_features(image);
  layers::CnnOut::forward(weights_.cnn_out, dense2_, single_frame_out);
  fill_lstm_input(single_frame_out);
  layers::Recurrent::forward(weights_.lstm, lstm_input_, gates_, state);
  correct(state, single_frame_out, rcnn_out);
}

void Network::infer_features(const DepthImage& image) {
  using namespace layers;
  ToDepth::forward(image.value, depth_channels_);
  Conv1::forward(weights_.conv1, depth_channels_, conv1_padded_, conv1_);
  Pool1::forward(conv1_, pool1_);
  relu(pool1_);
  Conv2::forward(weights_.conv2, pool1_, conv2_padded_, conv2_);
  Pool2::forward(conv2_, pool2_);
  relu(pool2_);
  Conv3::forward(weights_.conv3, pool2_, conv3_padded_, conv3_);
  Pool3::forward(conv3_, pool3_);
  relu(pool3_);
  Conv4::forward(weights_.conv4, pool3_, conv4_padded_, conv4_);
  relu(conv4_);
  Pool4::forward(conv4_, pool4_);
  Dense1::forward(weights_.dense1, pool4_, dense1_);
  relu(dense1_);
  Dense2::forward(weights_.dense2, dense1_, dense2_);
  relu(dense2_);
}

void Network::fill_lstm_input(const OutputVector& single_frame_out) {
  std::copy(dense2_.begin(), dense2_.end(), lstm_input_.begin());
  float* columns = lstm_input_.data() + shape::kDense2;
  for (int k = 0; k < shape::kHypotheses; ++k) {
    const float* six = single_frame_out.data() + 6 * k;
    const RotationColumns unit = orthonormalise({six[0], six[1], six[2]}, {six[3], six[4], six[5]});
    for (int i = 0; i < 3; ++i) {
      columns[6 * k + i] = unit.first[i];
      columns[6 * k + 3 + i] = unit.second[i];
    }
  }
  softmax(single_frame_out.data() + shape::kColumns, columns + shape::kColumns, shape::kHypotheses);
}

void Network::correct(const LstmState& state, const OutputVector& single_frame_out, OutputVector& rcnn_out) {
  const auto after_hidden = std::copy(state.h.begin(), state.h.end(), head_input_.begin());
  std::copy(lstm_input_.begin(), lstm_input_.end(), after_hidden);
  layers::Head1::forward(weights_.head1, head_input_, head1_);
  relu(head1_);
  layers::Head2::forward(weights_.head2, head1_, correction_);

  const float* columns = lstm_input_.data() + shape::kDense2;
  for (int i = 0; i < shape::kOutput; ++i) {
    const float base = i < shape::kColumns ? columns[i] : single_frame_out[i];
    rcnn_out[i] = base + correction_[i];
  }
}

}  // namespace tumblesight::gnc
