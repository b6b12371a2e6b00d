// A convolution in oneDNN computes the activations of the fixed-point network, up to the rounding of halves.
#if TUMBLESIGHT_HAS_ONEDNN
#include "sim/bench/onednn_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gnc/rcnn/network_flow.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

using gnc::FixedPoint;
constexpr int kSide = 25;  // of conv1's output
constexpr int kFolded = 2 * kSide;

struct Conv1 : testing::Test {
  void SetUp() override {
    const auto& bytes = gnc::lasting_model_image<FixedPoint>(5);
    gnc::ModelHeader header;
    ASSERT_EQ(gnc::read_model_image<FixedPoint>(bytes.data(), bytes.size(), nullptr, header, weights),
              gnc::ModelStatus::kOk);
    gnc::OutputVector<gnc::Fixed> out;
    gnc::run_frame<FixedPoint>(gnc::fastest_kernels<FixedPoint>(), weights, gnc::random_depth_image(3),
                               *activations, features, out,
                               [&](std::string_view name, auto& values) { keep(name, values); });
  }

  // The rows of an image without its border.
  template <class Image>
  void keep(std::string_view name, Image& image) {
    if constexpr (std::is_same_v<Image, gnc::Layer<FixedPoint, 0>::Input>) {
      if (name == gnc::kDepthInput) input = rows_of(image, kFolded);
    }
    if constexpr (std::is_same_v<Image, gnc::Layer<FixedPoint, 1>::Input>) {
      if (name == gnc::kLayers[0].name) expected = rows_of(image, kSide);
    }
  }
  template <class Image>
  static std::vector<int> rows_of(Image& image, int side) {
    std::vector<int> values;
    for (int y = 0; y < side; ++y)
      values.insert(values.end(), image.row(y), image.row(y) + side * Image::kChannels);
    return values;
  }

  std::unique_ptr<gnc::Activations<FixedPoint>> activations =
      std::make_unique<gnc::Activations<FixedPoint>>();
  gnc::NetworkWeights<FixedPoint> weights;
  gnc::Features<FixedPoint> features{};
  std::vector<int> input, expected;
};

TEST_F(Conv1, IsThatOfFixedPointWithinOneStepWhichOnlyHalvesNeed) {
  OnednnGraph graph;
  const dnnl::memory in = graph.image(kFolded, gnc::shape::kSpaceToDepthChannels);
  const dnnl::memory out = graph.readable(graph.convolution(int8_layers_of(weights)[0], in));
  std::copy(input.begin(), input.end(), static_cast<std::uint8_t*>(in.get_data_handle()));
  graph.run();
  const auto* const values = static_cast<const std::uint8_t*>(out.get_data_handle());
  ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 100);
  std::size_t different = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_LE(std::abs(values[i] - expected[i]), 1) << i;
    if (values[i] != expected[i]) ++different;
  }
  // The shift is 8: a fraction of a step has 256 values, one of which is a half, of which half are rounded to
  // even.
  EXPECT_LT(different, expected.size() / 100);
}

}  // namespace
}  // namespace tumblesight::sim

#endif
