// Verifies TS-TRN-010.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/rcnn/hypotheses.hpp"
#include "gnc/rcnn/network_shape.hpp"
#include "sim/model/model_file.hpp"
#include "sim/training/export_model.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kFrames = 16;
constexpr double kTolerance = 3e-4;
constexpr double kPi = 3.14159265358979323846;

// Makes the weights differ from a new network's as a trained network's do: norms with statistics, a head that
// corrects.
void disturb(Cnn& cnn, Recurrent& recurrent) {
  torch::NoGradGuard guard;
  for (int i = 0; i < BackboneImpl::kStages; ++i) {
    cnn->backbone->offset[i].normal_(0.1, 0.3);
    cnn->backbone->mean[i].normal_(0.0, 0.3);
    cnn->backbone->variance[i].uniform_(0.5, 2.0);
  }
  recurrent->head.back()->weight.mul_(5.0);
  recurrent->set_standardisation(torch::randn({gnc::shape::kLstmInput}) * 0.3,
                                 torch::rand({gnc::shape::kLstmInput}) + 0.5);
}

Eigen::Matrix3d near_inertia() {  // paper, spacecraft table
  Eigen::Matrix3d inertia;
  inertia << 372.38, -2.86, -2.95, -2.86, 372.45, -4.42, -2.95, -4.42, 316.17;
  return inertia;
}

// As sparse as a rendered depth image.
torch::Tensor random_image() {
  return torch::rand({100, 100}) * (torch::rand({100, 100}) < 0.3).to(torch::kFloat);
}

// Input of the estimator: depth images and their viewing directions.
struct ImageSequence {
  torch::Tensor images;  // [T, 1, 100, 100]
  std::vector<Eigen::Matrix3f> r_lrf_view;
};

// A target that moves smoothly: nearly constant images in a view that turns with the target.
ImageSequence moving_target(Condition condition, std::uint64_t index) {
  ScenarioSettings settings;
  settings.condition = condition;
  settings.frames = kFrames;
  settings.inertia_kg_m2 = near_inertia();
  ImageSequence result;
  const torch::Tensor image = random_image();
  std::vector<torch::Tensor> images;
  for (const FrameTruth& truth : make_sequence(settings, 1, index).frames) {
    images.push_back((image + 0.05 * random_image()).unsqueeze(0));
    result.r_lrf_view.push_back(truth.q_lrf_trf.toRotationMatrix().cast<float>());
  }
  // In units of the flight side's depth.
  result.images = torch::floor(torch::stack(images).clamp(0.0, 0.999) * 65536.0) / 65536.0;
  return result;
}

// An unrelated target in every frame: each prediction is wrong, and each hypothesis far from the previous
// ones.
ImageSequence unrelated_frames(std::uint64_t index) {
  ImageSequence result = moving_target(Condition::kNominal, index);
  for (int k = 0; k < kFrames; ++k)
    result.images[k] = torch::floor(random_image().clamp(0.0, 0.999) * 65536.0).unsqueeze(0) / 65536.0;
  return result;
}

torch::Tensor tensor_of(const Eigen::Matrix3f& r) {
  torch::Tensor t = torch::empty({3, 3});
  for (int i = 0; i < 9; ++i) t[i / 3][i % 3] = r(i / 3, i % 3);
  return t;
}

