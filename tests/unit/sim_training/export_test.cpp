// Requirement: an exported model image reproduces LibTorch's outputs to 1e-5 over whole sequences.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "gnc/rcnn/attitude_estimator.hpp"
#include "gnc/rcnn/network_shape.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/loss.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kFrames = 10;
constexpr double kTolerance = 1e-5;
constexpr double kPi = 3.14159265358979323846;

// Weights as unlike a fresh network as a trained one: norms with statistics of their own, a head that
// corrects.
void disturb(Cnn& cnn, Recurrent& recurrent) {
  torch::NoGradGuard guard;
  for (int i = 0; i < BackboneImpl::kStages; ++i) {
    cnn->backbone->offset[i].normal_(0.1, 0.3);
    cnn->backbone->mean[i].normal_(0.0, 0.3);
    cnn->backbone->variance[i].uniform_(0.5, 2.0);
  }
  recurrent->head2->weight.mul_(5.0);
  recurrent->set_standardisation(torch::randn({gnc::shape::kLstmInput}) * 0.3,
                                 torch::rand({gnc::shape::kLstmInput}) + 0.5);
}

// Sequences of images as sparse as real ones.
torch::Tensor random_images() {
  const torch::Tensor mask = (torch::rand({kFrames, 1, 100, 100}) < 0.3).to(torch::kFloat);
  return torch::rand({kFrames, 1, 100, 100}) * mask;
}

class ExportTest : public testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(3);
    at::set_num_threads(1);
    disturb(cnn, recurrent);
    cnn->eval();
  }
  Cnn cnn;
  Recurrent recurrent;
};

TEST_F(ExportTest, FlightNetworkEqualsLibTorchOverWholeSequences) {
  torch::NoGradGuard guard;
  const auto network = std::make_unique<gnc::Network>();
  export_weights(cnn, recurrent, network->weights());
  for (int sequence = 0; sequence < 5; ++sequence) {
    const torch::Tensor images = random_images();
    const CnnOutput single = cnn->forward(images, false);
    const torch::Tensor all =
        recurrent->forward(single.dense2.unsqueeze(0), single.output.unsqueeze(0)).squeeze(0);
    gnc::LstmState state;
    const auto image = std::make_unique<gnc::DepthImage>();
    gnc::OutputVector single_out, rcnn_out;
    for (int k = 0; k < kFrames; ++k) {
      std::copy_n(images[k].contiguous().data_ptr<float>(), gnc::DepthImage::kCells, image->value.begin());
      network->infer(*image, state, single_out, rcnn_out);
      for (int i = 0; i < gnc::shape::kOutput; ++i) {
        ASSERT_NEAR(single_out[i], single.output[k][i].item<float>(), kTolerance)
            << "frame " << k << " output " << i;
        ASSERT_NEAR(rcnn_out[i], all[k][i].item<float>(), kTolerance) << "frame " << k << " output " << i;
      }
    }
  }
}

TEST_F(ExportTest, TheEstimatorReadsTheFileAndAnswersWithLibTorchsChosenHypothesis) {
  torch::NoGradGuard guard;
  const std::string path =
      std::filesystem::temp_directory_path() / ("export_test_" + std::to_string(getpid()) + ".tsm");
  const auto weights = std::make_unique<gnc::NetworkWeights>();
  export_weights(cnn, recurrent, *weights);
  write_model_file(path, "box", {5.0F, 2.5F, gnc::DepthEncoding::kCentroidRelative}, *weights);
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  std::filesystem::remove(path);
  const auto estimator = std::make_unique<gnc::AttitudeEstimator>();
  ASSERT_EQ(estimator->load(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), "box"),
            gnc::ModelStatus::kOk);

  const torch::Tensor images = random_images();
  const CnnOutput single = cnn->forward(images, false);
  const torch::Tensor all =
      recurrent->forward(single.dense2.unsqueeze(0), single.output.unsqueeze(0)).squeeze(0);
  const auto image = std::make_unique<gnc::DepthImage>();
  for (int k = 0; k < kFrames; ++k) {
    std::copy_n(images[k].contiguous().data_ptr<float>(), gnc::DepthImage::kCells, image->value.begin());
    gnc::AttitudeEstimate estimate;
    estimator->step(*image, estimate);
    // Against the estimate as truth, LibTorch's chosen hypothesis must have no error.
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = estimate.q_lrf_trf.toRotationMatrix();
    const torch::Tensor truth = torch::from_blob(const_cast<float*>(r.data()), {1, 3, 3}).clone();
    EXPECT_LT(hypothesis_errors(all[k].unsqueeze(0), truth).chosen_rad.item<double>(), 1e-3);
    const double logit = all[k][gnc::shape::kOutput - 1].item<double>();
    EXPECT_NEAR(estimate.predicted_error_rad, kPi / (1.0 + std::exp(-logit)), 1e-5);
  }
}

TEST_F(ExportTest, AnUnwritableFileOrABadTargetNameIsSaid) {
  const auto weights = std::make_unique<gnc::NetworkWeights>();
  EXPECT_THROW(write_model_file("/nonexistent/x.tsm", "box", {5, 2, {}}, *weights), std::runtime_error);
  EXPECT_THROW(write_model_file("/tmp/x.tsm", std::string(40, 'a'), {5, 2, {}}, *weights),
               std::runtime_error);
}

}  // namespace
}  // namespace tumblesight::sim
