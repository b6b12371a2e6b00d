// Verifies TS-MEM-030.
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::size_t kBudget_bytes = 8 * 1024;
constexpr std::size_t kStack_bytes = 256 * 1024;
constexpr std::uint8_t kUntouched = 0xA5;

template <class N>
struct Run {
  AttitudeEstimator<N>* estimator;
  const RangeImage* frame;
  std::uintptr_t begin = 0;  // of the stack frame of step()
  FrameStatus status = FrameStatus::kEmpty;
};

template <class N>
void* step(void* argument) {
  auto& run = *static_cast<Run<N>*>(argument);
  AttitudeEstimate estimate;
  run.begin = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  run.status = run.estimator->step(*run.frame, estimate);
  return nullptr;
}

// Bytes below the frame of its caller that a step has written, on a stack of its own.
template <class N>
std::size_t stack_use_of_step(AttitudeEstimator<N>& estimator, const RangeImage& frame) {
  void* memory = nullptr;
  if (posix_memalign(&memory, 4096, kStack_bytes) != 0) return SIZE_MAX;
  auto* const stack = static_cast<std::uint8_t*>(memory);
  std::fill(stack, stack + kStack_bytes, kUntouched);
  Run<N> run{&estimator, &frame};
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, stack, kStack_bytes);
  pthread_t thread;
  EXPECT_EQ(pthread_create(&thread, &attributes, step<N>, &run), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  EXPECT_EQ(run.status, FrameStatus::kOk);
  const std::uint8_t* lowest = stack;
  while (lowest < stack + kStack_bytes && *lowest == kUntouched) ++lowest;
  const std::size_t used = run.begin - reinterpret_cast<std::uintptr_t>(lowest);
  std::free(memory);
  return used;
}

template <class N>
void expect_within_budget() {
  const std::vector<std::uint8_t> image = random_model_image<N>(61);
  const auto estimator = std::make_unique<AttitudeEstimator<N>>();
  ASSERT_EQ(estimator->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  const RangeImage frame = random_frame(62);
  for (const InstructionSet set : kInstructionSets) {
    const Kernels<N>* const kernels = kernels_on<N>(set);
    if (kernels == nullptr) continue;
    estimator->network().use(*kernels);
    AttitudeEstimate estimate;
    ASSERT_EQ(estimator->step(frame, estimate),
              FrameStatus::kOk);  // the first call also runs the dynamic linker
    const std::size_t used = stack_use_of_step(*estimator, frame);
    std::printf("  %s, %s: %zu bytes\n", N::kName, to_string(set), used);
    EXPECT_LE(used, kBudget_bytes) << N::kName << ", " << to_string(set);
  }
}

TEST(Stack, UseOfAStepIsWithinItsBudget) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer adds space between variables";
#elif !defined(__OPTIMIZE__)
  GTEST_SKIP() << "without optimization every variable is on the stack";
#endif
  expect_within_budget<FixedPoint>();
  expect_within_budget<Float32>();
}

}  // namespace
}  // namespace tumblesight::gnc
