// Random networks and images for the RCNN's tests. They are not trained and say nothing about accuracy.
#pragma once

#include <cstdint>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_image.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

// Weights that keep the activations near 1 from layer to layer.
void fill_random(NetworkWeights<Float32>& weights, unsigned seed);
ModelHeader test_header();
template <class N>
std::vector<std::uint8_t> random_model_image(unsigned seed, const ModelHeader& header = test_header());
// The same with static lifetime: fixed-point weights are read from the image in place.
template <class N>
const std::vector<std::uint8_t>& lasting_model_image(unsigned seed);

// Random depths in the middle, empty cells around them; seen in the LRF.
DepthImage random_depth_image(unsigned seed);
LstmInput<Float32> random_lstm_input(unsigned seed);
// A frame that make_depth_image() accepts for test_header()'s projection.
RangeImage random_frame(unsigned seed);

}  // namespace tumblesight::gnc
