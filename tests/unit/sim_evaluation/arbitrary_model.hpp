// A model image with arbitrary weights: useless as a network, but a valid one that answers every frame.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gnc/rcnn/model_image.hpp"
#include "sim/scenario/random.hpp"

namespace tumblesight::sim {

inline std::vector<std::uint8_t> arbitrary_model(const char* target, float swath_m = 7.0F) {
  const auto weights = std::make_unique<gnc::NetworkWeights>();
  Random random(4711);
  gnc::for_each_tensor(*weights, [&](const char*, float* data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) data[i] = static_cast<float>(random.uniform(-0.08, 0.08));
  });
  gnc::ModelHeader header;
  header.projection = {swath_m, 3.8F, gnc::DepthEncoding::kCentroidRelative};
  std::vector<std::uint8_t> image(gnc::kModelImageSize);
  if (!gnc::set_target(header, target)) return {};
  image.resize(gnc::write_model_image(header, *weights, image.data(), image.size()));
  return image;
}

}  // namespace tumblesight::sim
