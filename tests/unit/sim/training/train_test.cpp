// Verifies TS-TRN-030.
#include "sim/training/train.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "sim/model/model_file.hpp"
#include "sim/training/export_model.hpp"
#include "sim/training/stage.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

class TrainTest : public testing::Test {
 protected:
  TrainTest() : targets(make_training_targets({make_near_shoemaker()}, paper_training_conditions())) {
    at::set_num_threads(1);
    settings.cnn_batch = 8;
    settings.cnn_images = 8 * 6;
    settings.rcnn_sequences = 24;
    settings.rcnn_iterations = 6;
    settings.rcnn_batch = 8;
  }
  ~TrainTest() override { fs::remove_all(root); }

  TrainingSettings in(const std::string& folder) {
    TrainingSettings here = settings;
    here.folder = root / folder;
    fs::create_directories(here.folder);
    return here;
  }
  static std::string line_of(const std::string& path, int number) {
    std::ifstream in(path);
    std::string line;
    for (int i = 0; i <= number; ++i) std::getline(in, line);
    return line;
  }
  static Cnn fresh_cnn() {
    torch::manual_seed(1);
    return Cnn();
  }

  const fs::path root = fs::temp_directory_path() / ("train_test_" + std::to_string(getpid()));
  TrainingTargets targets;
  TrainingSettings settings;
  std::atomic<bool> never{false};
};

TEST(TrainingProgress, ShowsFiguresOnceThereAreSome) {
  EXPECT_EQ(progress_note({}), "");
  TrainingPoint point;
  point.loss = 0.25;
  point.mean_deg = 12.5;
  EXPECT_EQ(progress_note(point), "loss 0.2500  validation 12.50 deg");
}

TEST_F(TrainTest, ShowsItsProgressInTheUnitsOfItsOptions) {
  const TrainingSettings here = in("progress");
  Cnn cnn = fresh_cnn();
  Recurrent recurrent(targets.inertia);
  testing::internal::CaptureStderr();
  ASSERT_TRUE(train_cnn(targets, here, cnn, never));
  ASSERT_TRUE(train_rcnn(targets, here, cnn, recurrent, never));
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_NE(shown.find("48/48 images"), std::string::npos) << shown;  // --cnn-images
  EXPECT_NE(shown.find("6/6 batches"), std::string::npos) << shown;   // --rcnn-iterations
}

TEST_F(TrainTest, AStoppedCnnTrainingResumesToTheSameNetwork) {
  Cnn through = fresh_cnn();
  ASSERT_TRUE(train_cnn(targets, in("through"), through, never));
  EXPECT_EQ(line_of(root / "through/log.csv", 1).rfind("cnn,6,48,", 0), 0U);

  // The learning rate depends on the total number of iterations, so the run cannot be shortened by its
  // settings. It saves a checkpoint at every iteration, and another thread stops it after the first one.
  TrainingSettings stopped = in("stopped");
  stopped.checkpoint_s = 0.0;
  std::atomic<bool> stop{false};
  Cnn first = fresh_cnn();
  std::thread watcher([&] {
    while (!fs::exists(stopped.folder + "/cnn.ckpt")) std::this_thread::yield();
    stop = true;
  });
  const bool finished = train_cnn(targets, stopped, first, stop);
  watcher.join();
  EXPECT_FALSE(finished) << "the stop came after the training had finished";
  torch::manual_seed(99);  // the weights before the checkpoint is read must not matter
  Cnn second;
  ASSERT_TRUE(train_cnn(targets, stopped, second, never));
  for (const auto& parameter : through->named_parameters()) {
    EXPECT_TRUE(torch::equal(parameter.value(), second->named_parameters()[parameter.key()]))
        << parameter.key();
  }
  EXPECT_TRUE(torch::equal(through->backbone->mean[0], second->backbone->mean[0]));
}

