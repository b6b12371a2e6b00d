#include "sim/model/network_layers.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <stdexcept>

#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

std::vector<std::string> names_of(const std::vector<gnc::LayerRow>& rows) {
  std::vector<std::string> names;
  for (const gnc::LayerRow& row : rows) names.emplace_back(row.name);
  return names;
}

TEST(NetworkLayers, AreGroupedByPartAndKind) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_of(cnn_rows(gnc::LayerKind::kConvolution)), (Names{"conv1", "conv2", "conv3", "conv4"}));
  EXPECT_EQ(names_of(cnn_rows(gnc::LayerKind::kDense)), (Names{"dense1", "dense2", "cnn_out"}));
  EXPECT_EQ(names_of(head_rows()), (Names{"head1", "head2"}));
}

TEST(NetworkLayers, HaveTheChannelsOfTheirOutputs) {
  EXPECT_EQ(channels_of(gnc::kDepthInput), 4);
  EXPECT_EQ(channels_of("conv4"), gnc::shape::kConv4);
  EXPECT_EQ(channels_of(gnc::kLstmInput), gnc::shape::kLstmInput);
  EXPECT_THROW(channels_of("conv5"), std::invalid_argument);
}

TEST(NetworkLayers, CountTheInputsOfASum) {
  const auto inputs = [](const char* name) { return inputs_per_sum(gnc::kLayers[gnc::layer_index(name)]); };
  EXPECT_EQ(inputs("conv1"), 9 * 4);
  EXPECT_EQ(inputs("dense1"), 9 * gnc::shape::kConv4);
  EXPECT_EQ(inputs("lstm"), gnc::shape::kLstmInput + gnc::shape::kLstm);
}

TEST(NetworkLayers, OnlyTheFirstDenseLayerReadsAnImage) {
  for (const gnc::LayerRow& row : gnc::kLayers) {
    EXPECT_EQ(reads_flat_image(row), std::string(row.name) == "dense1") << row.name;
  }
}

// A layer that reads an unknown layer, or one of another width, does not compile: gnc::is_consistent().
TEST(NetworkLayers, ShowEveryParameterOnce) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  gnc::fill_random(*weights, 1);
  std::size_t count = 0;
  for (const Float32Layer& layer : layers_of(*weights)) {
    count += layer.weight.size + layer.recurrent.size + layer.bias.size;
    EXPECT_EQ(layer.recurrent.size > 0, layer.row.kind == gnc::LayerKind::kLstm) << layer.row.name;
    const int sums = layer.row.kind == gnc::LayerKind::kLstm ? 4 * layer.row.outputs : layer.row.outputs;
    EXPECT_EQ(layer.bias.size, static_cast<std::size_t>(sums)) << layer.row.name;
    EXPECT_EQ(layer.weight.size + layer.recurrent.size,
              static_cast<std::size_t>(inputs_per_sum(layer.row)) * layer.bias.size)
        << layer.row.name;
  }
  EXPECT_EQ(count, gnc::kParameterCount);
}

}  // namespace
}  // namespace tumblesight::sim
