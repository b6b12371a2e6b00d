// Verifies TS-TRN-110.
// Both stages with several ranks: the same course as with one, and the same bits for the same parts of a
// batch.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sim/training/train.hpp"
#include "sim/training/training_log.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/training/joined_ranks.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

struct Trained {
  Cnn cnn;
  Recurrent recurrent;
  bool finished = false;
};

class SeveralRanksTest : public testing::Test {
 protected:
  SeveralRanksTest() : targets(make_training_targets({make_near_shoemaker()}, paper_training_conditions())) {
    at::set_num_threads(1);
    settings.cnn_batch = 16;
    settings.cnn_images = 16 * 6;
    settings.cnn_learning_rate = 0.02;  // with the warm-up; the weights must differ from the first ones
    settings.rcnn_sequences = 8;
    settings.rcnn_iterations = 4;
    settings.rcnn_batch = 8;
  }
  void SetUp() override {
    if (!can_have_several_ranks()) GTEST_SKIP() << "built without Gloo";
  }

  TrainingSettings in(const std::string& name, int trainers = 1) const {
    TrainingSettings here = settings;
    here.folder = folder.path(name);
    here.trainers = trainers;
    fs::create_directories(here.folder);
    return here;
  }

  // Each rank in a thread. All start from the same random weights, as processes of the same seed do.
  std::vector<Trained> train(const TrainingSettings& here, int ranks) {
    std::vector<Trained> all;
    for (int rank = 0; rank < ranks; ++rank) {
      torch::manual_seed(1);
      Cnn cnn;
      all.push_back({cnn, Recurrent(targets.inertia)});
    }
    run_ranks(ranks, here.folder + "/store", [&](const std::shared_ptr<Ranks>& joined) {
      TrainingSettings own = here;
      own.ranks = joined;
      Trained& trained = all[static_cast<std::size_t>(joined->rank())];
      trained.finished = train_cnn(targets, own, trained.cnn, stop) &&
                         train_rcnn(targets, own, trained.cnn, trained.recurrent, stop);
    });
    return all;
  }

  static bool equal(const torch::nn::Module& a, const torch::nn::Module& b) {
    const auto same = [](const std::vector<torch::Tensor>& x, const std::vector<torch::Tensor>& y) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (!torch::equal(x[i], y[i])) return false;
      }
      return x.size() == y.size();
    };
    return same(a.parameters(), b.parameters()) && same(a.buffers(), b.buffers());
  }
  static bool equal(const Trained& a, const Trained& b) {
    return equal(*a.cnn, *b.cnn) && equal(*a.recurrent, *b.recurrent);
  }

  const TemporaryFolder folder;
  TrainingTargets targets;
  TrainingSettings settings;
  std::atomic<bool> stop{false};
};

// Parts of a batch are normalized by their own statistics, so that the course is not the same in all digits.
TEST_F(SeveralRanksTest, HaveTheCourseOfOneRank) {
  constexpr double kLoss = 0.03;
  train(in("one"), 1);
  train(in("two"), 2);
  const std::vector<TrainingPoint> one = read_training_log(folder.path("one"));
  const std::vector<TrainingPoint> two = read_training_log(folder.path("two"));
  ASSERT_EQ(one.size(), 2U);
  ASSERT_EQ(two.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(two[i].samples, one[i].samples);
    EXPECT_NEAR(two[i].loss, one[i].loss, kLoss * one[i].loss);
  }
}

TEST_F(SeveralRanksTest, HoldTheSameNetworkWhichIsThatOfAsManyTrainers) {
  const Trained trainers = train(in("trainers", 4), 1).front();
  for (const Trained& rank : train(in("ranks", 2), 2)) EXPECT_TRUE(equal(rank, trainers));
}

TEST_F(SeveralRanksTest, ContinueWhatAnotherNumberOfRanksHasBegun) {
  const Trained through = train(in("through", 2), 1).front();
  TrainingSettings stopped = in("stopped");
  stopped.checkpoint_s = 0.0;
  stopped.after_point = [this](const TrainingPoint&, bool) { stop = true; };  // at the end of the first stage
  for (const Trained& trained : train(stopped, 2)) EXPECT_FALSE(trained.finished);
  EXPECT_TRUE(fs::exists(stopped.folder + "/cnn.ckpt"));
  stop = false;
  stopped.after_point = {};
  stopped.trainers = 2;
  EXPECT_TRUE(equal(train(stopped, 1).front(), through));
  stopped.trainers = 1;
  for (const Trained& rank : train(stopped, 4)) EXPECT_TRUE(equal(rank, through)) << "it is finished";
}

TEST_F(SeveralRanksTest, WithDifferentSettingsAreRefused) {
  const TrainingSettings here = in("different");
  std::string refusals;
  std::mutex mutex;
  run_ranks(2, here.folder + "/store", [&](const std::shared_ptr<Ranks>& joined) {
    TrainingSettings own = here;
    own.ranks = joined;
    own.seed += static_cast<std::uint64_t>(joined->rank());
    Cnn cnn;
    try {
      train_cnn(targets, own, cnn, stop);
    } catch (const std::runtime_error& error) {
      const std::lock_guard<std::mutex> lock(mutex);
      refusals += error.what() + std::string("\n");
    }
  });
  const std::size_t first = refusals.find("rank 1 was started with other settings");
  ASSERT_NE(first, std::string::npos) << refusals;
  EXPECT_NE(refusals.find("rank 1 was started with other settings", first + 1), std::string::npos)
      << refusals;
}

}  // namespace
}  // namespace tumblesight::sim
