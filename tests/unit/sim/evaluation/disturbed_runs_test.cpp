// Verifies TS-SIL-200. The disturbed runs of `evaluate --paper` and their bars.
#include "sim/evaluation/disturbed_runs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace tumblesight::sim {
namespace {

CellResult cell(double mean_within_20_deg, double within_20deg, double wrong_and_valid,
                double right_and_valid) {
  CellResult made;
  made.rcnn.count = 900;
  made.rcnn.mean_within_20_deg = mean_within_20_deg;
  made.rcnn.within_20deg = within_20deg;
  made.rcnn.wrong_and_valid = wrong_and_valid;
  made.rcnn.right_and_valid = right_and_valid;
  return made;
}

TEST(DisturbedRuns, ArePossibleAndDifferFromEachOtherAndFromTheUndisturbedOne) {
  std::set<std::string> seen;
  for (const DisturbedRun& run : disturbed_runs()) {
    EXPECT_NO_THROW(require_possible(run.disturbances, kFramesPerSequence));
    EXPECT_NE(to_string(run.disturbances), "");
    EXPECT_TRUE(seen.insert(to_string(run.condition) + to_string(run.disturbances)).second);
    CellResult cell;
    cell.condition = run.condition;
    cell.disturbances = run.disturbances;
    EXPECT_EQ(disturbed_run_of(cell), &run);
  }
  EXPECT_EQ(disturbed_run_of({}), nullptr);
}

TEST(DisturbedBar, IsMetByEveryFigureTogether) {
  DisturbedBar bar;
  EXPECT_TRUE(meets(bar, cell(90.0, 0.0, 1.0, 0.0), nullptr));
  EXPECT_FALSE(meets(bar, {}, nullptr)) << "no sequence";
  EXPECT_EQ(text_of(bar), "");
  const CellResult undisturbed = cell(1.2, 1.0, 0.01, 0.99);
  bar.most_times_the_mean = 1.25;
  bar.most_fewer_within_20deg = 0.0025;
  EXPECT_TRUE(meets(bar, cell(1.5, 0.9975, 0.0, 0.0), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.51, 1.0, 0.0, 0.0), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.0, 0.997, 0.0, 0.0), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0, 0.0), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.0, 1.0, 0.0, 0.0), nullptr)) << "nothing to compare with";
  bar.most_fewer_within_20deg.reset();
  EXPECT_FALSE(meets(bar, cell(1.0, 1.0, 0.0, 0.0), nullptr)) << "nothing to compare with";
  bar.most_fewer_within_20deg = 0.002;
  EXPECT_EQ(text_of(bar), "1.25 times the mean, 0.2 % fewer within 20°");
  bar = {};
  bar.least_right_and_valid = 0.97;
  bar.not_more_wrong_and_valid = true;
  EXPECT_TRUE(meets(bar, cell(1.2, 1.0, 0.01, 0.97), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.2, 1.0, 0.011, 0.97), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.2, 1.0, 0.01, 0.96), &undisturbed));
  EXPECT_FALSE(meets(bar, cell(1.2, 1.0, 0.0, 1.0), nullptr)) << "nothing to compare with";
  EXPECT_EQ(text_of(bar), "not more wrong and valid, 97.0 % right and valid");
}

}  // namespace
}  // namespace tumblesight::sim
