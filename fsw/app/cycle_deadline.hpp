// CycleDeadline: when the registration of a cycle's frame has to end, so that the report is on time.
#pragma once

#include <cstdint>

#include "fsw/app/counter.hpp"
#include "fsw/app/step_io.hpp"
#include "gnc/registration/work_budget.hpp"

namespace tumblesight::fsw {

class CycleDeadline final : public gnc::Deadline {
 public:
  // Registration ends when 7/8 of `budget_us` have passed. The rest is for the fit of the motion, the checks,
  // the stored state and publishing. `timing`: with a stopwatch.
  CycleDeadline(const CycleTiming& timing, std::uint32_t budget_us)
      : timing_(timing), most_us_(budget_us - budget_us / 8) {}

  bool has_passed() override { return since_start_us() >= most_us_; }
  std::uint32_t since_start_us() const { return elapsed_us(timing_.start_ns, timing_.stopwatch->now_ns()); }

 private:
  const CycleTiming& timing_;
  std::uint32_t most_us_;
};

}  // namespace tumblesight::fsw
