#include "sim/campaign/campaign_tasks.hpp"

#include <gtest/gtest.h>

#include <map>

#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

Campaign campaign_of(std::vector<std::uint32_t> sequences, std::uint32_t per_task) {
  Campaign campaign;
  campaign.sequences_per_task = per_task;
  for (const std::uint32_t of_run : sequences) {
    CampaignRun run;
    run.name = "run" + std::to_string(campaign.runs.size());
    run.options = {"--sequences", std::to_string(of_run)};
    run.sequences = of_run;
    campaign.runs.push_back(run);
  }
  return campaign;
}

TEST(CampaignTasks, HaveAllSequencesOfEachRunAndNoneIsTooLong) {
  const Campaign campaign = campaign_of({1, 9, 10, 11, 100}, 10);
  std::map<std::size_t, std::uint32_t> sequences;
  for (const CampaignTask& task : tasks_of(campaign, "out")) {
    sequences[task.run] += task.sequences;
    EXPECT_LE(task.sequences, 10U);
    EXPECT_GE(task.sequences, 1U);
  }
  for (std::size_t run = 0; run < campaign.runs.size(); ++run)
    EXPECT_EQ(sequences[run], campaign.runs[run].sequences);
}

TEST(CampaignTasks, OfAllRunsGoSideBySide) {
  const std::vector<CampaignTask> tasks = tasks_of(campaign_of({40, 20}, 10), "out");
  std::string order;
  for (const CampaignTask& task : tasks) order += std::to_string(task.run);
  EXPECT_EQ(order, "010010");
}

TEST(CampaignTasks, AreOptionsOfEvaluate) {
  const Campaign campaign = campaign_of({20}, 10);
  const std::vector<CampaignTask> tasks = tasks_of(campaign, "/out");
  EXPECT_EQ(name_of(campaign, tasks[1]), "run0 1/2");
  EXPECT_EQ(options_of(campaign, tasks[1]),
            (std::vector<std::string>{"--sequences", "20", "--no-baseline", "--threads", "1", "--shard",
                                      "1/2", "--shard-file", "/out/run0/0001_of_0002.shard"}));
}

TEST(CampaignTasks, TheirFilesTellWhatIsDone) {
  const SmallEvaluation small;
  const TemporaryFolder folder;
  CampaignTask done{0, {0, 2}, small.run({0, 2}, folder), 7};
  CampaignTask begun{0, {1, 2}, folder.path("begun"), 6};
  { const ShardWriter file(begun.path, small.header({1, 2})); }
  CampaignTask open{0, {1, 2}, folder.path("none"), 6};
  EXPECT_TRUE(is_done(done));
  EXPECT_FALSE(is_done(begun));
  EXPECT_FALSE(is_done(open));
  EXPECT_EQ(sequences_done({done, begun, open}), 7U);
  EXPECT_EQ(tasks_left({open, done, begun}), (std::vector<std::size_t>{0, 2}));
}

}  // namespace
}  // namespace tumblesight::sim
