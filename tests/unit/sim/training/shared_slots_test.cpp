#include "sim/training/shared_slots.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;

class SharedSlotsTest : public testing::Test {
 protected:
  // Empty: all have come.
  static std::string failure_of_meeting(SharedSlots& slots, std::chrono::milliseconds timeout = 20s) {
    try {
      slots.meet(timeout);
    } catch (const std::runtime_error& failure) {
      return failure.what();
    }
    return {};
  }
  const std::string name = "/tumblesight_test_" + std::to_string(getpid());
};

TEST_F(SharedSlotsTest, AreSeenByWhoKnowsTheirNameUntilItIsForgotten) {
  const auto mine = SharedSlots::create(name, 2, 10);
  ASSERT_NE(mine, nullptr);
  EXPECT_EQ(SharedSlots::create(name, 2, 10), nullptr) << "of somebody else";
  const auto other = SharedSlots::open(name, 1, 2, 10);
  ASSERT_NE(other, nullptr);
  mine->slot(1, 4).copy_(torch::arange(4, torch::kFloat));
  EXPECT_TRUE(torch::equal(other->slot(1, 4), torch::arange(4, torch::kFloat)));
  EXPECT_TRUE(torch::equal(other->slot(0, 10), torch::zeros({10})));
  SharedSlots::forget(name);
  EXPECT_EQ(SharedSlots::open(name, 1, 2, 10), nullptr);
  EXPECT_TRUE(torch::equal(other->slot(1, 4), torch::arange(4, torch::kFloat)));
}

TEST_F(SharedSlotsTest, AreNotMadeWhereThereIsNoRoom) {
  EXPECT_EQ(SharedSlots::create(name, 1, std::int64_t{1} << 50), nullptr);
  EXPECT_EQ(SharedSlots::open(name, 0, 1, 1), nullptr) << "nothing is left";
}

TEST_F(SharedSlotsTest, HaveOneProcessPerRank) {
  const auto first = SharedSlots::create(name, 2, 1);
  const auto second = SharedSlots::open(name, 1, 2, 1);
  ASSERT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(SharedSlots::open(name, 1, 2, 1), nullptr);
  SharedSlots::forget(name);
}

// Of two turns, a rank that is ahead writes into the other one.
TEST_F(SharedSlotsTest, KeepATurnUntilAllHaveMetAgain) {
  const auto first = SharedSlots::create(name, 2, 1);
  const auto second = SharedSlots::open(name, 1, 2, 1);
  SharedSlots::forget(name);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  const auto write = [](SharedSlots& slots, int rank, float value) {
    slots.begin_turn();
    slots.slot(rank, 1).fill_(value);
  };
  write(*first, 0, 1.0F);
  write(*second, 1, 2.0F);
  std::thread meeting([&] { EXPECT_EQ(failure_of_meeting(*second), ""); });
  EXPECT_EQ(failure_of_meeting(*first), "");
  meeting.join();
  write(*first, 0, 3.0F);
  EXPECT_EQ(second->slot(0, 1).item<float>(), 1.0F);
}

TEST_F(SharedSlotsTest, NoRankLeavesAMeetingBeforeAllHaveCome) {
  constexpr int kRanks = 3, kMeetings = 200;
  std::vector<std::unique_ptr<SharedSlots>> all;
  all.push_back(SharedSlots::create(name, kRanks, 1));
  for (int rank = 1; rank < kRanks; ++rank) all.push_back(SharedSlots::open(name, rank, kRanks, 1));
  SharedSlots::forget(name);
  for (const auto& slots : all) ASSERT_NE(slots, nullptr);
  std::atomic<int> come{0};
  std::vector<std::thread> threads;
  for (int rank = 0; rank < kRanks; ++rank) {
    threads.emplace_back([&, rank] {
      for (int i = 1; i <= kMeetings; ++i) {
        if (i % kRanks == rank) std::this_thread::sleep_for(200us);
        ++come;
        ASSERT_EQ(failure_of_meeting(*all[static_cast<std::size_t>(rank)]), "");
        ASSERT_GE(come, i * kRanks);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// While another one is still waited for, too.
TEST_F(SharedSlotsTest, NoticeTheEndOfAnyRank) {
  const auto first = SharedSlots::create(name, 3, 1);
  const auto second = SharedSlots::open(name, 1, 3, 1);
  auto third = SharedSlots::open(name, 2, 3, 1);
  SharedSlots::forget(name);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  ASSERT_NE(third, nullptr);
  third.reset();
  EXPECT_EQ(failure_of_meeting(*first), "rank 2 has ended");
}

TEST_F(SharedSlotsTest, NoticeARankThatHasEndedAndOneThatDoesNotAnswer) {
  const auto first = SharedSlots::create(name, 2, 1);
  auto second = SharedSlots::open(name, 1, 2, 1);
  SharedSlots::forget(name);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(failure_of_meeting(*first, 1ms), "rank 1 does not answer");
  second.reset();
  EXPECT_EQ(failure_of_meeting(*first), "rank 1 has ended");
}

}  // namespace
}  // namespace tumblesight::sim
