// CycleDeadline: when the registration of a cycle's frame has to end, so that the report is on time.
#pragma once

#include <cstdint>

#include "fsw/app/counter.hpp"
#include "gnc/registration/work_budget.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::fsw {

class CycleDeadline final : public gnc::Deadline {
 public:
  // `start_ns`: when the cycle began, by the stopwatch. Registration ends when 7/8 of `budget_us` have
  // passed. The rest is for the fit of the motion, the checks, the stored state and publishing.
  CycleDeadline(hal::Stopwatch& stopwatch, std::uint64_t start_ns, std::uint32_t budget_us)
      : stopwatch_(stopwatch), start_ns_(start_ns), most_us_(budget_us - budget_us / 8) {}

  bool has_passed() override { return since_start_us() >= most_us_; }
  std::uint32_t since_start_us() { return elapsed_us(start_ns_, stopwatch_.now_ns()); }

 private:
  hal::Stopwatch& stopwatch_;
  std::uint64_t start_ns_;
  std::uint32_t most_us_;
};

}  // namespace tumblesight::fsw
