// AnswerCheck: checks whether an answer of the flight program belongs to a step that was sent. It does not
// depend on DDS.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/sil/answer_collector.hpp"

namespace tumblesight::sim {

class AnswerCheck {
 public:
  // Free-running: the flight program counts its own cycles, and its answer may belong to any frame that was
  // sent.
  explicit AnswerCheck(bool free_running) : free_running_(free_running) {}

  // Step `k` was sent. In lockstep the next answer must belong to it.
  void sent(std::uint32_t k, std::int64_t time_ns, const std::vector<const gnc::RangeImage*>& frames);
  // Empty if the answer is right. Otherwise what is wrong: step, times, or the frame of the attitude.
  std::string fault_of(const StepAnswer& answer) const;

 private:
  std::string step_fault(const StepAnswer& answer) const;

  bool free_running_;
  std::uint32_t k_ = 0;
  std::int64_t time_ns_ = 0;
  std::set<std::pair<std::uint32_t, std::int64_t>> frames_;  // sequence number, exposure time
};

}  // namespace tumblesight::sim
