#include "gnc/rcnn/network.hpp"

#include <algorithm>

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

void Network::infer_frame(const DepthImage& image, OutputVector& out) {
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
  CnnOut::forward(weights_.cnn_out, dense2_, out);
}

void Network::infer_sequence(const layers::Recurrent::Input& input, LstmState& state,
                             layers::Head2::Output& out) {
  layers::Recurrent::forward(weights_.lstm, input, gates_, state);
  const auto after_hidden = std::copy(state.h.begin(), state.h.end(), head_input_.begin());
  std::copy(input.begin(), input.end(), after_hidden);
  layers::Head1::forward(weights_.head1, head_input_, head1_);
  relu(head1_);
  layers::Head2::forward(weights_.head2, head1_, out);
}

}  // namespace tumblesight::gnc
