#include "sim/campaign/campaign_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/hostile_files.hpp"
#include "tests/unit/sim/campaign/campaign_test_support.hpp"

namespace tumblesight::sim {
namespace {

class CampaignFile : public ::testing::Test {
 protected:
  Campaign read(const std::string& text) const {
    std::ofstream(folder_.path("c.toml")) << text;
    return read_campaign(folder_.path("c.toml"));
  }
  std::vector<std::string> names(const std::string& text) const {
    std::vector<std::string> names;
    for (const CampaignRun& run : read(text).runs) names.push_back(run.name);
    return names;
  }
  void expect_refused(const std::string& text, const std::string& part) const {
    const std::string error = error_of([&] { (void)read(text); });
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }

  TemporaryFolder folder_;
};

TEST_F(CampaignFile, AKeyIsAnOptionOfEvaluate) {
  const Campaign campaign = read(R"(
seed = 22
sequences_per_task = 5000
[[run]]
sequences = 400
target = "near_shoemaker"
frames = 5
loss-share = 0.125
no-ego-motion = true
)");
  EXPECT_EQ(campaign.name, "c");
  EXPECT_EQ(campaign.sequences_per_task, 5000U);
  ASSERT_EQ(campaign.runs.size(), 1U);
  EXPECT_EQ(campaign.runs[0].sequences, 400U);
  EXPECT_EQ(campaign.runs[0].line, 4);
  EXPECT_EQ(campaign.runs[0].options,
            (std::vector<std::string>{"--sequences", "400", "--seed", "22", "--target", "near_shoemaker",
                                      "--frames", "5", "--loss-share", "0.125", "--no-ego-motion"}));
}

TEST_F(CampaignFile, AListMakesARunForEachOfItsValues) {
  EXPECT_EQ(names(R"(
[[run]]
sequences = 1
effect = ["", "noise=5", "rays=32,noise=2"]
condition = ["nominal", "degraded"]
target = "near_shoemaker"
)"),
            (std::vector<std::string>{"near_shoemaker-nominal", "near_shoemaker-nominal-noise_5",
                                      "near_shoemaker-nominal-rays_32_noise_2", "near_shoemaker-degraded",
                                      "near_shoemaker-degraded-noise_5",
                                      "near_shoemaker-degraded-rays_32_noise_2"}));
}

TEST_F(CampaignFile, NamesOfFoldersAreUniqueAndHarmless) {
  EXPECT_EQ(names(R"(
[[run]]
sequences = 1
mesh = "../a b/../mesh.stl"
[[run]]
sequences = 2
mesh = "elsewhere/mesh.stl"
[[run]]
sequences = 3
)"),
            (std::vector<std::string>{"mesh", "mesh-2", "default"}));
}

TEST_F(CampaignFile, ThereIsOneSeed) {
  expect_refused("[[run]]\nsequences = 1\nseed = 3\n", "line 3: one seed is for all runs");
}

TEST_F(CampaignFile, WhatIsWrongIsNamedWithItsLine) {
  expect_refused("seed = 1\n", "run is missing; it must be one or more tables [[run]]");
  expect_refused("run = 3\n", "run is 3; it must be one or more tables [[run]]");
  expect_refused("[[run]]\n", "run.sequences is missing; it must be a whole number from 1 to 10000000");
  expect_refused("[[run]]\nsequences = 0\n", "line 2: run.sequences is 0; it must be");
  expect_refused("seeds = 3\n[[run]]\nsequences = 1\n",
                 "line 1: there is no key 'seeds'; the file has seed, sequences_per_task");
  expect_refused("seeds = 3\n[[run]]\nsequences = 1\n", "did you mean 'seed'?");
  expect_refused("[[run]]\nsequencs = 1\n",
                 "line 2: there is no key 'run.sequencs'; did you mean 'sequences'?");
  expect_refused("seed = -1\n[[run]]\nsequences = 1\n",
                 "line 1: seed is -1; it must be a whole number from 0");
  expect_refused("sequences_per_task = 0\n[[run]]\nsequences = 1\n", "line 1: sequences_per_task is 0");
  expect_refused("[[run]]\nsequences = 1\nshard = \"0/2\"\n", "line 3: shard is not for a campaign");
  expect_refused("[[run]]\nsequences = 1\ncondition = []\n", "line 3: run.condition is []");
  expect_refused("[[run]]\nsequences = 1\ncondition = \"\"\n", "line 3: run.condition");
  expect_refused("[[run]]\nsequences = 1\nno-ego-motion = false\n", "true; leave it out for false");
  expect_refused("[[run]]\nsequences = 1\nrange = { near = 1 }\n", "line 3: run.range");
  expect_refused("[[run]]\nsequences = 1\nrange = [[20, 60], [60, 100]]\n", "line 3: run.range");
  expect_refused("[[run]]\nsequences = 1\nno-ego-motion = [true]\n", "line 3: run.no-ego-motion");
  expect_refused("[[run]\n", "line 1");
  EXPECT_NE(error_of([&] { (void)read_campaign(folder_.path("none.toml")); }).find("there is no such file"),
            std::string::npos);
}

TEST_F(CampaignFile, TooManyRunsAreRefused) {
  std::string text = "[[run]]\nsequences = 1\n";
  for (const char* key : {"frames", "range", "period", "loss-share"}) {
    text += std::string(key) + " = [";
    for (int i = 1; i <= 6; ++i) text += std::to_string(i) + ", ";
    text += "]\n";
  }
  expect_refused(text, "more than 1000 runs; divide the campaign into several files");
  // 64 million: counted before they are made.
  std::string many = "[[run]]\nsequences = 1\n";
  for (const char* key : {"a", "b", "c", "d", "e", "f"}) {
    many += std::string(key) + " = [";
    for (int i = 1; i <= 20; ++i) many += std::to_string(i) + ", ";
    many += "]\n";
  }
  expect_refused(many, "more than 1000 runs; divide the campaign into several files");
}

TEST_F(CampaignFile, IsRefusedUnreadIfItIsNoFileOrTooLarge) {
  expect_all_refused(".toml", [](const std::string& path) { (void)read_campaign(path); });
}

TEST_F(CampaignFile, ThatIsNestedDeeplyIsRefused) {
  expect_refused("[[run]]\nsequences = 1\nrange = " + std::string(100'000, '['),
                 "line 3: lists and tables are nested more than 16 deep");
}

}  // namespace
}  // namespace tumblesight::sim
