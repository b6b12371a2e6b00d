// Verifies TS-TRN-110.
#include "sim/training/ranks.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/sim/training/joined_ranks.hpp"

namespace tumblesight::sim {
namespace {

std::vector<torch::Tensor> random_tensors(int count) {
  torch::manual_seed(3);
  std::vector<torch::Tensor> all;
  for (int i = 0; i < count; ++i) all.push_back(torch::randn({1000}) * std::pow(10.0, i % 5));
  return all;
}

std::vector<torch::Tensor> copies(const std::vector<torch::Tensor>& tensors) {
  std::vector<torch::Tensor> all;
  for (const torch::Tensor& tensor : tensors) all.push_back(tensor.clone());
  return all;
}

torch::Tensor sum_of(std::vector<torch::Tensor> tensors) {
  tensors = copies(tensors);
  add_up(tensors);
  return tensors.front();
}

TEST(ShareOf, DividesAllRowsInOrderAndEvenly) {
  for (const std::int64_t rows : {0, 1, 7, 64}) {
    std::int64_t next = 0;
    for (int i = 0; i < 4; ++i) {
      const Share share = share_of(rows, i, 4);
      EXPECT_EQ(share.first, next);
      EXPECT_GE(share.count, rows / 4);
      EXPECT_LE(share.count, rows / 4 + 1);
      next += share.count;
    }
    EXPECT_EQ(next, rows);
  }
}

TEST(AddUp, HasTheSameBitsWhenGroupsAreAddedUpBeforehand) {
  const std::vector<torch::Tensor> all = random_tensors(8);
  const torch::Tensor whole = sum_of(all);
  for (const int group : {2, 4}) {
    std::vector<torch::Tensor> sums;
    for (int i = 0; i < 8; i += group) sums.push_back(sum_of({all.begin() + i, all.begin() + i + group}));
    EXPECT_TRUE(torch::equal(sum_of(sums), whole)) << group;
  }
  EXPECT_TRUE(torch::allclose(sum_of({all.begin(), all.begin() + 3}), all[0] + all[1] + all[2]));
}

TEST(OneRank, KeepsWhatItHas) {
  Ranks alone;
  EXPECT_TRUE(alone.leads());
  const torch::Tensor tensor = torch::ones({3});
  alone.sum({tensor});
  alone.copy_from_first({tensor});
  EXPECT_TRUE(torch::equal(tensor, torch::ones({3})));
  EXPECT_EQ(alone.gather(2.5), std::vector<double>{2.5});
  EXPECT_FALSE(alone.any(false));
  EXPECT_EQ(alone.of_first(std::string("own")), "own");
}

class SeveralRanks : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!can_have_several_ranks()) GTEST_SKIP() << "built without Gloo";
  }
  const TemporaryFolder folder;
};

TEST_P(SeveralRanks, HoldTheSameSumInTheOrderOfTheTree) {
  const int count = GetParam();
  const std::vector<torch::Tensor> values = random_tensors(count);
  std::vector<torch::Tensor> sums = copies(values);
  run_ranks(count, folder.path("store"), [&](const std::shared_ptr<Ranks>& ranks) {
    torch::Tensor& own = sums[static_cast<std::size_t>(ranks->rank())];
    ranks->sum({own.narrow(0, 0, 400).view({20, 20}), own.narrow(0, 400, 600)});
  });
  for (const torch::Tensor& sum : sums) EXPECT_TRUE(torch::equal(sum, sum_of(values)));
}

// Small ones in memory, whose ranks overtake each other, and one that is sent.
TEST_P(SeveralRanks, AddUpTensorsOfAnySizeInAnyOrderOfSizes) {
  constexpr std::int64_t kSent = 4'194'305;
  const int count = GetParam();
  run_ranks(count, folder.path("store"), [&](const std::shared_ptr<Ranks>& ranks) {
    const auto value_of = [](std::int64_t size, int rank) {
      return torch::arange(size, torch::kFloat) * 0.1F + static_cast<float>(rank) / 3.0F;
    };
    for (const std::int64_t size : {1000, 1, 1000, 2, 5000, 5000, 5000, 3}) {
      std::vector<torch::Tensor> all;
      for (int rank = 0; rank < count; ++rank) all.push_back(value_of(size, rank));
      torch::Tensor own = value_of(size, ranks->rank());
      ranks->sum({own});
      EXPECT_TRUE(torch::equal(own, sum_of(all))) << size;
    }
    torch::Tensor large = torch::full({kSent}, 1.0F + static_cast<float>(ranks->rank()));
    ranks->sum({large});
    EXPECT_TRUE(torch::equal(large, torch::full({kSent}, 0.5F * static_cast<float>(count * (count + 1)))));
  });
}

