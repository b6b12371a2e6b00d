#include "sim/campaign/campaign_worker.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

class CampaignWorker : public ::testing::Test {
 protected:
  CampaignWorker() {
    CampaignRun run;
    run.name = "small";
    run.sequences = 13;
    campaign_.sequences_per_task = 4;
    campaign_.runs = {run};
    tasks_ = tasks_of(campaign_, folder_.path("out"));
  }
  void run(const CampaignTask& task) const {
    ShardWriter file(task.path, small_.header(task.shard));
    run_shard(small_.subject, small_.settings, task.shard, file, [](std::uint64_t) {});
  }
  WorkerOutcome work_on(const std::optional<Shard>& part,
                        const std::function<void(const CampaignTask&)>& run) {
    return work(campaign_, tasks_, part, run, [](const std::string&) {});
  }
  std::vector<std::string> paths() const {
    std::vector<std::string> paths;
    for (const CampaignTask& task : tasks_) paths.push_back(task.path);
    return paths;
  }

  SmallEvaluation small_;
  TemporaryFolder folder_;
  Campaign campaign_;
  std::vector<CampaignTask> tasks_;
};

// Verifies TS-SIL-470.
TEST_F(CampaignWorker, RunsEveryTaskOnceToTheFiguresOfOneProcess) {
  const auto run_it = [this](const CampaignTask& task) { run(task); };
  EXPECT_EQ(work_on(std::nullopt, run_it).done, 4U);
  EXPECT_EQ(work_on(std::nullopt, run_it).done, 0U);
  EXPECT_EQ(small_.merged(paths()), small_.figures_of_one_process());
}

TEST_F(CampaignWorker, OfAPartRunsOnlyItsTasks) {
  std::multiset<std::uint32_t> seen;
  const auto note = [&](const CampaignTask& task) {
    seen.insert(task.shard.index);
    run(task);
  };
  work_on(Shard{1, 3}, note);
  EXPECT_EQ(seen, (std::multiset<std::uint32_t>{1}));
  work_on(Shard{0, 3}, note);
  EXPECT_EQ(seen, (std::multiset<std::uint32_t>{0, 1, 3}));
}

TEST_F(CampaignWorker, LeavesATaskToWhoeverRunsIt) {
  const ShardWriter other(tasks_[2].path, small_.header(tasks_[2].shard));
  const WorkerOutcome outcome = work_on(std::nullopt, [this](const CampaignTask& task) { run(task); });
  EXPECT_EQ(outcome.done, 3U);
  EXPECT_TRUE(outcome.failures.empty());
  EXPECT_EQ(tasks_left(tasks_), (std::vector<std::size_t>{2}));
}

// The other worker dies while this one runs its last task.
TEST_F(CampaignWorker, TakesTheTaskOfAWorkerThatHasDied) {
  auto other = std::make_unique<ShardWriter>(tasks_[0].path, small_.header(tasks_[0].shard));
  const WorkerOutcome outcome = work_on(std::nullopt, [&](const CampaignTask& task) {
    if (&task == &tasks_[3]) other.reset();
    run(task);
  });
  EXPECT_EQ(outcome.done, 4U);
  EXPECT_TRUE(tasks_left(tasks_).empty());
}

TEST_F(CampaignWorker, OneThatWasTakenMeanwhileIsNoFailure) {
  const WorkerOutcome outcome =
      work_on(std::nullopt, [](const CampaignTask&) { throw ShardInUse("another process is writing it"); });
  EXPECT_EQ(outcome.done, 0U);
  EXPECT_TRUE(outcome.failures.empty());
}

TEST_F(CampaignWorker, AFailedTaskIsNamedAndTheOthersFollow) {
  const WorkerOutcome outcome = work_on(std::nullopt, [this](const CampaignTask& task) {
    if (task.shard.index == 1) throw std::runtime_error("the disk is full");
    run(task);
  });
  EXPECT_EQ(outcome.done, 3U);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0], "small 1/4: the disk is full");
}

}  // namespace
}  // namespace tumblesight::sim
