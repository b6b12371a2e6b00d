#include "sim/cli/summary.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

TEST(SummaryJson, HoldsTheFourFiguresInOrder) {
  EXPECT_EQ(summary_json(summarise({10.0, 30.0, 2.0, 2.0})).dump(),
            R"({"mean_deg":11.0,"median_deg":6.0,"within_20deg":0.75,"within_5deg":0.5})");
}

TEST(SummaryJson, IsNullWithoutASequence) {
  EXPECT_EQ(summary_json({}).dump(),
            R"({"mean_deg":null,"median_deg":null,"within_20deg":null,"within_5deg":null})");
}

TEST(ByFrameTable, SelectsAtMostTenFramesAndEndsWithTheLast) {
  std::vector<FrameResult> results(37);
  for (std::uint32_t i = 0; i < results.size(); ++i) {
    results[i].frame = i;
    results[i].valid = true;
  }
  const std::string header = by_frame_table(results, 37).substr(0, by_frame_table(results, 37).find('\n'));
  EXPECT_NE(header.find(" 37"), std::string::npos) << header;
  EXPECT_LE(header.size(), 100U);
}

}  // namespace
}  // namespace tumblesight::sim
