// The int8 model is valid ONNX with the integers of the fixed-point network.
#include "sim/onnx/int8_model.hpp"

#include <gtest/gtest.h>
#include <onnx/checker.h>
#include <onnx/onnx_pb.h>

#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

using Tensors = std::map<std::string, onnx::TensorProto>;

struct Int8Model : testing::Test {
  void SetUp() override {
    const auto& image = gnc::lasting_model_image<gnc::FixedPoint>(5);
    gnc::ModelHeader header;
    ASSERT_EQ(gnc::read_model_image<gnc::FixedPoint>(image.data(), image.size(), nullptr, header, weights),
              gnc::ModelStatus::kOk);
    ASSERT_TRUE(model.ParseFromString(int8_cnn_as_onnx(header, weights)));
    for (const onnx::TensorProto& tensor : model.graph().initializer()) tensors[tensor.name()] = tensor;
  }

  template <class Number>
  Number value(const std::string& name, std::size_t index = 0) const {
    Number number{};
    std::memcpy(&number, tensors.at(name).raw_data().data() + index * sizeof(Number), sizeof(Number));
    return number;
  }

  gnc::NetworkWeights<gnc::FixedPoint> weights;
  onnx::ModelProto model;
  Tensors tensors;
};

TEST_F(Int8Model, IsValid) {
  EXPECT_NO_THROW(onnx::checker::check_model(model));
}

TEST_F(Int8Model, ConvolutionsHaveOurShiftsAsScalesAndNoZeroPoints) {
  const auto& conv2 = gnc::layer_weights<1>(weights);
  ASSERT_EQ(tensors.at("conv2.weight_scale").dims(0), gnc::shape::kConv2);
  for (std::size_t c = 0; c < gnc::shape::kConv2; ++c) {
    EXPECT_EQ(value<float>("conv2.weight_scale", c), std::ldexp(1.0F, -conv2.shift[c])) << c;
    EXPECT_EQ(value<std::int8_t>("conv2.weight_zero", c), 0) << c;
    EXPECT_EQ(value<std::int32_t>("conv2.bias", c), conv2.bias[c]) << c;
  }
  EXPECT_EQ(value<float>("conv2.input_scale"), 1.0F);
  EXPECT_EQ(value<float>("conv2.output_scale"), 1.0F);
  EXPECT_EQ(value<std::uint8_t>("zero"), 0);
}

TEST_F(Int8Model, FirstWeightsOfAChannelAreThoseOfItsFirstGroup) {
  const auto& conv2 = gnc::layer_weights<1>(weights);
  constexpr std::size_t kGroup = gnc::Int8Product::kGroup;
  for (std::size_t channel = 0; channel < gnc::shape::kConv2; ++channel) {
    for (std::size_t in = 0; in < kGroup; ++in) {
      EXPECT_EQ(value<std::int8_t>("conv2.weight", (channel * gnc::shape::kConv1 + in) * 9),
                conv2.weight.data()[channel * kGroup + in])
          << channel << ", " << in;
    }
  }
}

// conv4 gives 12 bits and the dense layers 15; QLinearConv and QGemm take 8.
TEST_F(Int8Model, UnitsFitTheLargestActivationsIntoEightBits) {
  EXPECT_EQ(value<float>("conv4.output_scale"), 16.0F);
  EXPECT_EQ(value<float>("dense1.input_scale"), 64.0F);
  EXPECT_EQ(value<float>("dense1.output_scale"), 128.0F);
  EXPECT_EQ(value<float>("cnn_out.input_scale"), 128.0F);
  const auto& dense1 = gnc::layer_weights<4>(weights);
  EXPECT_EQ(value<std::int32_t>("dense1.bias"), std::lround(dense1.bias[0] / 64.0));
  EXPECT_EQ(tensors.count("cnn_out.output_scale"), 0U) << "the output is a real number";
}

}  // namespace
}  // namespace tumblesight::sim
