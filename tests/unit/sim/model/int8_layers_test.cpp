// The network for int8 runtimes has the integers of the fixed-point network, in a plain order.
#include "sim/model/int8_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

struct Int8Layers : testing::Test {
  void SetUp() override {
    const auto& image = gnc::lasting_model_image<gnc::FixedPoint>(5);
    ASSERT_EQ(gnc::read_model_image<gnc::FixedPoint>(image.data(), image.size(), nullptr, header, weights),
              gnc::ModelStatus::kOk);
  }
  gnc::ModelHeader header;
  gnc::NetworkWeights<gnc::FixedPoint> weights;
};

TEST_F(Int8Layers, AreThoseOfTheCnnWithTheirSizes) {
  const std::vector<Int8Layer> layers = int8_layers_of(weights);
  ASSERT_EQ(layers.size(), static_cast<std::size_t>(gnc::kLstmLayer));
  for (const Int8Layer& layer : layers) {
    const auto out = static_cast<std::size_t>(layer.row.outputs);
    EXPECT_EQ(layer.weight.size(), static_cast<std::size_t>(inputs_per_sum(layer.row)) * out)
        << layer.row.name;
    EXPECT_EQ(layer.bias.size(), out) << layer.row.name;
    EXPECT_EQ(layer.scale.size(), out) << layer.row.name;
  }
}

// What a dense layer reads has the unit in which the layer before writes, and the sum of four pixels four
// times that of their mean.
TEST_F(Int8Layers, UnitsOfInputsAreThoseOfTheOutputsBefore) {
  const std::vector<Int8Layer> layers = int8_layers_of(weights);
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const bool averaged = layers[i - 1].row.output == gnc::LayerOutput::kAveragePooled;
    EXPECT_EQ(layers[i].input_unit, (averaged ? 4.0F : 1.0F) * layers[i - 1].output_unit) << i;
  }
}

// The stored channels are a multiple of 16, and cnn_out has fewer outputs.
TEST_F(Int8Layers, LeaveOutTheChannelsThatFillVectors) {
  const Int8Layer cnn_out = int8_layers_of(weights)[gnc::kCnnOutputLayer];
  const auto& ours = gnc::layer_weights<gnc::kCnnOutputLayer>(weights);
  ASSERT_GT(ours.bias.size(), cnn_out.bias.size());
  // Input 1 of channel 2: the second of the group of two.
  EXPECT_EQ(cnn_out.weight[cnn_out.bias.size() + 2], ours.weight.data()[2 * gnc::Int16Product::kGroup + 1]);
}

TEST_F(Int8Layers, RecurrentPartInFloat32HasTheUnitsOfItsInputs) {
  const auto model = recurrent_in_float32(header, weights);
  const auto& ours = gnc::layer_weights<gnc::kLstmLayer>(weights);
  const auto& theirs = gnc::layer_weights<gnc::kLstmLayer>(model->weights);
  EXPECT_EQ(theirs.weight[0], std::ldexp(static_cast<float>(ours.weight.data()[0]), -ours.shift[0]));
  EXPECT_EQ(theirs.recurrent[0],
            std::ldexp(static_cast<float>(ours.recurrent.data()[0]), 15 - ours.shift[0]));
  EXPECT_EQ(theirs.bias[0], std::ldexp(static_cast<float>(ours.bias[0]), -ours.shift[0]));
}

}  // namespace
}  // namespace tumblesight::sim