TEST_F(TrainTest, ACheckpointOfOtherSettingsOrADamagedOneIsRefused) {
  TrainingSettings here = in("other");
  Cnn cnn = fresh_cnn();
  ASSERT_TRUE(train_cnn(targets, here, cnn, never));
  here.seed += 1;
  EXPECT_THROW(train_cnn(targets, here, cnn, never), std::runtime_error) << "another seed";
  here.seed -= 1;
  targets.conditions = {Condition::kNominal};
  EXPECT_THROW(train_cnn(targets, here, cnn, never), std::runtime_error) << "other conditions";
  targets.conditions = paper_training_conditions();
  EXPECT_TRUE(train_cnn(targets, here, cnn, never));
  std::ofstream(here.folder + "/cnn.ckpt") << "no checkpoint";
  EXPECT_THROW(train_cnn(targets, here, cnn, never), std::runtime_error) << "damaged";
}

TEST_F(TrainTest, AMeshThatTheSensorHardlySeesIsRefusedByItsName) {
  const float h = 1e-4F;  // a needle: too few rays meet it
  const TriangleMesh needle{"needle", {{-2, 0, h}, {2, 0, h}, {2, 0, -h}}, {{0, 1, 2}}};
  try {
    make_training_targets({needle}, paper_training_conditions());
    FAIL() << "accepted a mesh that cannot be seen";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("needle"), std::string::npos);
  }
}

TEST_F(TrainTest, AnIncompleteCheckpointFileIsIgnored) {
  const TrainingSettings here = in("half");
  std::ofstream(here.folder + "/cnn.ckpt.new") << "half a checkpoint";
  Cnn cnn = fresh_cnn();
  EXPECT_TRUE(train_cnn(targets, here, cnn, never));
}

TEST_F(TrainTest, WithoutCnnImagesTheRecurrentStageUsesTheGivenCnnAndWritesLogAndCurve) {
  TrainingSettings here = in("recurrent_only");
  here.cnn_images = 0;
  here.start_from = here.folder + "/given.tsm";
  torch::manual_seed(5);
  Cnn given, cnn;
  const auto weights = std::make_unique<gnc::NetworkWeights<gnc::Float32>>();
  export_weights(given, Recurrent(), *weights);
  write_model_file(here.start_from, model_header("given", targets), *weights);

  ASSERT_TRUE(train_cnn(targets, here, cnn, never));
  EXPECT_FALSE(fs::exists(here.folder + "/cnn.ckpt")) << "there was nothing to train";
  {
    torch::NoGradGuard guard;
    given->eval();
    cnn->eval();
    const torch::Tensor images = render_frames(targets, 2, 0, 8).images;
    const torch::Tensor expected = given->forward(images, false).output;
    EXPECT_TRUE(torch::allclose(cnn->forward(images, false).output, expected, 1e-4, 1e-4));
  }
  Recurrent recurrent;
  const torch::Tensor before = recurrent->head.back()->weight.detach().clone();
  ASSERT_TRUE(train_rcnn(targets, here, cnn, recurrent, never));
  EXPECT_FALSE(torch::equal(before, recurrent->head.back()->weight));
  EXPECT_EQ(line_of(here.folder + "/log.csv", 0).rfind("stage,iteration,samples", 0), 0U);
  EXPECT_EQ(line_of(here.folder + "/log.csv", 1).rfind("rcnn,6,48,", 0), 0U);
  EXPECT_GT(fs::file_size(here.folder + "/curve.svg"), 500U);
  EXPECT_TRUE(train_rcnn(targets, here, cnn, recurrent, never)) << "a finished stage returns at once";
  EXPECT_THROW(train_rcnn(targets, here, fresh_cnn(), recurrent, never), std::runtime_error)
      << "an LSTM of another CNN";
}

TEST_F(TrainTest, AFolderThatCannotBeWrittenIsAnError) {
  TrainingSettings here = settings;
  here.folder = "/dev/null/folder";
  Cnn cnn;
  EXPECT_THROW(train_cnn(targets, here, cnn, never), std::runtime_error);
}

}  // namespace
}  // namespace tumblesight::sim
