// Random networks and frames for tests. The networks are not trained, so their attitudes are meaningless.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_image.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

// Weights with which the activations of all layers are of order 1.
void fill_random(NetworkWeights<Float32>& weights, unsigned seed);
ModelHeader test_header();
template <class N>
std::vector<std::uint8_t> random_model_image(unsigned seed, const ModelHeader& header = test_header());
// The same, kept until the program ends: fixed-point weights are read from the image.
template <class N>
const std::vector<std::uint8_t>& lasting_model_image(unsigned seed);

// The image with the lowest bit of the weights at these offsets changed, and correct CRCs.
std::vector<std::uint8_t> with_changed_weights(std::vector<std::uint8_t> image,
                                               std::initializer_list<std::size_t> offsets);

// Random depths in the middle, nothing around them; the view is the LRF.
DepthImage random_depth_image(unsigned seed);
LstmInput<Float32> random_lstm_input(unsigned seed);
// A frame that make_depth_image() accepts for test_header()'s projection.
RangeImage random_frame(unsigned seed);

}  // namespace tumblesight::gnc
