// Verifies TS-SIL-020.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

std::uint32_t trace(std::uint64_t seed, double speed = 0.0) {
  SilSettings settings = test::settings();
  settings.speed = speed;
  const SilRunResult recording =
      run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(5, seed), {});
  EXPECT_EQ(recording.failure, "");
  EXPECT_EQ(recording.steps_missed, 0U);
  return recording.trace_crc32;
}

// Keeps every core busy during its lifetime.
class Load {
 public:
  Load() {
    for (unsigned i = 0; i < 2 * std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([this] {
        while (!stop_) ++turns_;
      });
    }
  }
  ~Load() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> turns_{0};
  std::vector<std::thread> threads_;
};

TEST(Determinism, OneSeedGivesOneTraceAtAnySpeedAndLoad) {
  const std::uint32_t reference = trace(7);
  EXPECT_EQ(trace(7, 200.0), reference);
  {
    const Load load;
    EXPECT_EQ(trace(7), reference);
  }
  EXPECT_NE(trace(8), reference) << "the trace does not depend on the answers";
}

}  // namespace
}  // namespace tumblesight::sim
