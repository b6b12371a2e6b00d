#include "tests/unit/gnc_rcnn/test_models.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>

namespace tumblesight::gnc {

void fill_random(NetworkWeights& weights, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  std::size_t fan_in = 1;
  for_each_tensor(weights, [&](const char* name, float* data, std::size_t count) {
    const bool is_bias = std::strstr(name, "bias") != nullptr;
    if (std::strncmp(name, "conv1", 5) == 0) fan_in = 9 * shape::kSpaceToDepthChannels;
    if (std::strncmp(name, "conv2", 5) == 0) fan_in = 9 * shape::kConv1;
    if (std::strncmp(name, "conv3", 5) == 0) fan_in = 9 * shape::kConv2;
    if (std::strncmp(name, "conv4", 5) == 0) fan_in = 9 * shape::kConv3;
    if (std::strncmp(name, "dense1", 6) == 0) fan_in = shape::kFlat;
    if (std::strncmp(name, "dense2", 6) == 0) fan_in = shape::kDense1;
    if (std::strncmp(name, "cnn_out", 7) == 0) fan_in = shape::kDense2;
    if (std::strncmp(name, "lstm", 4) == 0) fan_in = shape::kLstm;
    if (std::strncmp(name, "head", 4) == 0) fan_in = shape::kHead;
    const float bound = is_bias ? 0.1F : std::sqrt(6.0F / static_cast<float>(fan_in));
    for (std::size_t i = 0; i < count; ++i) data[i] = bound * uniform(engine);
  });
}

ModelHeader test_header() {
  ModelHeader header;
  if (!set_target(header, "test_craft")) std::abort();
  header.projection.swath_m = 7.5F;
  header.projection.target_radius_m = 3.25F;
  Eigen::Matrix3f tensor_trf;
  tensor_trf << 3.0F, 0.4F, -0.2F, 0.4F, 5.0F, 0.1F, -0.2F, 0.1F, 6.0F;
  if (!make_inertia(tensor_trf, header.inertia)) std::abort();
  return header;
}

std::vector<std::uint8_t> random_model_image(unsigned seed) {
  auto weights = std::make_unique<NetworkWeights>();
  fill_random(*weights, seed);
  std::vector<std::uint8_t> image(kModelImageSize);
  if (write_model_image(test_header(), *weights, image.data(), image.size()) != image.size()) std::abort();
  return image;
}

DepthImage random_depth_image(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0.01F, 1.0F);
  DepthImage image;
  for (int row = 20; row < 80; ++row) {
    for (int column = 10; column < 90; ++column) {
      const float value = uniform(engine);
      image.value[row * DepthImage::kSide + column] = value > 0.3F ? value : 0.0F;
    }
  }
  return image;
}

layers::Recurrent::Input random_lstm_input(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  layers::Recurrent::Input input;
  for (float& value : input) value = uniform(engine);
  return input;
}

RangeImage random_frame(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_int_distribution<int> counts(50 * 128 - 200, 50 * 128 + 200);  // 50 m, Q9.7
  RangeImage frame;
  frame.rays = 64;
  frame.fov_urad = 150'000;  // 7.5 m at 50 m
  for (int row = 16; row < 48; ++row) {
    for (int column = 12; column < 52; ++column) {
      frame.ranges[row * 64 + column] = static_cast<std::uint16_t>(counts(engine));
    }
  }
  return frame;
}

}  // namespace tumblesight::gnc
