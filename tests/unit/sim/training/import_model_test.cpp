// Verifies TS-TRN-010.
#include "sim/training/import_model.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "gnc/rcnn/network.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/frame_stream.hpp"
#include "sim/training/train.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

// A network whose batch statistics and offsets differ from the initial ones.
Cnn make_used_cnn(const torch::Tensor& images) {
  torch::manual_seed(3);
  Cnn cnn;
  torch::NoGradGuard guard;
  for (auto& offset : cnn->backbone->offset) offset.normal_(0.0, 0.3);
  cnn->train();
  for (int i = 0; i < 20; ++i) cnn->forward(images, false);
  cnn->eval();
  return cnn;
}

TEST(ImportModel, ImportedCnnComputesWhatTheModelImageComputes) {
  const TrainingTargets targets = make_training_targets({make_near_shoemaker()}, paper_training_conditions());
  const torch::Tensor images = render_frames(targets, 1, 0, 32).images;
  const Cnn original = make_used_cnn(images);
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  export_weights(original, Recurrent(), *weights);

  Cnn imported;
  import_cnn(*weights, images, imported);
  imported->eval();

  torch::NoGradGuard guard;
  const torch::Tensor other_images = render_frames(targets, 2, 0, 16).images;
  Cnn reference = original;
  const torch::Tensor expected = reference->forward(other_images, false).output;
  const torch::Tensor actual = imported->forward(other_images, false).output;
  EXPECT_LT((expected - actual).abs().max().item<double>(), 1e-4 * expected.abs().max().item<double>());

  // In training mode the norm uses the statistics of the batch. On the calibration images the function is the
  // same.
  imported->train();
  const torch::Tensor in_training = imported->forward(images, false).output;
  imported->eval();
  const torch::Tensor in_use = imported->forward(images, false).output;
  EXPECT_LT((in_training - in_use).abs().max().item<double>(), 0.02 * in_use.abs().max().item<double>());
}

}  // namespace
}  // namespace tumblesight::sim
