// The bench measures every part with every instruction set of this processor.
#include "sim/bench/network_bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "sim/bench/peak.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kShort_s = 0.002;

template <class N>
void expect_rows_of_every_set() {
  std::vector<std::string> started;
  const BenchSubject subject{
      gnc::random_model_image<N>(3), {gnc::random_frame(1), gnc::random_frame(2)}, kShort_s};
  const std::vector<BenchRow> rows =
      bench_numerics(subject, [&](const std::string& what) { started.push_back(what); });
  std::map<std::string, std::set<std::string>> names;  // by instruction set
  for (const BenchRow& row : rows) {
    names[row.isa].insert(row.name);
    EXPECT_EQ(row.numerics, N::kIsInteger ? "fixed" : "float32");
    EXPECT_GT(row.min_us, 0.0);
    EXPECT_GE(row.median_us, row.min_us);
  }
  EXPECT_EQ(names.size(), started.size());
  for (const gnc::InstructionSet set : gnc::kInstructionSets) {
    if (gnc::kernels_on<N>(set) == nullptr) continue;
    EXPECT_EQ(names[gnc::to_string(set)],
              (std::set<std::string>{"step", "depth image", "network", "convolutions"}));
  }
}

TEST(NetworkBench, MeasuresEveryPartWithEveryInstructionSet) {
  expect_rows_of_every_set<gnc::FixedPoint>();
  expect_rows_of_every_set<gnc::Float32>();
}

TEST(Peak, IsMeasuredOnlyIfTheProcessorHasTheInstructionSet) {
  for (const gnc::InstructionSet set : gnc::kInstructionSets) {
    for (const bool is_integer : {false, true}) {
      const std::optional<double> peak = measured_peak_macs(set, is_integer);
      EXPECT_TRUE(gnc::processor_has(set) || !peak) << gnc::to_string(set);
      EXPECT_GT(peak.value_or(1e9), 1e8) << gnc::to_string(set);
    }
  }
}

}  // namespace
}  // namespace tumblesight::sim
