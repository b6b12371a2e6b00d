#include "gnc/rcnn/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/support/test_models.hpp"
#include "tests/unit/gnc/rcnn/reference_network.hpp"

namespace tumblesight::gnc {
namespace {

template <class Flight>
double largest_difference(const Flight& flight, const std::vector<double>& reference) {
  EXPECT_EQ(flight.size(), reference.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    largest = std::max(largest, std::fabs(flight[i] - reference[i]));
  }
  return largest;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double v : values) largest = std::max(largest, std::fabs(v));
  return largest;
}

// Verifies TS-NUM-090.
TEST(Network, AgreesWithTheDoubleReferenceInEveryFrame) {
  auto network = std::make_unique<Network<Float32>>();
  auto activations = std::make_unique<Activations<Float32>>();
  fill_random(network->weights(), 11);
  const ReferenceNetwork reference(network->weights());
  OutputVector<float> output;
  for (unsigned frame = 0; frame < 3; ++frame) {
    SCOPED_TRACE(frame);
    const DepthImage image = random_depth_image(100 + frame);
    network->infer_frame(image, *activations, output);
    const ReferenceNetwork::Frame expected = reference.infer_frame(image);
    EXPECT_GT(largest_magnitude(expected.output), 0.1);  // the weights do not suppress everything
    EXPECT_LT(largest_difference(network->features(), expected.features), 2e-5);
    EXPECT_LT(largest_difference(output, expected.output), 2e-5);
  }
}

// Verifies TS-NUM-090.
TEST(Network, AgreesWithTheDoubleReferenceOverASequence) {
  auto network = std::make_unique<Network<Float32>>();
  auto activations = std::make_unique<Activations<Float32>>();
  fill_random(network->weights(), 13);
  ReferenceNetwork reference(network->weights());
  LstmState<Float32> state;
  HeadOutput<float> head;
  for (unsigned frame = 0; frame < 20; ++frame) {
    SCOPED_TRACE(frame);
    const LstmInput<Float32> input = random_lstm_input(frame);
    network->infer_sequence(input, *activations, state, head);
    const std::vector<double> expected = reference.infer_sequence({input.begin(), input.end()});
    EXPECT_GT(largest_magnitude(expected), 0.1);
    EXPECT_LT(largest_difference(state.h, reference.h), 1e-4);
    EXPECT_LT(largest_difference(state.c, reference.c), 2e-4);
    EXPECT_LT(largest_difference(head, expected), 5e-4);
  }
}

// Verifies TS-EST-160.
TEST(Network, GivesTheSameBitsAfterAnyOtherInputs) {
  auto network = std::make_unique<Network<Float32>>();
  auto activations = std::make_unique<Activations<Float32>>();
  fill_random(network->weights(), 12);
  LstmState<Float32> fresh, used, again;
  OutputVector<float> first_output, output;
  HeadOutput<float> first_head, head;
  const DepthImage image = random_depth_image(1);
  network->infer_frame(image, *activations, first_output);
  network->infer_sequence(random_lstm_input(1), *activations, fresh, first_head);
  for (unsigned k = 0; k < 3; ++k) {
    network->infer_frame(random_depth_image(50 + k), *activations, output);
    network->infer_sequence(random_lstm_input(50 + k), *activations, used, head);
  }
  network->infer_frame(image, *activations, output);
  network->infer_sequence(random_lstm_input(1), *activations, again, head);
  EXPECT_EQ(output, first_output);
  EXPECT_EQ(head, first_head);
  EXPECT_EQ(again.h, fresh.h);
  EXPECT_EQ(again.c, fresh.c);
}

TEST(NetworkWeights, VisitsEveryParameterOnceUnderUniqueNames) {
  auto weights = std::make_unique<NetworkWeights<Float32>>();
  std::vector<std::string> names;
  std::size_t count = 0;
  for_each_tensor(*weights, [&](const char* layer, const char* part, auto& tensor) {
    names.push_back(std::string(layer) + "." + part);
    count += tensor.size();
    tensor.fill(static_cast<float>(names.size()));
  });
  EXPECT_EQ(count, kParameterCount);
  EXPECT_EQ(names.size(), kTensorCount<Float32>);
  EXPECT_EQ(names.front(), "conv1.weight");
  EXPECT_EQ(names.back(), "head2.bias");

  std::size_t index = 0;
  for_each_tensor(std::as_const(*weights), [&](const char*, const char*, const auto& tensor) {
    ++index;
    EXPECT_EQ(tensor.front(), static_cast<float>(index)) << "shares memory with another tensor";
    EXPECT_EQ(tensor.back(), static_cast<float>(index));
  });
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

// One per input of every sum. An odd last row and column of an image, which are not pooled, have no sums.
TEST(Network, CountsItsMultiplyAccumulates) {
  std::size_t macs = 0;
  for (const LayerRow& row : kLayers) {
    const int side = row.side / 2 * 2, pixels = is_image_layer(row) ? side * side : 1;
    macs += static_cast<std::size_t>(pixels) * inputs_per_sum(row) * sum_channels(row);
  }
  EXPECT_EQ(kMacCount, macs);
}

// Verifies TS-MEM-070.
TEST(NetworkWeights, InFixedPointHaveAShiftPerChannelAndTakeLittleMoreThanAByteEach) {
  const auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  std::size_t tensors = 0;
  for_each_tensor(*weights, [&](const char*, const char*, const auto&) { ++tensors; });
  EXPECT_EQ(tensors, kTensorCount<FixedPoint>);
  for_each_layer(*weights, [](const LayerRow& row, const auto& layer) {
    EXPECT_EQ(layer.shift.size(), layer.bias.size()) << row.name;
    EXPECT_EQ(layer.bias.size() % kIntegerChannels, 0U) << row.name;
  });
  EXPECT_GE(kWeightBytes<FixedPoint>, kParameterCount);
  EXPECT_LE(kWeightBytes<FixedPoint>, 1'200'000U);
}

}  // namespace
}  // namespace tumblesight::gnc