TEST_P(SeveralRanks, AgreeOnWhatOneOfThemKnows) {
  const int count = GetParam();
  run_ranks(count, folder.path("store"), [&](const std::shared_ptr<Ranks>& ranks) {
    const int rank = ranks->rank();
    EXPECT_TRUE(ranks->any(rank == count - 1));
    EXPECT_FALSE(ranks->any(false));
    EXPECT_EQ(ranks->of_first(0.1 + rank), 0.1);
    EXPECT_EQ(ranks->of_first(rank == 0 ? std::string("first\0", 6) : ""), std::string("first\0", 6));
    EXPECT_EQ(ranks->of_first(std::string()), "");
    EXPECT_EQ(ranks->gather(std::int64_t{1} << (40 + rank)).back(), std::int64_t{1} << (40 + count - 1));
    const torch::Tensor tensor = torch::full({2, 3}, rank, torch::kFloat);
    ranks->copy_from_first({tensor});
    EXPECT_TRUE(torch::equal(tensor, torch::zeros({2, 3})));
  });
}

INSTANTIATE_TEST_SUITE_P(Ranks, SeveralRanks, testing::Values(2, 3, 4, 5),
                         [](const auto& test) { return std::to_string(test.param); });

class RanksThatMeet : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_have_several_ranks()) GTEST_SKIP() << "built without Gloo";
  }
  std::string join(int rank, double timeout_s, int master_port = 0) const {
    RankPlace place;
    place.rank = rank;
    place.count = 2;
    place.master_host = master_port != 0 ? "127.0.0.1" : "";
    place.master_port = master_port;
    try {
      const auto ranks = join_ranks(place, folder.path("out"), timeout_s);
      return "sum " + std::to_string(ranks->gather(1.0 + rank)[1]);
    } catch (const RankLost& lost) {
      return lost.what();
    }
  }
  const TemporaryFolder folder;
};

TEST_F(RanksThatMeet, InAFolderPassOverWhatAKilledRunHasLeft) {
  const std::string missing = join(0, 0.2);
  EXPECT_EQ(missing.rfind("rank 0: the 2 ranks have not found each other", 0), 0U) << missing;
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/ranks.invitation")));
  std::string second;
  std::thread other([&] { second = join(1, kTestTimeout_s); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // it takes the old invitation first
  EXPECT_EQ(join(0, kTestTimeout_s), "sum 2.000000");
  other.join();
  EXPECT_EQ(second, "sum 2.000000");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path("out")));
}

TEST_F(RanksThatMeet, WaitForRankZeroNoLongerThanTheTimeout) {
  const std::string lost = join(1, 0.2);
  EXPECT_NE(lost.find("rank 1: the 2 ranks have not found each other"), std::string::npos) << lost;
}

// With a message, and in the memory that they share.
TEST_F(RanksThatMeet, NoticeTheEndOfAnother) {
  const torch::Tensor tensor = torch::ones({10});
  const std::vector<std::function<void(Ranks&)>> calls{[](Ranks& ranks) { ranks.gather(1.0); },
                                                       [&](Ranks& ranks) { ranks.sum({tensor}); }};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    std::string lost;
    try {
      run_ranks(2, folder.path("store" + std::to_string(i)), [&](const std::shared_ptr<Ranks>& ranks) {
        torch::Tensor own = torch::ones({10});
        ranks->sum({own});
        if (ranks->rank() == 0) calls[i](*ranks);
      });
    } catch (const RankLost& error) {
      lost = error.what();
    }
    EXPECT_EQ(lost.rfind("rank 0: another rank has ended or does not answer", 0), 0U) << lost;
    const bool in_memory = i == 1;
    EXPECT_EQ(lost.find("(rank 1 has ended)") != std::string::npos, in_memory) << lost;
  }
}

}  // namespace
}  // namespace tumblesight::sim
