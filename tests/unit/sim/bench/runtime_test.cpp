// Other runtimes compute the same as the flight network, in float32 or fixed point.
#include "sim/bench/runtime.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gnc/rcnn/network_flow.hpp"
#include "sim/bench/network_bench.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

using gnc::Float32;
constexpr float kTolerance = 1e-3F;  // relative to the largest value
constexpr int kFrames = 5;

struct Network {
  Network() {
    model.header = gnc::test_header();
    gnc::fill_random(model.weights, 9);
    ours.weights() = model.weights;
  }
  Float32Model model;
  gnc::Network<Float32> ours;
  gnc::Activations<Float32> activations;
};

template <class Numbers>
void expect_near(const Numbers& numbers, const Numbers& expected, const char* what) {
  float largest = 0.0F;
  for (const float value : expected) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 0.0F) << what;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(numbers[i], expected[i], kTolerance * largest) << what << ", number " << i;
  }
}

void expect_same_frames(Runtime& runtime, Network& network) {
  for (unsigned seed = 0; seed < kFrames; ++seed) {
    const gnc::DepthImage image = gnc::random_depth_image(seed);
    gnc::OutputVector<float> expected, out;
    gnc::Features<Float32> features;
    network.ours.infer_frame(image, network.activations, expected);
    runtime.run_frame(RuntimeImage(image), features, out);
    expect_near(features, network.ours.features(), "features");
    expect_near(out, expected, "output of the CNN");
  }
}

void expect_same_sequence(Runtime& runtime, Network& network) {
  gnc::LstmState<Float32> expected_state, state;
  for (unsigned seed = 0; seed < kFrames; ++seed) {
    const gnc::LstmInput<Float32> input = gnc::random_lstm_input(seed);
    gnc::HeadOutput<float> expected, out;
    network.ours.infer_sequence(input, network.activations, expected_state, expected);
    runtime.run_sequence(input, state, out);
    expect_near(state.h, expected_state.h, "hidden state");
    expect_near(state.c, expected_state.c, "cells");
    expect_near(out, expected, "output of the head");
  }
}

// Verifies TS-TRN-060.
TEST(OnnxRuntime, ComputesTheSameAsTheFlightNetwork) {
  const auto network = std::make_unique<Network>();
  std::string reason;
  const auto runtime = make_onnx_runtime(network->model, "", reason);
  if (runtime == nullptr) GTEST_SKIP() << reason;
  expect_same_frames(*runtime, *network);
  expect_same_sequence(*runtime, *network);
}

TEST(OnnxRuntime, GivesAReasonIfTheLibraryIsMissing) {
  const auto network = std::make_unique<Network>();
  std::string reason;
  EXPECT_EQ(make_onnx_runtime(network->model, "/no/such/library.so", reason), nullptr);
  EXPECT_FALSE(reason.empty());
}

// int8 activations have fewer bits than fixed point behind conv3, and random weights amplify that.
constexpr double kInt8Tolerance = 0.1;

struct FixedPointNetwork {
  FixedPointNetwork() {
    const auto& image = gnc::lasting_model_image<gnc::FixedPoint>(9);
    EXPECT_EQ(gnc::read_model_image<gnc::FixedPoint>(image.data(), image.size(), nullptr, model.header,
                                                     model.weights),
              gnc::ModelStatus::kOk);
    for (unsigned seed = 0; seed < kFrames; ++seed) frames.push_back(gnc::random_frame(seed));
  }
  FixedPointModel model;
  std::vector<gnc::RangeImage> frames;
};

TEST(OnnxRuntime, InInt8ComputesTheSameAsFixedPointWithinABound) {
  const auto network = std::make_unique<FixedPointNetwork>();
  std::string reason;
  const auto runtime = make_onnx_runtime_int8(network->model, "", reason);
  if (runtime == nullptr) GTEST_SKIP() << reason;
  EXPECT_TRUE(runtime->is_int8());
  EXPECT_LT(largest_difference(*runtime, network->model, network->frames), kInt8Tolerance);
}

TEST(Onednn, InInt8ComputesTheSameAsFixedPointWithinABound) {
  const auto network = std::make_unique<FixedPointNetwork>();
  std::string reason;
  const auto runtime = make_onednn_int8(network->model, reason);
  if (TUMBLESIGHT_HAS_ONEDNN == 0 && runtime == nullptr) GTEST_SKIP() << reason;
  ASSERT_NE(runtime, nullptr) << reason;
  EXPECT_TRUE(runtime->is_int8());
  EXPECT_LT(largest_difference(*runtime, network->model, network->frames), kInt8Tolerance);
}

TEST(LibTorch, ComputesTheSameAsTheFlightNetwork) {
  const auto network = std::make_unique<Network>();
  std::string reason;
  const auto runtime = make_libtorch(network->model, reason);
  if (TUMBLESIGHT_TRAINING == 0 && runtime == nullptr) GTEST_SKIP() << reason;
  ASSERT_NE(runtime, nullptr) << reason;
  expect_same_frames(*runtime, *network);
  expect_same_sequence(*runtime, *network);
}

}  // namespace
}  // namespace tumblesight::sim
