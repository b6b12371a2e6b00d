#include "sim/model/network_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
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

// The parts in turn, with the LSTM between the CNN and the head, are the whole table.
TEST(NetworkLayers, AreGroupedByPart) {
  std::vector<gnc::LayerRow> rows = image_rows();
  EXPECT_TRUE(std::all_of(rows.begin(), rows.end(), gnc::is_image_layer));
  const auto append = [&rows](const std::vector<gnc::LayerRow>& more) {
    EXPECT_FALSE(more.empty());
    rows.insert(rows.end(), more.begin(), more.end());
  };
  append(vector_rows());
  EXPECT_STREQ(rows.back().name, gnc::kLayers[gnc::kCnnOutputLayer].name);
  append({gnc::kLayers[gnc::kLstmLayer]});
  append(head_rows());
  EXPECT_EQ(names_of(rows), names_of({std::begin(gnc::kLayers), std::end(gnc::kLayers)}));
}

TEST(NetworkLayers, AnUnknownNameHasNoValues) {
  EXPECT_EQ(gnc::values_per_frame("conv5"), 0);
  EXPECT_EQ(gnc::values_per_frame("conv4"), gnc::shape::kFlat);
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

TEST(NetworkLayers, OnlyTheFirstLayerBehindTheImagesReadsOneFlat) {
  for (const gnc::LayerRow& row : gnc::kLayers) {
    EXPECT_EQ(reads_flat_image(row), row.name == std::string(vector_rows().front().name)) << row.name;
  }
}

// A layer that reads an unknown layer, or one of another width, does not compile: gnc::is_consistent().
TEST(NetworkLayers, ShowEveryParameterOnce) {
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  gnc::fill_random(*weights, 1);
  std::size_t count = 0;
  for (const Float32Layer& layer : layers_of(*weights)) {
    count += layer.weight.size + layer.recurrent.size + layer.bias.size;
    EXPECT_EQ(layer.recurrent.size > 0, sums_of(layer.row.kind).read_state) << layer.row.name;
    EXPECT_EQ(layer.bias.size, static_cast<std::size_t>(sum_channels(layer.row))) << layer.row.name;
    EXPECT_EQ(layer.weight.size + layer.recurrent.size,
              static_cast<std::size_t>(inputs_per_sum(layer.row)) * layer.bias.size)
        << layer.row.name;
  }
  EXPECT_EQ(count, gnc::kParameterCount);
}

}  // namespace
}  // namespace tumblesight::sim