class ExportTest : public testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(3);
    at::set_num_threads(1);
    disturb(cnn, recurrent);
    cnn->eval();
    export_weights(cnn, recurrent, network->weights());
  }

  void depth_image(const ImageSequence& sequence, int k) {
    const torch::Tensor depths = sequence.images[k].contiguous();
    for (int i = 0; i < gnc::DepthImage::kCells; ++i) {
      image->depth[i] = static_cast<std::uint16_t>(65536.0F * depths.data_ptr<float>()[i]);
    }
    image->r_lrf_view = gnc::converted<gnc::Fixed>(sequence.r_lrf_view[k]);
  }

  // The flight CNN's output for the sequence, as input for the trainer's recurrent module.
  SequenceHypotheses hypotheses_of(const ImageSequence& sequence) {
    std::vector<torch::Tensor> features, rotations, logits;
    for (int k = 0; k < kFrames; ++k) {
      depth_image(sequence, k);
      gnc::OutputVector<float> output;
      network->infer_frame(*image, *activations, output);
      const auto hypotheses = gnc::decode_hypotheses<float>(output, gnc::converted<float>(image->r_lrf_view));
      std::vector<torch::Tensor> turns;
      for (const Eigen::Matrix3f& r : hypotheses.r_lrf_trf) turns.push_back(tensor_of(r));
      auto dense2 = network->features();
      auto logit = hypotheses.logit;
      features.push_back(torch::from_blob(dense2.data(), {gnc::shape::kDense2}).clone());
      rotations.push_back(torch::stack(turns));
      logits.push_back(torch::from_blob(logit.data(), {gnc::shape::kHypotheses}).clone());
    }
    return {torch::stack(features).unsqueeze(0), torch::stack(rotations).unsqueeze(0),
            torch::stack(logits).unsqueeze(0), torch::ones({1, kFrames})};
  }

  std::unique_ptr<gnc::AttitudeEstimator<gnc::Float32>> estimator_from_file() {
    const std::string path =
        std::filesystem::temp_directory_path() / ("export_test_" + std::to_string(getpid()) + ".tsm");
    write_model_file(path, model_header("box", targets), network->weights());
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
    std::filesystem::remove(path);
    auto estimator = std::make_unique<gnc::AttitudeEstimator<gnc::Float32>>();
    EXPECT_EQ(estimator->load(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), "box"),
              gnc::ModelStatus::kOk);
    return estimator;
  }

  // Steps the estimator through the sequence and compares every estimate with LibTorch's.
  // `elapsed_ns`: between two frames; they take turns.
  void expect_equal_estimates(const ImageSequence& sequence, const char* what,
                              const std::vector<std::int64_t>& elapsed_ns = {gnc::kNominalPeriod_ns}) {
    const auto estimator = estimator_from_file();
    SequenceHypotheses hypotheses = hypotheses_of(sequence);
    for (int k = 1; k < kFrames; ++k)
      hypotheses.periods[0][k] =
          static_cast<double>(elapsed_ns[static_cast<std::size_t>(k) % elapsed_ns.size()]) /
          gnc::kNominalPeriod_ns;
    const TrackedSequences expected = recurrent->forward(hypotheses);
    for (int k = 0; k < kFrames; ++k) {
      depth_image(sequence, k);
      gnc::AttitudeEstimate estimate;
      gnc::FrameInterval interval;
      interval.elapsed_ns = elapsed_ns[static_cast<std::size_t>(k) % elapsed_ns.size()];
      estimator->step(*image, interval, estimate);
      const torch::Tensor difference =
          tensor_of(gnc::to_double(estimate.q_lrf_trf).toRotationMatrix().cast<float>()) -
          expected.r_lrf_trf[0][k];
      ASSERT_LT(difference.abs().max().item<double>(), kTolerance) << what << ", frame " << k;
      const double logit = expected.error_logits[0][k].item<double>();
      const double share = 1e-6 * estimate.predicted_error_urad / kPi;
      ASSERT_NEAR(std::log(share / (1.0 - share)), logit, kTolerance) << what << ", frame " << k;
      ASSERT_NEAR(1e-6 * estimate.predicted_error_urad, kPi / (1.0 + std::exp(-logit)), kTolerance) << what;
    }
  }

  TrainingTargets targets =
      make_training_targets({make_near_shoemaker()}, paper_training_conditions(), near_inertia());
  Cnn cnn;
  Recurrent recurrent{targets.inertia};
  std::unique_ptr<gnc::Network<gnc::Float32>> network = std::make_unique<gnc::Network<gnc::Float32>>();
  std::unique_ptr<gnc::Activations<gnc::Float32>> activations =
      std::make_unique<gnc::Activations<gnc::Float32>>();
  std::unique_ptr<gnc::DepthImage> image = std::make_unique<gnc::DepthImage>();
};

TEST_F(ExportTest, TheFlightCnnEqualsTheOneInLibTorch) {
  torch::NoGradGuard guard;
  const ImageSequence sequence = unrelated_frames(0);
  const CnnOutput expected = cnn->forward(sequence.images, false);
  for (int k = 0; k < kFrames; ++k) {
    depth_image(sequence, k);
    gnc::OutputVector<float> output;
    network->infer_frame(*image, *activations, output);
    for (int i = 0; i < gnc::shape::kOutput; ++i) {
      ASSERT_NEAR(output[i], expected.output[k][i].item<float>(), 1e-5) << "frame " << k << " output " << i;
    }
    for (int i = 0; i < gnc::shape::kDense2; ++i) {
      ASSERT_NEAR(network->features()[i], expected.features[k][i].item<float>(), 1e-5) << "frame " << k;
    }
  }
}

TEST_F(ExportTest, TheEstimatorAgreesWithLibTorchOverSequencesOfAMovingTarget) {
  torch::NoGradGuard guard;
  for (std::uint64_t index = 0; index < 3; ++index) {
    expect_equal_estimates(moving_target(Condition::kNominal, index), "spinning");
    expect_equal_estimates(moving_target(Condition::kTumbling, index), "tumbling");
  }
}

TEST_F(ExportTest, TheEstimatorAgreesWithLibTorchIfEveryFrameContradictsTheLast) {
  torch::NoGradGuard guard;
  for (std::uint64_t index = 0; index < 3; ++index)
    expect_equal_estimates(unrelated_frames(index), "unrelated");
}

TEST_F(ExportTest, TheEstimatorAgreesWithLibTorchWhateverTheTimeBetweenFrames) {
  torch::NoGradGuard guard;
  const std::vector<std::int64_t> times{gnc::kNominalPeriod_ns, 400'000'000, 5'400'000'000, 1'350'000'000,
                                        7'000'000'000};
  for (std::uint64_t index = 0; index < 3; ++index) {
    expect_equal_estimates(moving_target(Condition::kNominal, index), "spinning", times);
    expect_equal_estimates(moving_target(Condition::kTumbling, index), "tumbling", times);
    expect_equal_estimates(unrelated_frames(index), "unrelated", times);
  }
}

TEST_F(ExportTest, ATargetNameThatIsTooLongIsRefused) {
  EXPECT_THROW(model_header(std::string(40, 'a'), targets), std::runtime_error);
}

}  // namespace
}  // namespace tumblesight::sim
