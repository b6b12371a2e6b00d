// Verifies TS-FDIR-010.
#include "fsw/app/triple_redundant.hpp"

#include <gtest/gtest.h>

namespace tumblesight::fsw {
namespace {

struct State {
  std::uint32_t number = 0;
  std::int64_t time = 0;
  std::uint8_t small = 0;
  std::uint8_t filler[3] = {};
};

TripleRedundant<State> with_content() {
  TripleRedundant<State> state;
  *state = {0xDEADBEEF, -5, 7, {}};
  state.commit();
  return state;
}

TEST(TripleRedundant, EverySingleBitFlipInAnyCopyIsCorrected) {
  const TripleRedundant<State> clean = with_content();
  for (std::size_t bit = 0; bit < 8 * sizeof clean; ++bit) {
    TripleRedundant<State> hit = clean;
    reinterpret_cast<std::uint8_t*>(&hit)[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    ASSERT_EQ(hit.vote(), 1U) << bit;
    EXPECT_EQ(hit->number, 0xDEADBEEF);
    EXPECT_EQ(hit->time, -5);
    EXPECT_EQ(hit->small, 7);
    ASSERT_EQ(hit.vote(), 0U) << "all three copies are equal again";
  }
}

TEST(TripleRedundant, FlipsOfDifferentBitsInTwoCopiesAreCorrected) {
  TripleRedundant<State> hit = with_content();
  auto* const bytes = reinterpret_cast<std::uint8_t*>(&hit);
  bytes[0] ^= 1;
  bytes[sizeof(State)] ^= 2;
  EXPECT_EQ(hit.vote(), 1U);
  EXPECT_EQ(hit->number, 0xDEADBEEF);
}

TEST(TripleRedundant, ChangesWithinACycleCountAfterCommit) {
  TripleRedundant<State> state = with_content();
  state->number = 1;
  state.commit();
  EXPECT_EQ(state.vote(), 0U);
  EXPECT_EQ(state->number, 1U);
}

}  // namespace
}  // namespace tumblesight::fsw
